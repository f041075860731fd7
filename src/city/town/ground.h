// Ground that nobody covers twice: the streets, courts and lawns of each cell, and the river's corridor.
#pragma once

#include <vector>

#include "city/town/layout.h"
#include "city/town/object_builder.h"

namespace skybake::town {

/// Streets and inner ground of a cell, as objects of their own kinds. Cells meet along their edges in the same points.
std::vector<CityObject> build_ground(const Layout& layout, const Cell& cell, const Relief& relief);

/// Bed, banks and water of one segment of the river.
std::vector<CityObject> build_river(const Layout& layout, int segment, const Relief& relief);

}  // namespace skybake::town
