#include "render/display.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/mat3x3.hpp>

namespace skybake {
namespace {

/// Above the manifest's hint, which brings the mean of all white surfaces to one half: by eye, as in the walkthrough.
constexpr float kDaylightEv = 1.0f;
/// White walls are brighter than a city's mean albedo: the light alone is shown darker. By eye, as in the walkthrough.
constexpr float kLightAloneEv = -1.2f;

// ITU-R BT.2407, between the primaries of Rec. 709 and Rec. 2020. A line is a column of the matrix.
const glm::mat3 kRec2020From709(0.6274f, 0.0691f, 0.0164f,  //
                                0.3293f, 0.9195f, 0.0880f,  //
                                0.0433f, 0.0113f, 0.8956f);
const glm::mat3 kRec709From2020(1.6605f, -0.1246f, -0.0182f,  //
                                -0.5876f, 1.1329f, -0.1006f,  //
                                -0.0728f, -0.0083f, 1.1187f);
const glm::mat3 kInset(0.856627153315983f, 0.137318972929847f, 0.11189821299995f,     //
                       0.0951212405381588f, 0.761241990602591f, 0.0767994186031903f,  //
                       0.0482516061458583f, 0.101439036467562f, 0.811302368396859f);
const glm::mat3 kOutset(1.1271005818144368f, -0.1413297634984383f, -0.14132976349843826f,  //
                        -0.11060664309660323f, 1.157823702216272f, -0.11060664309660294f,  //
                        -0.016493938717834573f, -0.016493938717834257f, 1.2519364065950405f);
// 10 stops below and 6.5 above middle grey (0.18), as binary logarithms.
constexpr float kDarkestStop = -12.47393f;
constexpr float kBrightestStop = 4.026069f;

/// The contrast curve over the logarithm scaled to [0, 1], highest power first (Horner's scheme).
Rgb contrast(const Rgb& x) {
    Rgb sum(15.5f);
    for (const float coefficient : {-40.14f, 31.96f, -6.868f, 0.4298f, 0.1191f, -0.00232f}) sum = sum * x + coefficient;
    return sum;
}

}  // namespace

float exposure_factor(float hint, float ev, PictureKind kind) {
    const float stops = ev + kDaylightEv + (kind == PictureKind::light ? kLightAloneEv : 0.0f);
    return 1e-3f * hint * std::exp2(stops);
}

Rgb agx_tone_mapped(const Rgb& exposed) {
    const Rgb inset = kInset * (kRec2020From709 * exposed);
    const Rgb stops = glm::log2(glm::max(inset, Rgb(1e-10f)));
    const Rgb scaled = glm::clamp((stops - kDarkestStop) / (kBrightestStop - kDarkestStop), 0.0f, 1.0f);
    const Rgb outset = glm::max(kOutset * contrast(scaled), Rgb(0.0f));
    return glm::clamp(kRec709From2020 * glm::pow(outset, Rgb(2.2f)), 0.0f, 1.0f);
}

std::uint8_t dithered_srgb(float linear, int column, int row) {
    const float wave =
        0.06711056f * (static_cast<float>(column) + 0.5f) + 0.00583715f * (static_cast<float>(row) + 0.5f);
    const float noise = glm::fract(52.9829189f * glm::fract(wave));
    const float code = 255.0f * srgb_from_linear(linear) + noise - 0.5f;
    return static_cast<std::uint8_t>(std::lround(std::clamp(code, 0.0f, 255.0f)));
}

}  // namespace skybake
