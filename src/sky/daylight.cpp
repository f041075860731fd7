#include "sky/daylight.h"

#include <cmath>

#include "sky/clear_sky.h"

namespace skybake {

namespace {

Xyz xyz_of(const NoSky&, const Vec3d&) {
    return Xyz(0.0);
}
Xyz xyz_of(const UniformSky& sky, const Vec3d& direction) {
    return direction.z < 0.0 ? Xyz(0.0) : xyz_from_rgb(Rgb(sky.luminance_cd_m2));
}
Xyz xyz_of(const PreethamSky& sky, const Vec3d& direction) {
    return sky_xyz(sky, direction);
}

double efficacy_lm_w(const NoSky&) {
    return kOvercastEfficacy;
}
double efficacy_lm_w(const UniformSky&) {
    return kOvercastEfficacy;
}
double efficacy_lm_w(const PreethamSky& sky) {
    return sky.efficacy_lm_w;
}

}  // namespace

Xyz sky_xyz(const SkyModel& sky, const Vec3d& direction) {
    return std::visit([&](const auto& model) { return xyz_of(model, direction); }, sky);
}

Rgb sky_luminance(const SkyModel& sky, const Vec3f& direction) {
    // A grey must stay exactly grey: it does not go through XYZ.
    if (const auto* uniform = std::get_if<UniformSky>(&sky))
        return direction.z < 0.0f ? Rgb(0.0f) : Rgb(uniform->luminance_cd_m2);
    return rgb_from_xyz(sky_xyz(sky, Vec3d(direction)));
}

float sky_radiance(const SkyModel& sky, const Vec3f& direction) {
    const double efficacy = std::visit([](const auto& model) { return efficacy_lm_w(model); }, sky);
    return static_cast<float>(sky_xyz(sky, Vec3d(direction)).y / efficacy);
}

HorizontalDiffuse horizontal_diffuse(const SkyModel& sky) {
    // Midpoint rule in cos² of the zenith angle, whose cells weigh the same in the cosine integral, and in azimuth.
    constexpr int kRings = 96;
    constexpr int kSectors = 96;
    Vec3d rgb(0.0);
    double radiance = 0.0;
    for (int ring = 0; ring < kRings; ++ring) {
        const double z = std::sqrt((ring + 0.5) / kRings);
        const double horizontal = std::sqrt(1.0 - z * z);
        for (int sector = 0; sector < kSectors; ++sector) {
            const double azimuth = 2.0 * kPi * (sector + 0.5) / kSectors;
            const Vec3f direction(Vec3d(horizontal * std::sin(azimuth), horizontal * std::cos(azimuth), z));
            rgb += Vec3d(sky_luminance(sky, direction));
            radiance += sky_radiance(sky, direction);
        }
    }
    const double weight = kPi / (kRings * kSectors);
    return {Rgb(rgb * weight), radiance * weight};
}

}  // namespace skybake
