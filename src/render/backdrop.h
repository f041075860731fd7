// What stands behind the city and before it, with the walkthrough's formulas (viewer/src/three/sky.ts, three/air.ts).
#pragma once

#include <optional>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "sky/aerial_perspective.h"

namespace skybake {

/// A picture of the upper hemisphere, cd m⁻² per channel: rows and columns as sky/sky_panorama.h has them.
struct Panorama {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;  // width × height
};

struct BackdropSun {
    Vec3f direction{0.0f, 0.0f, 1.0f};  // unit
    Rgb normal_illuminance{0.0f};       // lx; 0 where no disc is to be seen
    float angular_radius_rad = 0.00465f;
};

/// Level land about the city, as far as one sees.
struct BackdropLand {
    Rgb luminance{0.0f};    // cd m⁻²
    float height_m = 0.0f;  // local z; the air's coefficients hold there as well
};

/// The sky that the bake's light came from, its sun, land below the horizon, and the air before all of it.
class Backdrop {
  public:
    /// `panorama` has at least one column and two rows. Without `air` one sees as in a vacuum.
    Backdrop(Panorama panorama, const BackdropSun& sun, const BackdropLand& land, std::optional<Air> air);

    /// cd m⁻² per channel from `eye` (local metres) in a unit direction of the world. Bilinear in the panorama; the sun
    /// is a sharp disc with a glow about it.
    Rgb radiance(const Vec3f& eye, const Vec3f& direction) const;

    /// What is left of a surface's luminance over a distance, and what the air adds; cd m⁻² per channel.
    Rgb through_air(const Rgb& luminance, const Vec3f& eye, const Vec3f& direction, float distance_m) const;

  private:
    Rgb sky_at(float azimuth, float elevation) const;
    /// The sun's disc, and forward scatter of the eye and of haze about it.
    Rgb sun_at(const Vec3f& direction, float elevation) const;

    Panorama panorama_;
    BackdropSun sun_;
    BackdropLand land_;
    std::optional<Air> air_;
};

/// What stands behind the textures alone, where there is no light: linear, [0, 1].
Rgb paper_colour(const Vec3f& direction);

}  // namespace skybake
