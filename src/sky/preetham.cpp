#include "sky/preetham.h"

#include <algorithm>
#include <cmath>

#include "sky/spectral_tables.h"

namespace skybake {

namespace {

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

/// The scale that makes the distribution `zenith_value` at the zenith.
void fix_zenith(PerezDistribution& p, double zenith_value, double sun_zenith) {
    p.scale = 1.0;
    p.scale = zenith_value / value_of(p, {1.0, sun_zenith, std::cos(sun_zenith)});
}

}  // namespace

PreethamSky preetham_sky(double turbidity, const Vec3d& sun_direction) {
    const double t = std::clamp(turbidity, kPreethamLeastTurbidity, kPreethamMostTurbidity);
    PreethamSky sky;
    sky.sun_direction = lifted_to_horizon(sun_direction);
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
    return horizontal_integral(sky.luminance, sky.sun_direction.z);
}

PreethamSky scaled_to(PreethamSky sky, double illuminance_lx) {
    sky.luminance.scale = 1.0;
    const double unscaled = horizontal_illuminance(sky);
    sky.luminance.scale = unscaled > 0.0 ? illuminance_lx / unscaled : 0.0;
    return sky;
}

Vec2d chromaticity(const PreethamSky& sky, const Vec3d& direction) {
    const ViewAngles view = view_angles(direction, sky.sun_direction);
    return {value_of(sky.x, view), value_of(sky.y, view)};
}

Xyz sky_xyz(const PreethamSky& sky, const Vec3d& direction) {
    if (direction.z < 0.0) return Xyz(0.0);
    const double luminance = value_of(sky.luminance, view_angles(direction, sky.sun_direction));
    if (!(luminance > 0.0)) return Xyz(0.0);
    const Vec2d xy = chromaticity(sky, direction);
    return xyz_from_luminance(luminance, xy.x, xy.y);
}

std::array<double, kSkyWavelengths> sky_spectrum(const PreethamSky& sky, const Vec3d& direction) {
    std::array<double, kSkyWavelengths> spectrum{};
    const double luminance = sky_xyz(sky, direction).y;
    if (!(luminance > 0.0)) return spectrum;
    const Vec2d xy = chromaticity(sky, direction);
    const double m = 0.0241 + 0.2562 * xy.x - 0.7341 * xy.y;
    const double m1 = (-1.3515 - 1.7703 * xy.x + 5.9114 * xy.y) / m;
    const double m2 = (0.0300 - 31.4424 * xy.x + 30.0717 * xy.y) / m;
    const auto observer = standard_observer();
    double sum = 0.0;
    for (std::size_t i = 0; i < spectrum.size(); ++i) {
        const double lambda_nm = kFirstLambdaNm + kLambdaStepNm * static_cast<double>(i);
        spectrum[i] = std::max(0.0, daylight_component(0, lambda_nm) + m1 * daylight_component(1, lambda_nm) +
                                        m2 * daylight_component(2, lambda_nm));
        sum += spectrum[i] * observer[i][1];
    }
    const double k = luminance / (kMaxLuminousEfficacy * kLambdaStepNm * sum);
    for (double& value : spectrum) value *= k;
    return spectrum;
}

}  // namespace skybake
