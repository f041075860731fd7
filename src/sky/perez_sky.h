// The sky of any weather. Based on: Perez, Seals, Michalsky, "All-weather model for sky luminance distribution:
// preliminary configuration and validation", Solar Energy 50, 1993, with the luminous efficacies of Perez et al. 1990
// (sky/clear_sky.h).
#pragma once

#include "base/vec.h"
#include "sky/clear_sky.h"
#include "sky/sky_colour.h"

namespace skybake {

/// The solar constant with which Perez's brightness Δ is defined, W m⁻².
inline constexpr double kPerezSolarConstant = 1367.0;

/// Broadband irradiances of an hour or an instant, W m⁻², ≥ 0.
struct PerezWeather {
    double dni = 0.0;
    double dhi = 0.0;
    double distance_au = 1.0;
    double precipitable_water_cm = 2.0;
};

/// A Perez sky for one weather and sun; made by perez_sky, evaluated in any number of directions.
struct PerezSky {
    Vec3d sun_direction{0.0, 0.0, 1.0};  // world frame, never below the horizon
    PerezDistribution luminance;         // cd m⁻²
    double efficacy_lm_w = 115.0;        // of the diffuse light
    SkyColour colour;
};

/// What the weather is to the model, before its clamps; the efficacies, lm W⁻¹; and what the colour of sky and beam is
/// made from.
struct PerezState {
    PerezClass sky;
    double diffuse_efficacy_lm_w = 115.0;
    double direct_efficacy_lm_w = 0.0;
    double clear_share = 0.0;  // of the sky's colour
    double turbidity = 3.0;    // that of the beam, but no hazier than 3 overcast … 7 cloudless
};

/// The ranges of clearness ε and brightness Δ that the model was fitted to; outside, perez_sky takes the nearer end.
inline constexpr double kPerezMostClearness = 12.01;
inline constexpr double kPerezLeastBrightness = 0.01;
inline constexpr double kPerezMostBrightness = 0.6;

/// A sun below the horizon is taken as standing on it, and its DNI as 0. Without diffuse irradiance ε = 1 and Δ = 0.
PerezState perez_state(const PerezWeather& weather, double sun_zenith_rad);

/// The sky whose horizontal irradiance is the weather's DHI and whose illuminance is that times the diffuse efficacy,
/// by quadrature (error below 1e-4). Finite and non-negative for any weather: black for a DHI of 0.
PerezSky perez_sky(const PerezWeather& weather, const Vec3d& sun_direction);

/// The five coefficients for a bin 1…8, a brightness and a sun's zenith angle (rad), scale 1.
PerezDistribution perez_coefficients(int bin, double brightness, double sun_zenith_rad);

/// Luminance in a unit direction, cd m⁻²; 0 below the horizon.
double sky_luminance_cd_m2(const PerezSky& sky, const Vec3d& direction);

}  // namespace skybake
