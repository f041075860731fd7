#include "sky/daylight.h"

#include <algorithm>
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
Xyz xyz_of(const ImageSky& sky, const Vec3d& direction) {
    return xyz_from_rgb(sky_luminance(sky, Vec3f(direction)));
}
/// Models that give luminance, with a colour beside it.
template <typename Model>
Xyz xyz_of(const Model& sky, const Vec3d& direction) {
    const double luminance = sky_luminance_cd_m2(sky, direction);
    return luminance > 0.0 ? coloured(sky.colour, luminance, direction) : Xyz(0.0);
}

double efficacy_lm_w(const NoSky&) {
    return kOvercastEfficacy;
}
double efficacy_lm_w(const UniformSky&) {
    return kOvercastEfficacy;
}
double efficacy_lm_w(const ImageSky&) {
    return kOvercastEfficacy;
}
template <typename Model>
double efficacy_lm_w(const Model& sky) {
    return sky.efficacy_lm_w;
}

}  // namespace

Xyz sky_xyz(const SkyModel& sky, const Vec3d& direction) {
    return std::visit([&](const auto& model) { return xyz_of(model, direction); }, sky);
}

Rgb sky_luminance(const SkyModel& sky, const Vec3f& direction) {
    // A grey must stay exactly grey, and a pixel itself: they do not go through XYZ.
    if (const auto* uniform = std::get_if<UniformSky>(&sky))
        return direction.z < 0.0f ? Rgb(0.0f) : Rgb(uniform->luminance_cd_m2);
    if (const auto* image = std::get_if<ImageSky>(&sky)) return sky_luminance(*image, direction);
    return rgb_from_xyz(sky_xyz(sky, Vec3d(direction)));
}

float sky_radiance(const SkyModel& sky, const Vec3f& direction) {
    const double efficacy = std::visit([](const auto& model) { return efficacy_lm_w(model); }, sky);
    return static_cast<float>(sky_xyz(sky, Vec3d(direction)).y / efficacy);
}

HorizontalDiffuse horizontal_diffuse(const SkyModel& sky) {
    if (const auto* image = std::get_if<ImageSky>(&sky)) {  // whose features no rule of fixed points can resolve
        const Rgb illuminance(horizontal_illuminance(*image->image));
        return {illuminance, static_cast<double>(luminance(illuminance)) / kOvercastEfficacy};
    }
    // Midpoint rule in cos² of the zenith angle, whose cells weigh the same in the cosine integral, and in azimuth.
    constexpr int kRings = 128;
    constexpr int kSectors = 128;
    Vec3d rgb(0.0);
    double sum = 0.0;
    for (int ring = 0; ring < kRings; ++ring) {
        const double z = std::sqrt((ring + 0.5) / kRings);
        const double horizontal = std::sqrt(1.0 - z * z);
        for (int sector = 0; sector < kSectors; ++sector) {
            const double azimuth = 2.0 * kPi * (sector + 0.5) / kSectors;
            const Xyz xyz = sky_xyz(sky, {horizontal * std::sin(azimuth), horizontal * std::cos(azimuth), z});
            rgb += Vec3d(rgb_from_xyz(xyz));
            sum += xyz.y;
        }
    }
    const double weight = kPi / (kRings * kSectors);
    const double efficacy = std::visit([](const auto& model) { return efficacy_lm_w(model); }, sky);
    return {Rgb(rgb * weight), sum * weight / efficacy};
}

Rgb land_luminance(const Daylight& daylight) {
    const Rgb beam = daylight.sun.normal_illuminance * std::max(0.0f, daylight.sun.direction.z);
    return kLandAlbedo * (horizontal_diffuse(daylight.sky).illuminance + beam) / static_cast<float>(kPi);
}

}  // namespace skybake
