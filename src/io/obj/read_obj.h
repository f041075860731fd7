// Wavefront OBJ with its material library into a city.
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

/// Adds the mesh to `city`, brought to z up and moved by `options.placement`. Each `o` (without any, each `g`) is an
/// object. Materials called as CityGML calls objects ("Building", "Road", "TerrainWall" …) give objects their types; a
/// nameless mesh that faces up nearly everywhere is terrain, other ones are generic objects, whose surfaces become
/// roofs, walls and undersides by their slope. Read line by line; memory for the city and the file's vertices. Throws
/// InputError when there is no such file, Interrupted when `progress` wants to stop. What is wrong with single lines is
/// a finding.
ReadFile read_obj(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
                  Progress& progress);

}  // namespace skybake::io
