// From what --sky says to a sky with its absolute level and colour, and the beam that goes with it.
#pragma once

#include <memory>

#include "base/finding.h"
#include "sky/daylight.h"
#include "sky/sky_settings.h"

namespace skybake {

/// The sun as all models need it.
struct SeenSun {
    double elevation_rad = 0.0;  // apparent
    double distance_au = 1.0;
    Vec3d direction{0.0, 0.0, 1.0};  // world frame
    double zenith_rad() const { return kPi / 2.0 - elevation_rad; }
};

/// The sky for a sun. An image sky must have its picture; `convergence_rad` turns it from true to grid north.
/// Levels that are not given (docs/physics.md, "Level"):
///   preetham, cie types 11…15, clear and turbid clear of 1994   a clear sky's diffuse irradiance at the turbidity
///   cie types 1…5, overcast of 1994                             300 + 21000 sin γ lx
///   cie types 6…10, intermediate of 1994                        0.4 of the extraterrestrial illuminance
/// and never less than the twilight has (sky/clear_sky.h).
SkyModel sky_model(const SkySettings& settings, const SeenSun& sun, double convergence_rad);

/// What a plane that faces the sun gets from it; 0 on and below the horizon, under overcast skies, and where an image
/// keeps its sun.
struct Beam {
    Xyz normal_illuminance{0.0};  // lx
    double dni_w_m2 = 0.0;
};
Beam sun_beam(const SkySettings& settings, const SeenSun& sun);

/// Turbidity of the air that one looks through: the sky's own; Perez's that of the beam (perez_state); a CIE type's
/// that of its clear sky, or kDefaultTurbidity below clouds, or what the user says; else that of the beam.
double air_turbidity(const SkySettings& settings, const SeenSun& sun);

/// The picture of a file, cd m⁻², as `settings` ask for it: the sun cut out, then brought to the diffuse irradiance.
/// Finding SB606 when there is no sun to cut.
std::shared_ptr<const SkyImage> prepared_image(const ImageSettings& settings, SkyImage image, FindingLog& findings);

}  // namespace skybake
