// Which objects of the files make the city: those of a rectangle, without some, each once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/finding.h"
#include "city/city_model.h"

namespace skybake {

/// Leaves out objects from `first_object` on that an earlier one shows already under another id (SB217): of the same
/// type, with boxes that differ by 5 cm at most and areas that differ by 1 % at most. Ground counts not. n log n.
void drop_duplicates(CityModel& city, std::size_t first_object, FindingLog& findings);

/// Keeps the families whose box has its middle in `box` (map coordinates as in the files), and of ground the surfaces
/// with their middle in it; tells how many objects went (SB121).
void keep_within(CityModel& city, const Box2d& box, FindingLog& findings);

/// Takes out the objects of these ids and all below them (SB121). Returns the first id that no object has, having done
/// nothing; else none.
std::optional<std::string> exclude(CityModel& city, const std::vector<std::string>& ids, FindingLog& findings);

}  // namespace skybake
