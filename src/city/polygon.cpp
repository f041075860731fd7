#include "city/polygon.h"

#include <cmath>

namespace skybake {

Vec3d ring_area_vector(const Geometry& geometry, std::uint32_t ring) {
    const auto corners = ring_of(geometry, ring);
    Vec3d sum(0.0);
    if (corners.size() < 3) return sum;
    const Vec3d origin =
        geometry.vertices[corners[0]];  // near the ring, so that map coordinates of 10⁶ m cost no digits
    Vec3d previous = geometry.vertices[corners[1]] - origin;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const Vec3d next = geometry.vertices[corners[i]] - origin;
        sum += glm::cross(previous, next);
        previous = next;
    }
    return 0.5 * sum;
}

Vec3d surface_area_vector(const Geometry& geometry, const Surface& surface) {
    if (surface.ring_begin == surface.ring_end) return Vec3d(0.0);
    const Vec3d outer = ring_area_vector(geometry, surface.ring_begin);
    const double area = glm::length(outer);
    if (!(area > 0.0)) return Vec3d(0.0);
    const Vec3d normal = outer / area;
    double holes = 0.0;
    for (std::uint32_t ring = surface.ring_begin + 1; ring < surface.ring_end; ++ring) {
        holes += std::abs(glm::dot(ring_area_vector(geometry, ring), normal));
    }
    return normal * (area - holes);
}

PlaneFrame plane_of(const Geometry& geometry, const Surface& surface, const Vec3d& area_vector) {
    PlaneFrame frame;
    const auto corners = ring_of(geometry, surface.ring_begin);
    const Vec3d first = geometry.vertices[corners[0]];
    Vec3d sum(0.0);
    for (const std::uint32_t corner : corners) sum += geometry.vertices[corner] - first;
    frame.origin = first + sum / static_cast<double>(corners.size());
    frame.normal = glm::normalize(area_vector);
    // The axis furthest from the normal keeps the cross product long.
    const Vec3d a = glm::abs(frame.normal);
    const Vec3d axis = a.x <= a.y && a.x <= a.z ? Vec3d(1, 0, 0) : a.y <= a.z ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
    frame.u = glm::normalize(glm::cross(axis, frame.normal));
    frame.v = glm::cross(frame.normal, frame.u);
    return frame;
}

}  // namespace skybake
