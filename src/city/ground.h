// Ground for cities whose files have none.
#pragma once

#include <cstdint>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake {

enum class GroundChoice : std::uint8_t {
    none,
    plane,  // level, at the middle foot of the buildings
    draped  // through the feet of all buildings
};

/// "none", "plane" or "draped".
const char* name_of(GroundChoice choice);

/// True when an object of the city is ground (terrain, roads, land use, water …) and has surfaces.
bool has_ground(const CityModel& city);

/// Adds the object "skybake-ground" of type terrain to a repaired city without ground: `margin_m` metres (0 to 10⁵)
/// wider than the buildings on all sides. The plane lies 1 cm below the middle foot, so that it coincides with no
/// underside. The draped surface is the Delaunay triangulation of points along the feet of the objects, two metres
/// apart (more on walls of over 128 m) and at most one a square metre, level outside them. Tells by finding what was
/// added (SB502), or that there is no ground and how to get one (SB501).
void add_ground(CityModel& city, GroundChoice choice, double margin_m, FindingLog& findings);

}  // namespace skybake
