// The absolute level of Radiance's gensky for the skies of 1994: to compare with what other programs computed.
#pragma once

#include "sky/cie_sky.h"

namespace skybake {

/// Turbidity (of Linke's kind, not Preetham's) that gensky takes when it is not told one.
inline constexpr double kGenskyTurbidity = 2.45;

/// Zenith luminance, cd m⁻², ≥ 0, by the empirical formulas in the source of Radiance's gensky (6.0): clear and turbid
/// clear ((1.376 T − 1.81) tan γ + 0.38) k, overcast (and uniform) (8.6 sin γ + 0.123) k, intermediate the mean of the
/// two. The tangent is taken to 80° at most, beyond which it runs away. A sun below the horizon counts as on it.
double gensky_zenith_luminance(Cie1994Type type, double sun_elevation_rad, double turbidity);

/// Illuminance of a plane that faces the sun, lx: 0 for the overcast sky and on and below the horizon.
double gensky_sun_illuminance(Cie1994Type type, double sun_elevation_rad);

/// What gensky divides by to get its (visible) radiances, lm W⁻¹: zenith and sun.
inline constexpr double kGenskySkyEfficacy = 203.0;
inline constexpr double kGenskySunEfficacy = 208.0;

}  // namespace skybake
