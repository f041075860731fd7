#include "city/town/plane_geometry.h"

#include <algorithm>
#include <limits>

namespace skybake::town {

void cut(ConvexPolygon& polygon, Vec2d on_line, Vec2d inward, int label) {
    const std::size_t n = polygon.size();
    ConvexPolygon kept;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d a = polygon.corners[i];
        const Vec2d b = polygon.corner(i + 1);
        const double da = glm::dot(a - on_line, inward);
        const double db = glm::dot(b - on_line, inward);
        if (da >= 0) {
            kept.corners.push_back(a);
            kept.labels.push_back(polygon.labels[i]);
        }
        if ((da >= 0) != (db >= 0)) {
            const Vec2d meet = a + (b - a) * (da / (da - db));
            if (da >= 0) {  // leaving: the new edge begins here
                kept.corners.push_back(meet);
                kept.labels.push_back(label);
            } else {  // coming back: the rest of this edge begins here
                kept.corners.push_back(meet);
                kept.labels.push_back(polygon.labels[i]);
            }
        }
    }
    polygon = std::move(kept);
}

double area(const std::vector<Vec2d>& ring) {
    double twice = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) twice += cross(ring[i], ring[(i + 1) % ring.size()]);
    return 0.5 * twice;
}

Vec2d middle(const std::vector<Vec2d>& ring) {
    Vec2d sum{0.0};
    for (const Vec2d& p : ring) sum += p;
    return sum / static_cast<double>(ring.size());
}

double angle_at(const ConvexPolygon& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    const Vec2d p = polygon.corner(i);
    const Vec2d a = glm::normalize(polygon.corner(i + n - 1) - p);
    const Vec2d b = glm::normalize(polygon.corner(i + 1) - p);
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

double distance_to(const ConvexPolygon& polygon, Vec2d p) {
    bool is_inside = true;
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2d a = polygon.corner(i);
        const Vec2d along = polygon.corner(i + 1) - a;
        if (cross(along, p - a) < 0) is_inside = false;
        const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(p - (a + along * t)));
    }
    return is_inside ? 0.0 : nearest;
}

double depth_inside(const std::vector<Vec2d>& ring, Vec2d p) {
    double depth = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d along = ring[(i + 1) % ring.size()] - ring[i];
        depth = std::min(depth, cross(along, p - ring[i]) / glm::length(along));
    }
    return depth;
}

Vec2d crossing(Vec2d p, Vec2d d, Vec2d q, Vec2d e) {
    return p + d * (cross(q - p, e) / cross(d, e));
}

}  // namespace skybake::town
