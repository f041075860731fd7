// Polygons with holes into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "city/city_model.h"

namespace skybake {

/// Triangles of one surface as triples of *corner* indices (indices into Geometry::corners, so that texture coordinates
/// follow), counter-clockwise from the side from which the outer ring runs counter-clockwise; the holes may run either
/// way.
///
/// No vertex is added, so shells stay watertight. The triangles are found in the plane of the outer ring's area vector
/// (Newell), so a polygon that is not quite flat is folded along the triangles' edges; their area in that plane is the
/// polygon's to 1 part in 10⁹. Empty when there is no such set: fewer than three distinct corners, no area, a ring that
/// crosses itself or another. Star-shaped rings without holes take a direct way; the rest is GEOS's constrained
/// Delaunay triangulation. Thread-safe; the same triangles for the same input.
std::vector<std::array<std::uint32_t, 3>> triangulate(const Geometry& geometry, const Surface& surface);

}  // namespace skybake
