// CityGML 1.0, 2.0 and 3.0 (and 0.4) into a city.
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

/// Adds the objects of the file to `city`. Of each object the geometry of one LoD is taken, raw as the file has it:
/// repair.h comes after. The file is scanned twice, for its appearances and references and then object by object (once
/// or more between, when objects refer to shapes in others); memory is needed for the city, for the coordinates of its
/// textures, and for some 16 MB of objects or the largest one. Objects are read in parallel; the result hangs on the
/// file alone. Nothing but the file is opened: no schema, no entity, no remote reference. Throws InputError, with line
/// and remedy, when there is no such file, when it is no well-formed XML or no CityGML; Interrupted when `progress`
/// wants to stop. What is wrong with single objects is a finding.
ReadFile read_citygml(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                      FindingLog& findings, Progress& progress);

}  // namespace skybake::io
