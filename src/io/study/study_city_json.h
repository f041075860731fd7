// A study's results within the city: CityJSON whose buildings and surfaces have them as attributes.
#pragma once

#include <filesystem>

#include "city/city_model.h"
#include "study/roll_up.h"
#include "study/study.h"

namespace skybake::io {

/// city.city.json: the city with, on each studied building (by all its receivers) and on each studied façade, roof and
/// window, "skybake_COLUMN" (mean by area), "skybake_COLUMN_least" and "…_greatest", and for each criterion that is
/// asked of it "skybake_CRITERION" (the verdict) and "…_area_pass" (share of its area); on buildings "skybake_verdict"
/// and "skybake_rule", on surfaces "skybake_id" as in groups.csv. Surfaces that had no semantics get those that the
/// study took them for. `city` is in the system that it names; its pictures are left out. Throws InputError when the
/// place cannot be written.
void write_study_city(CityModel city, const std::filesystem::path& path, const Rule& rule, const Study& study,
                      const std::vector<Group>& groups);

}  // namespace skybake::io
