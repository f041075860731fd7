// Roof tiles, paving, stone, plants, water and metal.
#pragma once

#include "city/town/town.h"

namespace skybake::town {

NamedImage paint_tiles(std::uint64_t seed, int kind);  // 0 … kRoofTiles - 1: red, brown, old
NamedImage paint_cobbles(std::uint64_t seed);
NamedImage paint_slabs(std::uint64_t seed);
NamedImage paint_gravel(std::uint64_t seed);
NamedImage paint_grass(std::uint64_t seed);
NamedImage paint_water(std::uint64_t seed);
NamedImage paint_masonry(std::uint64_t seed);
NamedImage paint_copper(std::uint64_t seed);

}  // namespace skybake::town
