// The light of one instant: a sky model and the sun's beam, in the world frame (x = grid east, y = grid north, z up).
#pragma once

#include <string>
#include <variant>

#include "base/rgb.h"
#include "base/vec.h"
#include "sky/cie_sky.h"
#include "sky/image_sky.h"
#include "sky/perez_sky.h"
#include "sky/preetham.h"

namespace skybake {

/// Same luminance everywhere above the horizon, white (D65).
struct UniformSky {
    float luminance_cd_m2 = 1000.0f;
};

/// No skylight at all.
struct NoSky {};

/// The closed set of sky models. A new one adds an alternative here and the overloads that daylight.cpp visits it
/// with.
using SkyModel = std::variant<NoSky, UniformSky, PreethamSky, PerezSky, CieGeneralSky, Cie1994Sky, ImageSky>;

/// Luminance of the sky in a unit direction of the world frame, cd m⁻² per channel; 0 below the horizon; never
/// negative, always finite. Costs about 0.1 µs (with colour by Preetham 0.2 µs). Thread-safe.
Rgb sky_luminance(const SkyModel& sky, const Vec3f& direction);

/// The same as CIE 1931 XYZ (Y in cd m⁻²) before the colour is brought into Rec. 709.
Xyz sky_xyz(const SkyModel& sky, const Vec3d& direction);

/// Broadband radiance in a unit direction, W m⁻² sr⁻¹; 0 below the horizon. The model's luminance over one luminous
/// efficacy for the whole sky.
float sky_radiance(const SkyModel& sky, const Vec3f& direction);

/// What the sky without the sun gives to the open horizontal plane: lx per channel, and W m⁻². Quadrature error below
/// 2e-4.
struct HorizontalDiffuse {
    Rgb illuminance{0.0f};
    double irradiance_w_m2 = 0.0;
};
HorizontalDiffuse horizontal_diffuse(const SkyModel& sky);

enum class SunShape { point, disc, none };

/// The direct beam. `direction` points to the sun's centre in the world frame (refraction and the convergence of the
/// grid are applied).
struct SunBeam {
    Vec3f direction{0.0f, 0.0f, 1.0f};
    Rgb normal_illuminance{
        0.0f};  // lx per channel on a plane that faces the sun; 0 on and below the horizon, and for SunShape::none
    float dni_w_m2 = 0.0f;                // broadband direct normal irradiance; 0 likewise
    float angular_radius_rad = 0.00465f;  // half of 0.533° over the distance in AU
    SunShape shape = SunShape::point;
};

struct Daylight {
    std::string label;  // the instant as ISO 8601 with its offset, "sun AZ,EL" in degrees, or "no sun"
    SkyModel sky;
    SunBeam sun;
    double turbidity = 3.0;  // of the air that one looks through (sky/aerial_perspective.h), Preetham's, ≥ 1
};

/// Albedo of the land about the city, luminous 0.2: that of the clear sky's ground (sky/clear_sky.h), in the hue of
/// fields, roofs and streets seen from afar (by eye).
inline const Rgb kLandAlbedo{0.206f, 0.201f, 0.178f};

/// Luminance of open level land under sky and sun, cd m⁻² per channel: Lambert, E ρ / π.
Rgb land_luminance(const Daylight& daylight);

}  // namespace skybake
