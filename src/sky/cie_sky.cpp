#include "sky/cie_sky.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace skybake {

namespace {

/// Table 1 of the standard: gradation a, b; indicatrix c, d, e.
constexpr double kTypes[15][5] = {
    {4.0, -0.70, 0.0, -1.0, 0.0},    {4.0, -0.70, 2.0, -1.5, 0.15},   {1.1, -0.80, 0.0, -1.0, 0.0},
    {1.1, -0.80, 2.0, -1.5, 0.15},   {0.0, -1.0, 0.0, -1.0, 0.0},     {0.0, -1.0, 2.0, -1.5, 0.15},
    {0.0, -1.0, 5.0, -2.5, 0.30},    {0.0, -1.0, 10.0, -3.0, 0.45},   {-1.0, -0.55, 2.0, -1.5, 0.15},
    {-1.0, -0.55, 5.0, -2.5, 0.30},  {-1.0, -0.55, 10.0, -3.0, 0.45}, {-1.0, -0.32, 10.0, -3.0, 0.45},
    {-1.0, -0.32, 16.0, -3.0, 0.30}, {-1.0, -0.15, 16.0, -3.0, 0.30}, {-1.0, -0.15, 24.0, -2.8, 0.15}};

/// The angles of the zenith itself.
ViewAngles zenith_view(const Vec3d& sun_direction) {
    return view_angles({0.0, 0.0, 1.0}, sun_direction);
}

/// Luminance of a sky of 1994, up to a factor. `sun_elevation` in radians.
double relative_luminance(Cie1994Type type, const ViewAngles& view, double sun_elevation) {
    switch (type) {
        case Cie1994Type::clear:
            // 0.91 in front of the indicatrix: (0.91 + 10 e^{-3χ} + 0.45 cos² χ)
            return value_of({-1.0, -0.32, 10.0 / 0.91, -3.0, 0.45 / 0.91, 0.91}, view);
        case Cie1994Type::turbid_clear:
            return value_of({-1.0, -0.32, 16.0 / 0.856, -3.0, 0.3 / 0.856, 0.856}, view);
        case Cie1994Type::intermediate: {
            const double elevation = std::asin(std::clamp(view.cos_zenith, 0.0, 1.0));
            const double gradation =
                (1.35 * (std::sin(3.59 * elevation - 0.009) + 2.31) * std::sin(2.6 * sun_elevation + 0.316) +
                 elevation + 4.799) /
                2.326;
            return gradation * std::exp(-0.563 * view.gamma * ((sun_elevation - 0.008) * (elevation + 1.059) + 0.812));
        }
        case Cie1994Type::overcast:
            break;
    }
    return (1.0 + 2.0 * view.cos_zenith) / 3.0;
}

double elevation_of(const Vec3d& sun_direction) {
    return std::asin(std::clamp(sun_direction.z, 0.0, 1.0));
}

}  // namespace

CieGeneralSky cie_general_sky(int type, const Vec3d& sun_direction) {
    SKYBAKE_CHECK_LE(1, type);
    SKYBAKE_CHECK_LE(type, 15);
    const auto [a, b, c, d, e] = kTypes[type - 1];
    // f(χ) = 1 + c (e^{dχ} − e^{dπ/2}) + e cos² χ; its constant part goes into the scale.
    const double constant = 1.0 - c * std::exp(d * kPi / 2.0);
    CieGeneralSky sky;
    sky.sun_direction = lifted_to_horizon(sun_direction);
    sky.luminance = {a, b, c / constant, d, e / constant, constant};
    return with_zenith(sky, 1.0);
}

Cie1994Sky cie_1994_sky(Cie1994Type type, const Vec3d& sun_direction) {
    return {.type = type, .sun_direction = lifted_to_horizon(sun_direction), .zenith_cd_m2 = 1.0, .colour = {}};
}

CieGeneralSky with_zenith(CieGeneralSky sky, double zenith_cd_m2) {
    sky.luminance.scale *= zenith_cd_m2 / value_of(sky.luminance, zenith_view(sky.sun_direction));
    return sky;
}

Cie1994Sky with_zenith(Cie1994Sky sky, double zenith_cd_m2) {
    sky.zenith_cd_m2 = zenith_cd_m2;
    return sky;
}

CieGeneralSky scaled_to(CieGeneralSky sky, double illuminance_lx) {
    sky.luminance.scale *= illuminance_lx / horizontal_integral(sky.luminance, sky.sun_direction.z);
    return sky;
}

Cie1994Sky scaled_to(Cie1994Sky sky, double illuminance_lx) {
    const double sun_elevation = elevation_of(sky.sun_direction);
    const auto relative = [&](const ViewAngles& view) { return relative_luminance(sky.type, view, sun_elevation); };
    sky.zenith_cd_m2 =
        illuminance_lx * relative(zenith_view(sky.sun_direction)) / horizontal_integral(relative, sky.sun_direction.z);
    return sky;
}

double sky_luminance_cd_m2(const CieGeneralSky& sky, const Vec3d& direction) {
    if (direction.z < 0.0) return 0.0;
    return std::max(0.0, value_of(sky.luminance, view_angles(direction, sky.sun_direction)));
}

double sky_luminance_cd_m2(const Cie1994Sky& sky, const Vec3d& direction) {
    if (direction.z < 0.0) return 0.0;
    const double sun_elevation = elevation_of(sky.sun_direction);
    return sky.zenith_cd_m2 * relative_luminance(sky.type, view_angles(direction, sky.sun_direction), sun_elevation) /
           relative_luminance(sky.type, zenith_view(sky.sun_direction), sun_elevation);
}

}  // namespace skybake
