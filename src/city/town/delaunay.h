// Triangulates points for the hill's relief.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"

namespace skybake::town {

/// Counter-clockwise Delaunay triangles of the points. Quadratic in their number: for a few hundred.
/// Based on: A. Bowyer, "Computing Dirichlet tessellations", and D. F. Watson, "Computing the n-dimensional Delaunay
/// tessellation", The Computer Journal 24 (2), 1981.
std::vector<std::array<std::size_t, 3>> delaunay(const std::vector<Vec2d>& points);

}  // namespace skybake::town
