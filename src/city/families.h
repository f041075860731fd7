// Objects that belong together: a building and its parts, shown once.
#pragma once

#include <vector>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake {

/// Gives each object from `first_object` on an id of its own. One that repeats an earlier object with the same surfaces
/// is removed, one that differs is renamed to "ID#2"; both with finding SB104.
void make_ids_unique(CityModel& city, std::size_t first_object, FindingLog& findings);

/// For the objects from `first_object` on: parents that do not exist are forgotten (SB115), and where a building
/// (bridge, tunnel) shows the same body as its parts, the one of lower LoD is left out, at the same LoD the whole
/// (SB114). `has_only_flat` tells, for each of these objects, that its file offers nothing above LoD 0; where no member
/// of the family offers more, that is SB108.
void resolve_families(CityModel& city, std::size_t first_object, const std::vector<char>& has_only_flat,
                      FindingLog& findings);

}  // namespace skybake
