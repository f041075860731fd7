#include "sky/preetham.h"

#include <algorithm>
#include <cmath>

namespace skybake {

namespace {

/// Directions lower than this (0.06°) are evaluated here, as in the authors' program: e^{B/cos θ} has no limit it
/// needs.
constexpr double kLeastCosZenith = 0.001;

struct Linear {
    double slope;
    double offset;
    double operator()(double turbidity) const { return slope * turbidity + offset; }
};

/// Appendix A.2: a zenith chromaticity as cubic in the sun's zenith angle, its coefficients quadratic in the turbidity.
double zenith_chromaticity(const double (&m)[3][4], double turbidity, double sun_zenith) {
    double value = 0.0;
    for (int power = 0; power < 3; ++power) {
        const double(&row)[4] = m[power];
        const double cubic = ((row[0] * sun_zenith + row[1]) * sun_zenith + row[2]) * sun_zenith + row[3];
        value = value * turbidity + cubic;
    }
    return value;
}

double relative_value(const PerezDistribution& p, double cos_zenith, double gamma, double cos_gamma) {
    return (1.0 + p.a * std::exp(p.b / cos_zenith)) * (1.0 + p.c * std::exp(p.d * gamma) + p.e * cos_gamma * cos_gamma);
}

/// The scale that makes the distribution `zenith_value` at the zenith.
void fix_zenith(PerezDistribution& p, double zenith_value, double sun_zenith) {
    p.scale = zenith_value / relative_value(p, 1.0, sun_zenith, std::cos(sun_zenith));
}

}  // namespace

PreethamSky preetham_sky(double turbidity, const Vec3d& sun_direction) {
    const double t = std::clamp(turbidity, kPreethamLeastTurbidity, kPreethamMostTurbidity);
    PreethamSky sky;
    sky.sun_direction = sun_direction;
    if (sun_direction.z < 0.0) {
        const double horizontal = std::hypot(sun_direction.x, sun_direction.y);
        sky.sun_direction = horizontal > 0.0 ? Vec3d(sun_direction.x / horizontal, sun_direction.y / horizontal, 0.0)
                                             : Vec3d(0.0, 1.0, 0.0);
    }
    const double sun_zenith = std::acos(std::min(sky.sun_direction.z, 1.0));

    sky.luminance = {Linear{0.17872, -1.46303}(t), Linear{-0.35540, 0.42749}(t), Linear{-0.02266, 5.32505}(t),
                     Linear{0.12064, -2.57705}(t), Linear{-0.06696, 0.37027}(t)};
    sky.x = {Linear{-0.01925, -0.25922}(t), Linear{-0.06651, 0.00081}(t), Linear{-0.00041, 0.21247}(t),
             Linear{-0.06409, -0.89887}(t), Linear{-0.00325, 0.04517}(t)};
    sky.y = {Linear{-0.01669, -0.26078}(t), Linear{-0.09495, 0.00921}(t), Linear{-0.00792, 0.21023}(t),
             Linear{-0.04405, -1.65369}(t), Linear{-0.01092, 0.05291}(t)};

    const double chi = (4.0 / 9.0 - t / 120.0) * (kPi - 2.0 * sun_zenith);
    const double zenith_luminance = 1000.0 * ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192);
    constexpr double kZenithX[3][4] = {{0.00165, -0.00374, 0.00208, 0.0},
                                       {-0.02902, 0.06377, -0.03202, 0.00394},
                                       {0.11693, -0.21196, 0.06052, 0.25885}};
    constexpr double kZenithY[3][4] = {{0.00275, -0.00610, 0.00316, 0.0},
                                       {-0.04214, 0.08970, -0.04153, 0.00515},
                                       {0.15346, -0.26756, 0.06669, 0.26688}};
    fix_zenith(sky.luminance, std::max(zenith_luminance, 0.0), sun_zenith);
    fix_zenith(sky.x, zenith_chromaticity(kZenithX, t, sun_zenith), sun_zenith);
    fix_zenith(sky.y, zenith_chromaticity(kZenithY, t, sun_zenith), sun_zenith);
    return sky;
}

double horizontal_illuminance(const PreethamSky& sky) {
    // Midpoint rule in cos² θ (equal weights of the cosine) and in the azimuth from the sun, over one of the two
    // mirrored halves.
    constexpr int kRings = 96;
    constexpr int kSectors = 48;
    const double sun_cos = sky.sun_direction.z;
    const double sun_sin = std::sqrt(std::max(0.0, 1.0 - sun_cos * sun_cos));
    double sum = 0.0;
    for (int ring = 0; ring < kRings; ++ring) {
        const double cos_zenith = std::sqrt((ring + 0.5) / kRings);
        const double sin_zenith = std::sqrt(1.0 - cos_zenith * cos_zenith);
        for (int sector = 0; sector < kSectors; ++sector) {
            const double cos_gamma = std::clamp(
                sun_cos * cos_zenith + sun_sin * sin_zenith * std::cos(kPi * (sector + 0.5) / kSectors), -1.0, 1.0);
            sum += std::max(0.0, relative_value(sky.luminance, std::max(cos_zenith, kLeastCosZenith),
                                                std::acos(cos_gamma), cos_gamma));
        }
    }
    return sky.luminance.scale * sum * kPi / (kRings * kSectors);
}

PreethamSky scaled_to(PreethamSky sky, double illuminance_lx) {
    sky.luminance.scale = 1.0;
    const double unscaled = horizontal_illuminance(sky);
    sky.luminance.scale = unscaled > 0.0 ? illuminance_lx / unscaled : 0.0;
    return sky;
}

Xyz sky_xyz(const PreethamSky& sky, const Vec3d& direction) {
    if (direction.z < 0.0) return Xyz(0.0);
    const double cos_zenith = std::max(direction.z, kLeastCosZenith);
    const double cos_gamma = std::clamp(glm::dot(direction, sky.sun_direction), -1.0, 1.0);
    const double gamma = std::acos(cos_gamma);
    const double luminance = sky.luminance.scale * relative_value(sky.luminance, cos_zenith, gamma, cos_gamma);
    if (!(luminance > 0.0)) return Xyz(0.0);
    const double x = sky.x.scale * relative_value(sky.x, cos_zenith, gamma, cos_gamma);
    const double y = sky.y.scale * relative_value(sky.y, cos_zenith, gamma, cos_gamma);
    return xyz_from_luminance(luminance, x, y);
}

}  // namespace skybake
