// The clear sky's luminance and colour. Based on: Preetham, Shirley, Smits, "A practical analytic model for daylight",
// SIGGRAPH 1999, appendix A, with the five-digit coefficients of the authors' own program (docs/physics.md says where
// the model fails).
#pragma once

#include <array>

#include "base/vec.h"
#include "sky/colour.h"
#include "sky/five_parameter_sky.h"

namespace skybake {

/// A Preetham sky for one turbidity and sun; made by preetham_sky, evaluated in any number of directions.
struct PreethamSky {
    Vec3d sun_direction{0.0, 0.0, 1.0};  // world frame, never below the horizon
    PerezDistribution luminance;         // cd m⁻²
    PerezDistribution x;                 // CIE 1931 chromaticity
    PerezDistribution y;
    double efficacy_lm_w = 130.0;  // luminance over broadband radiance, lm W⁻¹
};

/// The turbidities between which the model's distribution and colour are usable (docs/physics.md); preetham_sky
/// evaluates at the nearer end.
inline constexpr double kPreethamLeastTurbidity = 1.7;
inline constexpr double kPreethamMostTurbidity = 15.0;

/// The sky at the absolute level of the paper. A sun below the horizon is taken as standing on it at its azimuth. The
/// paper's zenith luminance is negative for a high turbidity and a low sun (T > 11.2 at the horizon): such a sky comes
/// out black.
PreethamSky preetham_sky(double turbidity, const Vec3d& sun_direction);

/// The same distribution and colour with another level: its horizontal illuminance becomes `illuminance_lx` (≥ 0).
PreethamSky scaled_to(PreethamSky sky, double illuminance_lx);

/// Illuminance of the open horizontal plane by the whole sky, lx; quadrature error below 1e-4.
double horizontal_illuminance(const PreethamSky& sky);

/// CIE 1931 chromaticity (x, y) in a unit direction above the horizon.
Vec2d chromaticity(const PreethamSky& sky, const Vec3d& direction);

/// Luminance (cd m⁻²) with its colour in a unit direction; black below the horizon.
Xyz sky_xyz(const PreethamSky& sky, const Vec3d& direction);

/// 380…780 nm in steps of 5 nm, as standard_observer().
inline constexpr std::size_t kSkyWavelengths = 81;

/// Spectral radiance in a unit direction, W m⁻² sr⁻¹ nm⁻¹: the model's xyY as CIE daylight, k (S0 + M1 S1 + M2 S2)
/// (appendix A.5), with k such that its luminance is the model's. Far from white (low sun) the sum turns negative at
/// some wavelengths: those are 0, and k makes up for them. Zeros below the horizon.
std::array<double, kSkyWavelengths> sky_spectrum(const PreethamSky& sky, const Vec3d& direction);

}  // namespace skybake
