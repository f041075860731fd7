// CityJSON 1.0, 1.1 and 2.0, and CityJSON text sequences (CityJSONSeq), into a city.
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

/// Adds the objects of the file to `city`. Which of the formats it is, its content tells. Of each object the geometry
/// of one LoD is taken, raw as the file has it: repair.h comes after. A sequence is read line by line and needs memory
/// for its city only; a whole file is held as text, is never parsed as one tree, and takes about its size on disk
/// beside the city. Objects are read in parallel; the result hangs on the file alone. Throws InputError, with place and
/// remedy, when there is no such file, when it is another format, no JSON, or lacks what nothing can be read without;
/// Interrupted when `progress` wants to stop. What is wrong with single objects is a finding.
ReadFile read_cityjson(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                       FindingLog& findings, Progress& progress);

}  // namespace skybake::io
