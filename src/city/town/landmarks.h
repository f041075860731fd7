// What makes the town this town: church, castle, clock tower, bridges, the square's column, and the planned high-rise.
#pragma once

#include <vector>

#include "city/town/layout.h"
#include "city/town/object_builder.h"

namespace skybake::town {

/// A church with a tower on the cell's block; the object and its parts, the building first.
std::vector<CityObject> build_church(std::uint64_t seed, const Cell& cell, const Relief& relief, bool is_first);
/// The castle, a building with parts, and the clock tower, a building. How many buildings they count.
inline constexpr std::uint32_t kHillBuildings = 2;
std::vector<CityObject> build_hilltop(std::uint64_t seed, const Relief& relief);
/// A bridge across one segment of the river.
CityObject build_bridge(const Layout& layout, int segment, const Relief& relief);
/// A point of its deck, town coordinates: `across` metres east of the river's middle, `along` upstream of the bridge's.
Vec3d on_bridge(const Layout& layout, int segment, const Relief& relief, double across, double along);
bool has_bridge(const Layout& layout, int segment);
CityObject build_column(const Cell& square, const Relief& relief);
/// 24 × 24 m, 70 m high, id "planned-tower".
CityObject build_planned_tower(const Cell& site, const Relief& relief);

}  // namespace skybake::town
