// House fronts, plaster, and the fronts of the landmarks.
#pragma once

#include "city/town/town.h"

namespace skybake::town {

/// Three bays and five storeys of colour `colour` (0 … kFacadeColours - 1), plain plaster above: see styles.h.
NamedImage paint_facade(std::uint64_t seed, int colour);
/// The same plaster without windows.
NamedImage paint_plaster(std::uint64_t seed, int colour);
/// One bay of a church: a tall round-arched window between pilasters.
NamedImage paint_church(std::uint64_t seed);
/// The clock tower's upper wall with its dial.
NamedImage paint_clock(std::uint64_t seed);
/// Two bays and two storeys of a glazed high-rise.
NamedImage paint_glass(std::uint64_t seed);

}  // namespace skybake::town
