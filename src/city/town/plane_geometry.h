// Points, lines and convex polygons in plan.
#pragma once

#include <cmath>
#include <vector>

#include "base/vec.h"

namespace skybake::town {

inline double cross(Vec2d a, Vec2d b) {
    return a.x * b.y - a.y * b.x;
}
/// The vector turned left by 90°.
inline Vec2d left_of(Vec2d a) {
    return {-a.y, a.x};
}

/// A convex polygon, counter-clockwise. Edge i runs from corner i to corner i + 1 and carries a label through every
/// cut.
struct ConvexPolygon {
    std::vector<Vec2d> corners;
    std::vector<int> labels;

    std::size_t size() const { return corners.size(); }
    Vec2d corner(std::size_t i) const { return corners[i % corners.size()]; }
};

/// Keeps the part where dot(p - on_line, inward) >= 0; the new edge gets `label`.
void cut(ConvexPolygon& polygon, Vec2d on_line, Vec2d inward, int label);
double area(const std::vector<Vec2d>& ring);
/// The mean of the corners; inside a convex polygon.
Vec2d middle(const std::vector<Vec2d>& ring);
/// Interior angle at corner i, radians.
double angle_at(const ConvexPolygon& polygon, std::size_t i);
/// Distance of a point from a convex polygon; 0 inside.
double distance_to(const ConvexPolygon& polygon, Vec2d p);
/// Largest d such that the point is at least d inside all edges; negative outside.
double depth_inside(const std::vector<Vec2d>& convex_ring, Vec2d p);
/// Where the lines p + s·d and q + t·e cross; they must not be parallel.
Vec2d crossing(Vec2d p, Vec2d d, Vec2d q, Vec2d e);

}  // namespace skybake::town
