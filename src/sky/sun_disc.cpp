#include "sky/sun_disc.h"

#include <cmath>

#include "base/low_discrepancy.h"

namespace skybake {

std::vector<Vec3f> sun_disc_directions(const SunBeam& sun, int count) {
    if (count == 1) return {sun.direction};
    const Vec3f helper = std::abs(sun.direction.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
    const Vec3f a = glm::normalize(glm::cross(helper, sun.direction)), b = glm::cross(sun.direction, a);
    std::vector<Vec3f> directions;
    for (int i = 0; i < count; ++i) {
        const float r = sun.angular_radius_rad * std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
        const float turn = static_cast<float>(2.0 * kPi * radical_inverse(2, static_cast<std::uint32_t>(i)));
        directions.push_back(glm::normalize(sun.direction + r * (std::cos(turn) * a + std::sin(turn) * b)));
    }
    return directions;
}

}  // namespace skybake
