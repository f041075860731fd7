#include "light/light_sources.h"

#include <cmath>

#include "light/surfaces.h"

namespace skybake {

Vec3f sample_sun(const SunBeam& sun, float u, float v) {
    if (sun.shape != SunShape::disc) return sun.direction;
    const TangentFrame frame = tangent_frame(sun.direction);
    const float r = sun.angular_radius_rad * std::sqrt(u);
    const float turn = static_cast<float>(2.0 * kPi) * v;
    return glm::normalize(sun.direction + r * (std::cos(turn) * frame.u + std::sin(turn) * frame.v));
}

}  // namespace skybake
