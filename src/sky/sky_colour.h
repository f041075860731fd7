// Colour for the skies whose models give luminance alone: Perez, and those of the CIE.
#pragma once

#include "base/vec.h"
#include "sky/colour.h"
#include "sky/preetham.h"

namespace skybake {

/// A mixture of the blue of a clear sky (Preetham's chromaticity, sky/preetham.h) and the white of clouds (D65).
struct SkyColour {
    PreethamSky clear;
    double clear_share = 0.0;  // 0 overcast … 1 cloudless
};

/// `turbidity` as for preetham_sky; `clear_share` in [0, 1]. A sun below the horizon is taken as standing on it.
SkyColour sky_colour(double turbidity, const Vec3d& sun_direction, double clear_share);

/// XYZ of a sky of `luminance` (cd m⁻², ≥ 0) in a unit direction above the horizon: Y is the luminance exactly, X and Z
/// are those of clear sky and of clouds in the proportion of their shares.
Xyz coloured(const SkyColour& colour, double luminance, const Vec3d& direction);

/// The turbidity in 2…10 at which a clear sky's beam (clear_sky_irradiance) has the given direct normal irradiance; the
/// nearer end where there is none.
double turbidity_of_beam(double dni_w_m2, double sun_zenith_rad, double distance_au);

}  // namespace skybake
