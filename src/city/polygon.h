// The plane of a polygon: its area vector, its place in the plane, its area.
#pragma once

#include <cstdint>
#include <span>

#include "base/vec.h"
#include "city/city_model.h"

namespace skybake {

/// The corners of ring `ring`, as indices into Geometry::vertices.
inline std::span<const std::uint32_t> ring_of(const Geometry& geometry, std::uint32_t ring) {
    return std::span(geometry.corners)
        .subspan(geometry.ring_first[ring], geometry.ring_first[ring + 1] - geometry.ring_first[ring]);
}

/// Half the sum of the cross products of consecutive corners (Newell): its length is the ring's area in square metres,
/// its direction the side from which the ring runs counter-clockwise. Zero for fewer than three corners.
Vec3d ring_area_vector(const Geometry& geometry, std::uint32_t ring);

/// The area vector of the outer ring shortened by the holes' areas; zero when the outer ring has none.
Vec3d surface_area_vector(const Geometry& geometry, const Surface& surface);

/// Coordinates in a plane: a right-handed frame (u, v, normal) about `origin`.
struct PlaneFrame {
    Vec3d origin{0.0};
    Vec3d u{1.0, 0.0, 0.0};
    Vec3d v{0.0, 1.0, 0.0};
    Vec3d normal{0.0, 0.0, 1.0};

    Vec2d project(const Vec3d& p) const { return {glm::dot(p - origin, u), glm::dot(p - origin, v)}; }
    double height(const Vec3d& p) const { return glm::dot(p - origin, normal); }
    Vec3d lift(const Vec2d& p) const { return origin + p.x * u + p.y * v; }
};

/// The frame through the mean of the outer ring, facing `area_vector`, which must not be zero.
PlaneFrame plane_of(const Geometry& geometry, const Surface& surface, const Vec3d& area_vector);

}  // namespace skybake
