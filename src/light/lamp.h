// Lamps: points of light with an intensity that may hang on the direction.
#pragma once

#include <string>

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

struct Lamp {
    enum class Type { point, spot };

    std::string id;
    Type type = Type::point;
    Vec3f position{0.0f};  // local metres
    /// Luminous intensity, cd per channel: everywhere for a point, inside the cone for a spot.
    Rgb intensity{0.0f};
    // Of a spot: the beam's axis (unit), the half angle outside of which it is dark, and over how much inside of it the
    // light fades in (smoothstep over the angle).
    Vec3f axis{0.0f, 0.0f, -1.0f};
    float cone_half_angle_rad = 0.6f;
    float blend_rad = 0.0f;
};

/// Share of Lamp::intensity that leaves in a unit direction away from the lamp, 0…1.
float intensity_share(const Lamp& lamp, const Vec3f& direction);

/// ∫ intensity_share dω, sr: 4π for a point. Times the intensity it is the lamp's flux. Quadrature error below 1e-5.
double effective_solid_angle(const Lamp& lamp);

/// Irradiance by the lamp at a point of unit normal that nothing hides, lx per channel:
/// E = I cos θ / r² (the inverse square law); 0 behind the surface.
Rgb unobstructed_irradiance(const Lamp& lamp, const Vec3f& position, const Vec3f& normal);

/// Linear Rec. 709 colour of a black body, of luminance 1. Planck's law over the CIE 1931 observer; `kelvin` within
/// 1000…40000.
Rgb black_body_colour(double kelvin);

}  // namespace skybake
