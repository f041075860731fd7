#include "render/backdrop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace skybake {
namespace {

constexpr float kPiF = static_cast<float>(kPi);

/// Fields, streets and roofs from afar, greyed by haze; by eye, as in the walkthrough.
const Rgb kFarLandAlbedo(0.22f, 0.215f, 0.19f);

float smoothstep(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// Illuminance of open level ground: the sum of L sin(e) over the solid angles cos(e) de da, lx. Zenith and horizon
/// weigh nothing, so their half rows need no care.
Rgb horizontal_illuminance(const Panorama& panorama) {
    glm::dvec3 sum(0.0);
    const double step_elevation = 0.5 * kPi / (panorama.height - 1);
    const double step_azimuth = 2.0 * kPi / panorama.width;
    for (int row = 0; row < panorama.height; ++row) {
        const double zenith_angle = row * step_elevation;
        const double weight = std::cos(zenith_angle) * std::sin(zenith_angle) * step_elevation * step_azimuth;
        for (int column = 0; column < panorama.width; ++column)
            sum += weight * glm::dvec3(panorama.pixels[static_cast<std::size_t>(row * panorama.width + column)]);
    }
    return Rgb(sum);
}

}  // namespace

Backdrop::Backdrop(Panorama panorama, const BackdropSun& sun) : panorama_(std::move(panorama)), sun_(sun) {
    SKYBAKE_CHECK_LT(0, panorama_.width);
    SKYBAKE_CHECK_LT(1, panorama_.height);
    const Rgb global = horizontal_illuminance(panorama_) + std::max(sun.direction.z, 0.0f) * sun.normal_illuminance;
    ground_ = kFarLandAlbedo / kPiF * global;
    for (auto pixel = panorama_.pixels.end() - panorama_.width; pixel != panorama_.pixels.end(); ++pixel)
        horizon_ += *pixel / static_cast<float>(panorama_.width);
}

Rgb Backdrop::sky_at(float azimuth, float elevation) const {
    const float row =
        std::clamp(1.0f - elevation / (0.5f * kPiF), 0.0f, 1.0f) * static_cast<float>(panorama_.height - 1);
    const float turns = azimuth / (2.0f * kPiF);
    const float column = (turns - std::floor(turns)) * static_cast<float>(panorama_.width) - 0.5f;
    const int top = std::min(static_cast<int>(row), panorama_.height - 2);
    const int left = static_cast<int>(std::floor(column));
    const float down = row - static_cast<float>(top);
    const float across = column - static_cast<float>(left);
    const auto pixel = [&](int c, int r) -> const Rgb& {
        return panorama_
            .pixels[static_cast<std::size_t>(r * panorama_.width + (c + panorama_.width) % panorama_.width)];
    };
    const Rgb upper = (1.0f - across) * pixel(left, top) + across * pixel(left + 1, top);
    const Rgb lower = (1.0f - across) * pixel(left, top + 1) + across * pixel(left + 1, top + 1);
    return (1.0f - down) * upper + down * lower;
}

Rgb Backdrop::radiance(const Vec3f& direction) const {
    const float elevation = std::asin(std::clamp(direction.z, -1.0f, 1.0f));
    Rgb radiance = sky_at(std::atan2(direction.x, direction.y), elevation);
    if (elevation < 0.0f) {
        // Far land lies under haze: it fades from the sky's own horizon into sunlit ground within a few degrees.
        const float below = -elevation;
        const float to_mean = 0.35f * smoothstep(0.0f, 0.02f, below);
        const Rgb haze = (1.0f - to_mean) * radiance + to_mean * horizon_;
        const float haze_share = std::exp(-below / 0.055f);
        radiance = (1.0f - haze_share) * ground_ + haze_share * haze;
    }
    if (luminance(sun_.normal_illuminance) > 0.0f) {
        const float angle = std::acos(std::clamp(glm::dot(direction, sun_.direction), -1.0f, 1.0f));
        // Forward scatter of the eye and of haze about the sun; strength and width by eye, as in the walkthrough.
        const float glow = (0.6f * std::exp(-angle / 0.012f) + 0.05f * std::exp(-angle / 0.06f)) *
                           smoothstep(-0.02f, 0.01f, elevation);
        const float radius = sun_.angular_radius_rad;
        const bool is_disc = angle < radius && elevation > 0.0f;
        radiance += sun_.normal_illuminance * (glow + (is_disc ? 1.0f / (kPiF * radius * radius) : 0.0f));
    }
    return radiance;
}

Rgb paper_colour(const Vec3f& direction) {
    const float shade = 0.62f + 0.2f * smoothstep(-0.3f, 0.6f, direction.z);
    return shade * Rgb(0.93f, 0.96f, 1.0f);
}

}  // namespace skybake
