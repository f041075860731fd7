#include "render/backdrop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace skybake {
namespace {

constexpr float kPiF = static_cast<float>(kPi);

float smoothstep(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace

Backdrop::Backdrop(Panorama panorama, const BackdropSun& sun, const BackdropLand& land, std::optional<Air> air)
    : panorama_(std::move(panorama)), sun_(sun), land_(land), air_(std::move(air)) {
    SKYBAKE_CHECK_LT(0, panorama_.width);
    SKYBAKE_CHECK_LT(1, panorama_.height);
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

Rgb Backdrop::through_air(const Rgb& luminance, const Vec3f& eye, const Vec3f& direction, float distance_m) const {
    if (!air_) return luminance;
    const AerialView view = view_through(*air_, static_cast<double>(eye.z - land_.height_m), Vec3d(direction),
                                         static_cast<double>(distance_m));
    return luminance * view.transmittance + view.inscatter;
}

Rgb Backdrop::radiance(const Vec3f& eye, const Vec3f& direction) const {
    const float elevation = std::asin(std::clamp(direction.z, -1.0f, 1.0f));
    if (elevation < 0.0f) {
        // Level land goes on as far as the air lets one see.
        const float to_land = std::max(eye.z - land_.height_m, 1.0f) / std::max(-direction.z, 1e-5f);
        return through_air(land_.luminance, eye, direction, to_land) + sun_at(direction, elevation);
    }
    return sky_at(std::atan2(direction.x, direction.y), elevation) + sun_at(direction, elevation);
}

Rgb Backdrop::sun_at(const Vec3f& direction, float elevation) const {
    if (!(luminance(sun_.normal_illuminance) > 0.0f)) return Rgb(0.0f);
    const float angle = std::acos(std::clamp(glm::dot(direction, sun_.direction), -1.0f, 1.0f));
    // Strength and width of the glow by eye, as in the walkthrough.
    const float glow =
        (0.6f * std::exp(-angle / 0.012f) + 0.05f * std::exp(-angle / 0.06f)) * smoothstep(-0.02f, 0.01f, elevation);
    const float radius = sun_.angular_radius_rad;
    const bool is_disc = angle < radius && elevation > 0.0f;
    return sun_.normal_illuminance * (glow + (is_disc ? 1.0f / (kPiF * radius * radius) : 0.0f));
}

Rgb paper_colour(const Vec3f& direction) {
    const float shade = 0.62f + 0.2f * smoothstep(-0.3f, 0.6f, direction.z);
    return shade * Rgb(0.93f, 0.96f, 1.0f);
}

}  // namespace skybake
