// What real city files get wrong, made right where it can be, left out where not; each with a finding.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/box.h"
#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"

namespace skybake {

/// Leaves out surfaces of the objects from `first_object` on whose coordinates are no place on Earth (SB211).
void drop_bad_coordinates(CityModel& city, std::size_t first_object, FindingLog& findings);

/// Recognises writers that stored full coordinates and a transform besides, so that `translate` is in them twice
/// (SB201): the objects from `first_object` on lie outside the stated extent and would lie in it without `translate`.
/// Moves them there. An extent that the coordinates do not keep to in another way is SB215. Coordinates that are no
/// place at all do not count.
void repair_offset(CityModel& city, std::size_t first_object, const Vec3d& translate,
                   const std::optional<Box3d>& stated, const std::string& file, FindingLog& findings);

struct RepairSummary {
    std::uint64_t surfaces = 0;  // after repair
    std::uint64_t triangles = 0;
    std::uint64_t closed_shells = 0;  // of solids
    std::uint64_t open_shells = 0;
};

/// Repairs each object apart: drops coordinates that are no place (SB211), merges vertices up to 1 mm apart (SB210),
/// takes out spikes (SB205), surfaces without area (SB204) and surfaces there twice (SB202), splits rings that cross
/// themselves (SB203), turns surfaces and solids outward (SB207, SB208), tells of folds (SB206), gaps (SB209), edges of
/// many surfaces (SB213) and overlaps (SB214); then gives each surface of unknown type one by its object and its
/// normal. Objects far from all others are left out (SB216). n log n in the number of corners. Parallel over objects;
/// the result does not hang on the number of threads. Throws Interrupted when `progress` wants to stop.
RepairSummary repair(CityModel& city, FindingLog& findings, Progress& progress);

}  // namespace skybake
