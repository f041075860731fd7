// How much energy a clear sky and its sun give, how bright that looks, and how dusk fades. The level of the Preetham
// sky hangs on these.
#pragma once

namespace skybake {

/// Solar irradiance outside the atmosphere at 1 AU (Kopp & Lean 2011), W m⁻².
inline constexpr double kSolarConstant = 1361.1;

/// Broadband irradiance of a cloudless sky, W m⁻².
struct ClearSkyIrradiance {
    double dni = 0.0;
    double dhi = 0.0;
};

/// Based on: Bird & Hulstrom, "A simplified clear sky model for direct and diffuse insolation on horizontal surfaces",
/// SERI/TR-642-761, 1981, with the air of the Preetham beam: 0.35 cm ozone, 2 cm water, aerosol β of `turbidity` with
/// exponent 1.3; sea-level pressure, single scattering albedo 0.9, forward scattering 0.84, ground albedo 0.2. Within
/// 10 % of line-by-line codes to a zenith angle of 80°; lower suns are extrapolated (Rayleigh's part is held at its
/// value for air mass 14, beyond which the fit turns round). 0 for a sun on or below the horizon.
ClearSkyIrradiance clear_sky_irradiance(double turbidity, double sun_zenith_rad, double distance_au);

/// Luminous efficacy of skylight, lm W⁻¹. Based on: Perez, Ineichen, Seals, Michalsky, Stewart, "Modeling daylight
/// availability and irradiance components from direct and global irradiance", Solar Energy 44, 1990, equation 6 and
/// table 4 (diffuse). `extraterrestrial_w_m2` is the normal irradiance outside the atmosphere. Zenith angles beyond 87°
/// are taken as 87°, and the brightness Δ is kept within 0.01…0.6, as gendaylit does; `dhi` must be positive.
double diffuse_luminous_efficacy(double dni, double dhi, double sun_zenith_rad, double extraterrestrial_w_m2,
                                 double precipitable_water_cm);

/// The same without the jumps of up to 15 % at the borders of the bins: linear in ln ε between the bins' geometric
/// middles. So a sky that is computed for a series of instants brightens and fades without steps.
double smooth_diffuse_luminous_efficacy(double dni, double dhi, double sun_zenith_rad, double extraterrestrial_w_m2,
                                        double precipitable_water_cm);

/// Luminous efficacy of the sun's beam, lm W⁻¹, ≥ 0. The same paper, equation 8 and table 4 (direct). `bin` 1…8 and
/// `brightness` as of perez_class.
double direct_luminous_efficacy(int bin, double brightness, double sun_zenith_rad, double precipitable_water_cm);

/// Luminous efficacy of an overcast or uniform sky, lm W⁻¹: what the formula above gives for ε = 1 and Δ = 0.2…0.4
/// (113…117).
inline constexpr double kOvercastEfficacy = 115.0;

/// The clearness ε and brightness Δ of Perez 1990 and the bin (1…8) of ε.
struct PerezClass {
    double clearness = 1.0;
    double brightness = 0.0;
    int bin = 1;
};
PerezClass perez_class(double dni, double dhi, double sun_zenith_rad, double extraterrestrial_w_m2);

/// Horizontal illuminance of the clear sky without the sun, lx, for any elevation of the sun down to −18° (below: that
/// of −18°, 7e-6 lx; the stars are not in it). Based on: Janiczek & DeYoung, "Computer programs for sun and moon
/// illuminance", US Naval Observatory circular 171, 1987, subroutine ATMOS, its skylight term.
double twilight_illuminance(double sun_elevation_rad);

}  // namespace skybake
