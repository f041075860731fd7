// Based on: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2(1),
// 1997.
#include "city/repair_outside.h"

#include <cmath>

#include "city/triangulate.h"

namespace skybake::repair_steps {
namespace {

/// Rays leave a little off the normal, so that they do not run along edges and planes that stand at right angles.
const Vec3d kAside{0.0127, 0.0231, 0.0179};
constexpr double kNearest = 1e-3;  // metres

}  // namespace

OutsideTest::OutsideTest(const Geometry& geometry) {
    const auto count = static_cast<std::uint32_t>(geometry.surfaces.size());
    std::vector<double> area(count, 0.0);
    largest_.assign(count, 0);
    std::vector<char> has_triangle(count, 0);
    for (std::uint32_t s = 0; s < count; ++s) {
        for (const std::array<std::uint32_t, 3>& t : triangulate(geometry, geometry.surfaces[s])) {
            const auto at = [&](std::size_t k) { return geometry.vertices[geometry.corners[t[k]]]; };
            triangles_.push_back({at(0), at(1) - at(0), at(2) - at(0), s});
            const double size = glm::length(glm::cross(triangles_.back().ab, triangles_.back().ac));
            if (has_triangle[s] && size <= area[s]) continue;
            has_triangle[s] = 1;
            area[s] = size;
            largest_[s] = static_cast<std::uint32_t>(triangles_.size() - 1);
        }
    }
    for (std::uint32_t s = 0; s < count; ++s) {
        if (!has_triangle[s]) largest_[s] = static_cast<std::uint32_t>(triangles_.size());
    }
}

int OutsideTest::side_of(std::uint32_t surface) const {
    if (largest_[surface] == triangles_.size()) return 0;
    const Triangle& t = triangles_[largest_[surface]];
    const Vec3d normal = glm::normalize(glm::cross(t.ab, t.ac));
    if (!std::isfinite(normal.x)) return 0;
    const Vec3d origin = t.a + (t.ab + t.ac) / 3.0;
    const bool is_front_even = is_even(origin, normal + kAside, surface);
    const bool is_back_even = is_even(origin, -normal + kAside, surface);
    return is_front_even == is_back_even ? 0 : is_front_even ? 1 : -1;
}

bool OutsideTest::is_even(const Vec3d& origin, const Vec3d& direction, std::uint32_t surface) const {
    bool is_even = true;
    for (const Triangle& t : triangles_) {
        if (t.surface == surface) continue;
        const Vec3d p = glm::cross(direction, t.ac);
        const double determinant = glm::dot(t.ab, p);
        if (determinant == 0.0) continue;
        const Vec3d from = origin - t.a;
        const double u = glm::dot(from, p) / determinant;
        if (u < 0.0 || u > 1.0) continue;
        const Vec3d q = glm::cross(from, t.ab);
        const double v = glm::dot(direction, q) / determinant;
        if (v < 0.0 || u + v > 1.0) continue;
        if (glm::dot(t.ac, q) / determinant > kNearest) is_even = !is_even;
    }
    return is_even;
}

}  // namespace skybake::repair_steps
