#include "sky/perez_sky.h"

#include <algorithm>
#include <cmath>

namespace skybake {

namespace {

// Table 1 of the paper: rows a, b, c, d, e of each bin, columns x1…x4.
constexpr double kCoefficients[8][5][4] = {{{1.3525, -0.2576, -0.2690, -1.4366},
                                            {-0.7670, 0.0007, 1.2734, -0.1233},
                                            {2.8000, 0.6004, 1.2375, 1.0000},
                                            {1.8734, 0.6297, 0.9738, 0.2809},
                                            {0.0356, -0.1246, -0.5718, 0.9938}},
                                           {{-1.2219, -0.7730, 1.4148, 1.1016},
                                            {-0.2054, 0.0367, -3.9128, 0.9156},
                                            {6.9750, 0.1774, 6.4477, -0.1239},
                                            {-1.5798, -0.5081, -1.7812, 0.1080},
                                            {0.2624, 0.0672, -0.2190, -0.4285}},
                                           {{-1.1000, -0.2515, 0.8952, 0.0156},
                                            {0.2782, -0.1812, -4.5000, 1.1766},
                                            {24.7219, -13.0812, -37.7000, 34.8438},
                                            {-5.0000, 1.5218, 3.9229, -2.6204},
                                            {-0.0156, 0.1597, 0.4199, -0.5562}},
                                           {{-0.5484, -0.6654, -0.2672, 0.7117},
                                            {0.7234, -0.6219, -5.6812, 2.6297},
                                            {33.3389, -18.3000, -62.2500, 52.0781},
                                            {-3.5000, 0.0016, 1.1477, 0.1062},
                                            {0.4659, -0.3296, -0.0876, -0.0329}},
                                           {{-0.6000, -0.3566, -2.5000, 2.3250},
                                            {0.2937, 0.0496, -5.6812, 1.8415},
                                            {21.0000, -4.7656, -21.5906, 7.2492},
                                            {-3.5000, -0.1554, 1.4062, 0.3988},
                                            {0.0032, 0.0766, -0.0656, -0.1294}},
                                           {{-1.0156, -0.3670, 1.0078, 1.4051},
                                            {0.2875, -0.5328, -3.8500, 3.3750},
                                            {14.0000, -0.9999, -7.1406, 7.5469},
                                            {-3.4000, -0.1078, -1.0750, 1.5702},
                                            {-0.0672, 0.4016, 0.3017, -0.4844}},
                                           {{-1.0000, 0.0211, 0.5025, -0.5119},
                                            {-0.3000, 0.1922, 0.7023, -1.6317},
                                            {19.0000, -5.0000, 1.2438, -1.9094},
                                            {-4.0000, 0.0250, 0.3844, 0.2656},
                                            {1.0468, -0.3788, -2.4517, 1.4656}},
                                           {{-1.0500, 0.0289, 0.4260, 0.3590},
                                            {-0.3250, 0.1156, 0.7781, 0.0025},
                                            {31.0625, -14.5000, -46.1148, 55.3750},
                                            {-7.2312, 0.4050, 13.3500, 0.6234},
                                            {1.5000, -0.6426, 1.8564, 0.5636}}};

double zenith_angle(const Vec3d& sun_direction) {
    return std::acos(std::clamp(sun_direction.z, 0.0, 1.0));
}

/// How cloudless the sky is, for its colour: ln ε over that of a clear sky of turbidity 4 under the same sun, so that a
/// clear sunset, whose ε is small, counts as clear.
double clear_share_of(double clearness, double sun_zenith_rad, double distance_au) {
    const ClearSkyIrradiance clear = clear_sky_irradiance(4.0, sun_zenith_rad, distance_au);
    if (!(clear.dhi > 0.0)) return 0.0;
    const double reference =
        perez_class(clear.dni, clear.dhi, sun_zenith_rad, kPerezSolarConstant / (distance_au * distance_au)).clearness;
    constexpr double kLeastLog = 0.02;  // beyond that the clear sky's own beam is lost
    return std::clamp(std::log(clearness) / std::max(std::log(reference), kLeastLog), 0.0, 1.0);
}

}  // namespace

PerezState perez_state(const PerezWeather& weather, double sun_zenith_rad) {
    PerezState state;
    const double extraterrestrial = kPerezSolarConstant / (weather.distance_au * weather.distance_au);
    const double zenith = std::min(sun_zenith_rad, kPi / 2.0);
    const double dni = sun_zenith_rad < kPi / 2.0 ? weather.dni : 0.0;
    if (weather.dhi > 0.0) {
        state.sky = perez_class(dni, weather.dhi, zenith, extraterrestrial);
        state.diffuse_efficacy_lm_w =
            diffuse_luminous_efficacy(dni, weather.dhi, zenith, extraterrestrial, weather.precipitable_water_cm);
    } else if (dni > 0.0) {
        state.sky = {kPerezMostClearness, 0.0, 8};
    }
    state.direct_efficacy_lm_w =
        direct_luminous_efficacy(state.sky.bin, state.sky.brightness, zenith, weather.precipitable_water_cm);
    // What dims the beam under broken clouds is clouds; the blue between them, and the sun, have the colour of clear
    // air.
    state.clear_share =
        clear_share_of(std::clamp(state.sky.clearness, 1.0, kPerezMostClearness), zenith, weather.distance_au);
    state.turbidity = std::min(turbidity_of_beam(dni, zenith, weather.distance_au), 3.0 + 4.0 * state.clear_share);
    return state;
}

PerezDistribution perez_coefficients(int bin, double brightness, double sun_zenith_rad) {
    const auto& rows = kCoefficients[bin - 1];
    const auto linear = [&](int row) {
        const double(&x)[4] = rows[row];
        return x[0] + x[1] * sun_zenith_rad + brightness * (x[2] + x[3] * sun_zenith_rad);
    };
    PerezDistribution p{linear(0), linear(1), linear(2), linear(3), linear(4), 1.0};
    if (bin == 1) {  // equations 6 and 7 of the paper
        const double(&c)[4] = rows[2];
        const double(&d)[4] = rows[3];
        p.c = std::exp(std::pow(brightness * (c[0] + c[1] * sun_zenith_rad), c[2])) - c[3];
        p.d = -std::exp(brightness * (d[0] + d[1] * sun_zenith_rad)) + d[2] + brightness * d[3];
    }
    return p;
}

PerezSky perez_sky(const PerezWeather& weather, const Vec3d& sun_direction) {
    PerezSky sky;
    sky.sun_direction = lifted_to_horizon(sun_direction);
    const double zenith = zenith_angle(sky.sun_direction);
    const PerezState state = perez_state(weather, sun_direction.z > 0.0 ? zenith : kPi / 2.0);
    // The clamps of Radiance's gendaylit. Without the floor of 0.2 some partly cloudy skies turn negative.
    const double clearness = std::clamp(state.sky.clearness, 1.0, kPerezMostClearness);
    double brightness = std::clamp(state.sky.brightness, kPerezLeastBrightness, kPerezMostBrightness);
    if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);
    sky.luminance = perez_coefficients(state.sky.bin, brightness, zenith);
    // A positive b makes the gradation grow beyond all bounds at the horizon; the paper's fits reach it only outside of
    // what they were made from.
    sky.luminance.b = std::min(sky.luminance.b, 0.0);
    const double integral = horizontal_integral(sky.luminance, sky.sun_direction.z);
    sky.efficacy_lm_w = state.diffuse_efficacy_lm_w;
    sky.luminance.scale = integral > 0.0 ? weather.dhi * state.diffuse_efficacy_lm_w / integral : 0.0;
    sky.colour = sky_colour(state.turbidity, sky.sun_direction, state.clear_share);
    return sky;
}

double sky_luminance_cd_m2(const PerezSky& sky, const Vec3d& direction) {
    if (direction.z < 0.0) return 0.0;
    return std::max(0.0, value_of(sky.luminance, view_angles(direction, sky.sun_direction)));
}

}  // namespace skybake
