// The light of one instant: a sky model and the sun's beam, in the world frame (x = grid east, y = grid north, z up).
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/rgb.h"
#include "base/vec.h"
#include "sky/preetham.h"

namespace skybake {

/// Same luminance everywhere above the horizon.
struct UniformSky {
    float luminance_cd_m2 = 1000.0f;
};

/// No skylight at all.
struct NoSky {};

/// The closed set of sky models. A new one adds an alternative here and an overload of the two functions below.
using SkyModel = std::variant<NoSky, UniformSky, PreethamSky>;

/// Luminance of the sky in a unit direction of the world frame, cd m⁻² per channel; 0 below the horizon; never negative, always finite.
Rgb sky_luminance(const SkyModel& sky, const Vec3f& direction);

/// Broadband radiance in a unit direction, W m⁻² sr⁻¹; 0 below the horizon.
float sky_radiance(const SkyModel& sky, const Vec3f& direction);

enum class SunShape { point, disc, none };

/// The direct beam. `direction` points to the sun's centre in the world frame (the convergence of the grid is already applied).
struct SunBeam {
    Vec3f direction{0.0f, 0.0f, 1.0f};
    Rgb normal_illuminance{0.0f};      // lx per channel on a plane that faces the sun; 0 below the horizon
    float dni_w_m2 = 0.0f;             // broadband direct normal irradiance
    float angular_radius_rad = 0.00465f;  // half of 0.533° over the distance in AU
    SunShape shape = SunShape::point;
};

struct Daylight {
    std::string label;  // the instant as ISO 8601 with its offset, or "sun AZ,EL"
    SkyModel sky;
    SunBeam sun;
};

}  // namespace skybake
