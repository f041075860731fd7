// CityJSON 1.0, 1.1 and 2.0, and CityJSON text sequences (CityJSONSeq), into a city.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"

namespace skybake::io {

struct CityJsonOptions {
    /// The wanted LoD as "2.2", "1" …; without one the highest that each object offers.
    std::optional<std::string> lod;
};

struct CityJsonFile {
    std::uint64_t bytes = 0;
    std::uint64_t content_hash = 0;  // FNV-1a of the bytes: tells a changed input, guards against no forger
};

/// Adds the objects of the file to `city`. Which of the formats it is, its content tells. Of each object the geometry
/// of one LoD is taken, raw as the file has it: repair.h comes after. A sequence is read line by line and needs memory
/// for its city only; a whole file is held as text, is never parsed as one tree, and takes about its size on disk
/// beside the city. Objects are read in parallel; the result hangs on the file alone. Throws InputError, with place and
/// remedy, when there is no such file, when it is another format, no JSON, or lacks what nothing can be read without;
/// Interrupted when `progress` wants to stop. What is wrong with single objects is a finding.
CityJsonFile read_cityjson(const std::filesystem::path& path, const CityJsonOptions& options, CityModel& city,
                           FindingLog& findings, Progress& progress);

}  // namespace skybake::io
