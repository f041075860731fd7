#include "sky/five_parameter_sky.h"

#include <algorithm>
#include <cmath>

namespace skybake {

namespace {

constexpr double kLeastCosZenith = 0.001;

}  // namespace

ViewAngles view_angles(const Vec3d& direction, const Vec3d& sun_direction) {
    const double cos_gamma = std::clamp(glm::dot(direction, sun_direction), -1.0, 1.0);
    return {direction.z, std::acos(cos_gamma), cos_gamma};
}

double value_of(const PerezDistribution& p, const ViewAngles& view) {
    return p.scale * (1.0 + p.a * std::exp(p.b / std::max(view.cos_zenith, kLeastCosZenith))) *
           (1.0 + p.c * std::exp(p.d * view.gamma) + p.e * view.cos_gamma * view.cos_gamma);
}

double horizontal_integral(const std::function<double(const ViewAngles&)>& luminance, double sun_cos_zenith) {
    // Midpoint rule in cos² θ, whose rings weigh the same in the cosine integral, and in the azimuth from the sun, over
    // one of the two mirrored halves.
    constexpr int kRings = 192;
    constexpr int kSectors = 96;
    const double sun_sin = std::sqrt(std::max(0.0, 1.0 - sun_cos_zenith * sun_cos_zenith));
    double sum = 0.0;
    for (int ring = 0; ring < kRings; ++ring) {
        const double cos_zenith = std::sqrt((ring + 0.5) / kRings);
        const double sin_zenith = std::sqrt(1.0 - cos_zenith * cos_zenith);
        for (int sector = 0; sector < kSectors; ++sector) {
            const double cos_gamma = std::clamp(
                sun_cos_zenith * cos_zenith + sun_sin * sin_zenith * std::cos(kPi * (sector + 0.5) / kSectors), -1.0,
                1.0);
            sum += std::max(0.0, luminance({cos_zenith, std::acos(cos_gamma), cos_gamma}));
        }
    }
    return sum * kPi / (kRings * kSectors);
}

double horizontal_integral(const PerezDistribution& distribution, double sun_cos_zenith) {
    return horizontal_integral([&](const ViewAngles& view) { return value_of(distribution, view); }, sun_cos_zenith);
}

Vec3d lifted_to_horizon(const Vec3d& sun_direction) {
    if (sun_direction.z >= 0.0) return sun_direction;
    const double horizontal = std::hypot(sun_direction.x, sun_direction.y);
    if (horizontal <= 0.0) return {0.0, 1.0, 0.0};
    return {sun_direction.x / horizontal, sun_direction.y / horizontal, 0.0};
}

}  // namespace skybake
