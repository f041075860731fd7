// What stands behind the city, with the walkthrough's formulas (viewer/src/three/sky.ts, core/panorama.ts).
#pragma once

#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

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

/// The sky that the bake's light came from, its sun, and far land below the horizon.
class Backdrop {
  public:
    /// `panorama` has at least one column and two rows.
    Backdrop(Panorama panorama, const BackdropSun& sun);

    /// cd m⁻² per channel in a unit direction of the world. Bilinear in the panorama; the sun is a sharp disc with a
    /// glow about it.
    Rgb radiance(const Vec3f& direction) const;

  private:
    Rgb sky_at(float azimuth, float elevation) const;

    Panorama panorama_;
    BackdropSun sun_;
    Rgb ground_{0.0f};   // cd m⁻², of far level ground
    Rgb horizon_{0.0f};  // cd m⁻², mean of the lowest row
};

/// What stands behind the textures alone, where there is no light: linear, [0, 1].
Rgb paper_colour(const Vec3f& direction);

}  // namespace skybake
