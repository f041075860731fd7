// Houses as closed shells: row houses, corner houses with two wings, and free-standing blocks under a hipped roof.
#pragma once

#include <cstdint>

#include "city/town/layout.h"
#include "city/town/object_builder.h"
#include "city/town/roof.h"

namespace skybake::town {

/// The house on a lot of the cell.
CityObject build_house(std::uint64_t seed, const Cell& cell, const Lot& lot, const Relief& relief);

/// A rectangular house standing free: walls of `height` above `floor` (absolute), feet at `base`, hipped roof with
/// eaves all around.
struct FreeHouse {
    Vec2d origin{0.0};  // corner of the walls
    Vec2d u{1.0, 0.0};  // unit, along the length
    double length = 20.0;
    double width = 10.0;  // to the left of u; at most the length
    double base = 0.0;
    double floor = 0.0;
    double height = 10.0;
    double slope = 0.9;
    double overhang = 0.4;
    int facade = 0;
    int tiles = 0;
};
void add_free_house(ObjectBuilder& builder, const FreeHouse& house);

/// Lowest ground under a footprint: its corners and the middles of its sides.
double lowest_ground(const Relief& relief, const std::vector<Vec2d>& ring);

inline constexpr double kFoundation = 0.6;  // how far the walls go on below the lowest ground at their feet

}  // namespace skybake::town
