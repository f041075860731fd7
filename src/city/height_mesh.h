// A raster of heights as triangles, few where it is level.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"
#include "city/city_model.h"

namespace skybake {

/// Heights at the crossings of a grid, row 0 in the north: height (column, row) is heights[row * columns + column] at
/// north_west + (column * step.x, -row * step.y). NaN is no height.
struct HeightGrid {
    std::size_t columns = 0;
    std::size_t rows = 0;
    Vec2d north_west{0.0};
    Vec2d step{1.0};  // positive, map units
    std::vector<float> heights;
};

/// The longer side that height_mesh takes, in heights.
inline constexpr std::size_t kLongestGrid = 16385;

/// A right-triangulated irregular network through some of the heights: no height of the grid lies more than
/// `max_error_m` above or below it, measured upright; 0 keeps every height that its neighbours do not give away.
/// Triangles face up, meet edge to edge, and none has a corner without height; between heights and gaps they are as
/// small as the grid. A loose shell of surfaces of type terrain. Both sides at least 2 and at most kLongestGrid. n log
/// n in the heights of the square that holds the grid; 8 bytes for each of them.
Geometry height_mesh(const HeightGrid& grid, double max_error_m);

}  // namespace skybake
