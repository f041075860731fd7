#include "sky/clear_sky.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/vec.h"
#include "sky/sun_beam.h"

namespace skybake {

ClearSkyIrradiance clear_sky_irradiance(double turbidity, double sun_zenith_rad, double distance_au) {
    if (sun_zenith_rad >= kPi / 2.0) return {};
    constexpr double kOzoneCm = 0.35;
    constexpr double kWaterCm = 2.0;
    constexpr double kForward = 0.84;      // Ba
    constexpr double kAbsorption = 0.1;    // K1, for ω0 = 0.9
    constexpr double kGroundAlbedo = 0.2;  // rg
    const double m = air_mass(sun_zenith_rad);
    const double m_rayleigh = std::min(m, 14.0);

    const double t_rayleigh =
        std::exp(-0.0903 * std::pow(m_rayleigh, 0.84) * (1.0 + m_rayleigh - std::pow(m_rayleigh, 1.01)));
    const double x_o = kOzoneCm * m;
    const double t_ozone = 1.0 - 0.1611 * x_o * std::pow(1.0 + 139.48 * x_o, -0.3035) -
                           0.002715 * x_o / (1.0 + 0.044 * x_o + 0.0003 * x_o * x_o);
    const double t_gases = std::exp(-0.0127 * std::pow(m, 0.26));
    const double x_w = kWaterCm * m;
    const double t_water = 1.0 - 2.4959 * x_w / (std::pow(1.0 + 79.034 * x_w, 0.6828) + 6.385 * x_w);
    const double beta = aerosol_beta(turbidity);
    const double tau = 0.2758 * beta * std::pow(0.38, -1.3) + 0.35 * beta * std::pow(0.5, -1.3);
    const double t_aerosol =
        std::exp(-std::pow(tau, 0.873) * (1.0 + tau - std::pow(tau, 0.7088)) * std::pow(m, 0.9108));
    const double t_absorbed = 1.0 - kAbsorption * (1.0 - m + std::pow(m, 1.06)) * (1.0 - t_aerosol);
    const double t_scattered = t_aerosol / t_absorbed;

    const double extraterrestrial = kSolarConstant / (distance_au * distance_au);
    const double cos_zenith = std::cos(sun_zenith_rad);
    const double dni = extraterrestrial * 0.9662 * t_rayleigh * t_ozone * t_gases * t_water * t_aerosol;
    const double scattered = extraterrestrial * cos_zenith * 0.79 * t_ozone * t_water * t_gases * t_absorbed *
                             (0.5 * (1.0 - t_rayleigh) + kForward * (1.0 - t_scattered)) /
                             (1.0 - m + std::pow(m, 1.02));
    const double sky_albedo = 0.0685 + (1.0 - kForward) * (1.0 - t_scattered);
    const double ghi = (dni * cos_zenith + scattered) / (1.0 - kGroundAlbedo * sky_albedo);
    return {std::max(dni, 0.0), std::max(ghi - dni * cos_zenith, 0.0)};
}

PerezClass perez_class(double dni, double dhi, double sun_zenith_rad, double extraterrestrial_w_m2) {
    const double kappa_z3 = 1.041 * sun_zenith_rad * sun_zenith_rad * sun_zenith_rad;
    PerezClass perez;
    perez.clearness = ((dhi + dni) / dhi + kappa_z3) / (1.0 + kappa_z3);
    perez.brightness = air_mass(sun_zenith_rad) * dhi / extraterrestrial_w_m2;
    constexpr double kUpper[] = {1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};
    perez.bin = 1 + static_cast<int>(std::upper_bound(std::begin(kUpper), std::end(kUpper), perez.clearness) -
                                     std::begin(kUpper));
    return perez;
}

namespace {

/// One row of table 4 (diffuse), lm W⁻¹; `bin` 1…8.
double efficacy_of_bin(int bin, double zenith, double brightness, double precipitable_water_cm) {
    constexpr double kCoefficients[8][4] = {{97.24, -0.46, 12.00, -8.91},   {107.22, 1.15, 0.59, -3.95},
                                            {104.97, 2.96, -5.53, -8.77},   {102.39, 5.59, -13.95, -13.90},
                                            {100.71, 5.94, -22.75, -23.74}, {106.42, 3.83, -36.15, -28.83},
                                            {141.88, 1.90, -53.24, -14.03}, {152.23, 0.35, -45.27, -7.98}};
    const double(&k)[4] = kCoefficients[bin - 1];
    return k[0] + k[1] * precipitable_water_cm + k[2] * std::cos(zenith) +
           k[3] * std::log(std::clamp(brightness, 0.01, 0.6));
}

double efficacy_zenith(double sun_zenith_rad) {
    return std::min(sun_zenith_rad, radians_from_degrees(87.0));
}

}  // namespace

double diffuse_luminous_efficacy(double dni, double dhi, double sun_zenith_rad, double extraterrestrial_w_m2,
                                 double precipitable_water_cm) {
    const double zenith = efficacy_zenith(sun_zenith_rad);
    const PerezClass perez = perez_class(dni, dhi, zenith, extraterrestrial_w_m2);
    return efficacy_of_bin(perez.bin, zenith, perez.brightness, precipitable_water_cm);
}

double smooth_diffuse_luminous_efficacy(double dni, double dhi, double sun_zenith_rad, double extraterrestrial_w_m2,
                                        double precipitable_water_cm) {
    const double zenith = efficacy_zenith(sun_zenith_rad);
    const PerezClass perez = perez_class(dni, dhi, zenith, extraterrestrial_w_m2);
    // Geometric middles of the bins 1…7; 8, which is open above, is fully reached at ε = 8.
    constexpr double kMiddles[8] = {1.032, 1.145, 1.358, 1.710, 2.337, 3.550, 5.282, 8.0};
    const double clearness = std::clamp(perez.clearness, kMiddles[0], kMiddles[7]);
    int below = 0;
    while (below < 6 && clearness >= kMiddles[below + 1]) ++below;
    const double share = std::log(clearness / kMiddles[below]) / std::log(kMiddles[below + 1] / kMiddles[below]);
    return (1.0 - share) * efficacy_of_bin(below + 1, zenith, perez.brightness, precipitable_water_cm) +
           share * efficacy_of_bin(below + 2, zenith, perez.brightness, precipitable_water_cm);
}

double direct_luminous_efficacy(int bin, double brightness, double sun_zenith_rad, double precipitable_water_cm) {
    constexpr double kCoefficients[8][4] = {{57.20, -4.55, -2.98, 117.12}, {98.99, -3.46, -1.21, 12.38},
                                            {109.83, -4.90, -1.71, -8.81}, {110.34, -5.84, -1.99, -4.56},
                                            {106.36, -3.97, -1.75, -6.16}, {107.19, -1.25, -1.51, -26.73},
                                            {105.75, 0.77, -1.26, -34.44}, {101.18, 1.58, -1.10, -8.29}};
    const double(&k)[4] = kCoefficients[bin - 1];
    return std::max(0.0, k[0] + k[1] * precipitable_water_cm +
                             k[2] * std::exp(5.73 * efficacy_zenith(sun_zenith_rad) - 5.0) +
                             k[3] * std::clamp(brightness, 0.01, 0.6));
}

double twilight_illuminance(double sun_elevation_rad) {
    const double elevation = std::max(sun_elevation_rad, radians_from_degrees(-18.0));
    constexpr double kOutsideLx = 133'775.0;
    constexpr double kHeights = 753.66156;  // the Earth's radius in scale heights of the air
    const double sine = std::sin(elevation);
    const double s = std::asin(kHeights * std::cos(elevation) / (kHeights + 1.0));
    const double path = kHeights * (std::cos(s) - sine) + std::cos(s);
    return kOutsideLx * 0.0289 * std::exp(-0.042 * path) * (1.0 + (elevation + kPi / 2.0) * sine);
}

}  // namespace skybake
