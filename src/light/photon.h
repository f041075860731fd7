// A photon at rest, in 24 bytes: tens of millions of them fit into memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

/// Where light arrived on a surface, and how much. Its photometric flux is exact; the ratios of the channels are
/// rounded to 7·10⁻⁵ (red) and 2·10⁻⁴ (blue) of it, the normal to 10⁻⁴.
class Photon {
  public:
    Photon() = default;
    /// `flux` per channel, lm; luminance(flux) > 0. `normal` is unit, on the side that the light came from.
    Photon(const Vec3f& where, const Vec3f& normal, const Rgb& flux)
        : position(where),
          lumen_(luminance(flux)),
          red_(coded(flux.x / lumen_, kMaxRed)),
          blue_(coded(flux.z / lumen_, kMaxBlue)) {
        // Octahedral map: the sphere's octants unfolded onto a square.
        // Based on: Z. Cigolle et al., "A survey of efficient representations for independent unit vectors", 2014.
        const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
        Vec2f p(normal.x / sum, normal.y / sum);
        if (normal.z < 0.0f) p = {(1.0f - std::abs(p.y)) * sign(p.x), (1.0f - std::abs(p.x)) * sign(p.y)};
        normal_x_ = static_cast<std::uint32_t>(std::lround((p.x * 0.5f + 0.5f) * kNormalSteps)) & 0x7fffu;
        normal_y_ = static_cast<std::uint32_t>(std::lround((p.y * 0.5f + 0.5f) * kNormalSteps)) & 0x7fffu;
    }

    Vec3f position{0.0f};  // local metres

    Vec3f normal() const {
        const float x = static_cast<float>(normal_x_) * (2.0f / kNormalSteps) - 1.0f;
        const float y = static_cast<float>(normal_y_) * (2.0f / kNormalSteps) - 1.0f;
        Vec3f n(x, y, 1.0f - std::abs(x) - std::abs(y));
        if (n.z < 0.0f) n = {(1.0f - std::abs(y)) * sign(x), (1.0f - std::abs(x)) * sign(y), n.z};
        return glm::normalize(n);
    }
    Rgb flux() const {
        const float red = static_cast<float>(red_) * (kMaxRed / 65535.0f);
        const float blue = static_cast<float>(blue_) * (kMaxBlue / 65535.0f);
        return lumen_ * Rgb(red, std::max(0.0f, (1.0f - 0.2126f * red - 0.0722f * blue) / 0.7152f), blue);
    }

    /// Along which axis the map is cut at this photon, 0…2; kept for the map.
    int split_axis() const { return static_cast<int>(axis_); }
    void set_split_axis(int axis) { axis_ = static_cast<std::uint32_t>(axis) & 3u; }

  private:
    // A channel alone that makes the whole luminance.
    static constexpr float kMaxRed = 1.0f / 0.2126f;
    static constexpr float kMaxBlue = 1.0f / 0.0722f;
    // Even, so that the axes' own directions are exact.
    static constexpr float kNormalSteps = 32766.0f;

    static float sign(float v) { return v < 0.0f ? -1.0f : 1.0f; }
    static std::uint16_t coded(float share, float max) {
        return static_cast<std::uint16_t>(std::lround(std::clamp(share / max, 0.0f, 1.0f) * 65535.0f));
    }

    float lumen_ = 0.0f;
    std::uint16_t red_ = 0, blue_ = 0;
    std::uint32_t normal_x_ : 15 = 0;
    std::uint32_t normal_y_ : 15 = 0;
    std::uint32_t axis_ : 2 = 0;
};
static_assert(sizeof(Photon) == 24);

}  // namespace skybake
