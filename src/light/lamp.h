// Lamps: points of light with an intensity that may hang on the direction.
#pragma once

#include <memory>
#include <string>

#include "base/rgb.h"
#include "base/vec.h"
#include "light/light_profile.h"

namespace skybake {

struct Lamp {
    enum class Type { point, spot, profile };

    std::string id;
    Type type = Type::point;
    Vec3f position{0.0f};  // local metres
    /// Luminous intensity, cd per channel: everywhere for a point, inside the cone for a spot, the peak of a profile.
    Rgb intensity{0.0f};
    // Of a spot: the beam's axis (unit), the half angle outside of which it is dark, and over how much inside of it the
    // light fades in (smoothstep over the angle).
    Vec3f axis{0.0f, 0.0f, -1.0f};  // of a profile: γ = 0
    float cone_half_angle_rad = 0.6f;
    float blend_rad = 0.0f;
    // Of a profile: the distribution, and the direction of C = 0 (unit, at a right angle to the axis).
    std::shared_ptr<const LightProfile> profile = nullptr;
    Vec3f c_zero{1.0f, 0.0f, 0.0f};
};

/// Share of Lamp::intensity that leaves in a unit direction away from the lamp, 0…1.
float intensity_share(const Lamp& lamp, const Vec3f& direction);

/// The most that intensity_share is within `half_angle_rad` of a unit direction.
float largest_intensity_share(const Lamp& lamp, const Vec3f& direction, float half_angle_rad);

/// A unit direction that the lamp shines in, for u, v in [0, 1), and its density, sr⁻¹: even over the sphere or the
/// cone, or close to the profile.
struct LampSample {
    Vec3f direction{0.0f};
    double pdf_solid_angle = 0.0;
};
LampSample sample_lamp(const Lamp& lamp, float u, float v);

/// ∫ intensity_share dω, sr: 4π for a point. Times the intensity it is the lamp's flux. Quadrature error below 1e-5; of
/// a profile as LightProfile states it.
double effective_solid_angle(const Lamp& lamp);

/// Irradiance by the lamp at a point of unit normal that nothing hides, lx per channel:
/// E = I cos θ / r² (the inverse square law); 0 behind the surface.
Rgb unobstructed_irradiance(const Lamp& lamp, const Vec3f& position, const Vec3f& normal);

/// Linear Rec. 709 colour of a black body, of luminance 1. Planck's law over the CIE 1931 observer; `kelvin` within
/// 1000…40000.
Rgb black_body_colour(double kelvin);

}  // namespace skybake
