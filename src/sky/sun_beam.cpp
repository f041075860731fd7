#include "sky/sun_beam.h"

#include <algorithm>
#include <cmath>

#include "sky/spectral_tables.h"

namespace skybake {

double air_mass(double sun_zenith_rad) {
    const double zenith = std::min(sun_zenith_rad, kPi / 2.0);
    return 1.0 / (std::cos(zenith) + 0.15 * std::pow(93.885 - degrees_from_radians(zenith), -1.253));
}

double aerosol_beta(double turbidity) {
    return 0.04608365822050 * turbidity - 0.04586025928522;
}

BeamTransmittance beam_transmittance(double lambda_nm, double m, double turbidity) {
    constexpr double kOzoneCm = 0.35;
    constexpr double kWaterCm = 2.0;
    const double lambda_um = lambda_nm / 1000.0;
    const double gases = mixed_gas_absorption(lambda_nm) * m;
    const double water = water_vapour_absorption(lambda_nm) * kWaterCm * m;
    BeamTransmittance tau;
    tau.rayleigh = std::exp(-0.008735 * m * std::pow(lambda_um, -4.08));
    tau.aerosol = std::exp(-aerosol_beta(turbidity) * m * std::pow(lambda_um, -1.3));
    tau.ozone = std::exp(-kOzoneCm * ozone_absorption(lambda_nm) * m);
    tau.mixed_gases = std::exp(-1.41 * gases / std::pow(1.0 + 118.93 * gases, 0.45));
    tau.water_vapour = std::exp(-0.2385 * water / std::pow(1.0 + 20.07 * water, 0.45));
    return tau;
}

double sun_normal_irradiance(double lambda_nm, double turbidity, double sun_zenith_rad, double distance_au) {
    if (sun_zenith_rad >= kPi / 2.0) return 0.0;
    return extraterrestrial_sun_radiance(lambda_nm) *
           beam_transmittance(lambda_nm, air_mass(sun_zenith_rad), turbidity).total() * kPreethamSunSolidAngle /
           (distance_au * distance_au);
}

Xyz sun_normal_illuminance(double turbidity, double sun_zenith_rad, double distance_au) {
    const auto observer = standard_observer();
    Xyz sum(0.0);
    for (std::size_t i = 0; i < observer.size(); ++i) {
        const double lambda_nm = kFirstLambdaNm + kLambdaStepNm * static_cast<double>(i);
        sum += sun_normal_irradiance(lambda_nm, turbidity, sun_zenith_rad, distance_au) *
               Xyz(observer[i][0], observer[i][1], observer[i][2]);
    }
    return sum * (kMaxLuminousEfficacy * kLambdaStepNm);
}

}  // namespace skybake
