// Where the town's lamps hang and stand.
#pragma once

#include <vector>

#include "city/town/layout.h"
#include "city/town/town.h"

namespace skybake::town {

/// Along the middle of every street between houses, over the quays, about squares, and on the bridges; map coordinates.
std::vector<StreetLamp> place_lamps(std::uint64_t seed, const Layout& layout, const Relief& relief);

}  // namespace skybake::town
