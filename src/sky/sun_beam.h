// The sun's beam through clear air. Based on: Preetham, Shirley, Smits 1999, appendix A.1 (transmittances after Iqbal,
// "An introduction to solar radiation", 1983), with the constants of the authors' own program.
#pragma once

#include "sky/colour.h"

namespace skybake {

/// The solid angle over which the authors' program spreads the sun: the beam's illuminance is radiance times this. sr.
inline constexpr double kPreethamSunSolidAngle = 6.7443e-5;

/// The sun's mean angular radius at 1 AU: half of 0.533°.
inline constexpr double kSunAngularRadiusRad = 0.533 / 2.0 * kPi / 180.0;

/// Relative optical air mass at a sun's zenith angle (Kasten 1966); 1 at the zenith, 36.5 at the horizon and, having no
/// meaning, below it.
double air_mass(double sun_zenith_rad);

/// Ångström's turbidity coefficient β (optical depth of the aerosol at 1 µm; exponent 1.3) for a Preetham turbidity.
double aerosol_beta(double turbidity);

/// Transmittances of the direct beam at one wavelength.
struct BeamTransmittance {
    double rayleigh = 1.0;
    double aerosol = 1.0;
    double ozone = 1.0;
    double mixed_gases = 1.0;
    double water_vapour = 1.0;
    double total() const { return rayleigh * aerosol * ozone * mixed_gases * water_vapour; }
};
/// With 0.35 cm of ozone and 2 cm of precipitable water, at sea level.
BeamTransmittance beam_transmittance(double lambda_nm, double relative_air_mass, double turbidity);

/// Irradiance of a plane that faces the sun at one wavelength, W m⁻² nm⁻¹; 0 outside 380…750 nm, and for a sun on or
/// below the horizon.
double sun_normal_irradiance(double lambda_nm, double turbidity, double sun_zenith_rad, double distance_au);

/// Illuminance (Y, lx) of a plane that faces the sun, with its colour: 380…750 nm in steps of 5 nm over the CIE 1931
/// observer. 0 for a sun on or below the horizon.
Xyz sun_normal_illuminance(double turbidity, double sun_zenith_rad, double distance_au);

}  // namespace skybake
