// Vectors of the world frame: right-handed, metres, x = grid east, y = grid north, z up (docs/architecture.md).
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace skybake {

using Vec2f = glm::vec2;
using Vec3f = glm::vec3;
using Vec2d = glm::dvec2;
using Vec3d = glm::dvec3;
using Vec2i = glm::ivec2;

inline constexpr double kPi = 3.14159265358979323846;

constexpr double radians_from_degrees(double degrees) {
    return degrees * (kPi / 180.0);
}
constexpr double degrees_from_radians(double radians) {
    return radians * (180.0 / kPi);
}

}  // namespace skybake
