// Rasters of heights into a city.
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

/// Adds the first band of a GeoTIFF or ESRI ASCII grid as one object of type terrain: triangles through the middles of
/// its cells that keep every height within `options.raster.max_error_m` (city/height_mesh; SB503 tells their number).
/// In a raster of the surface with all that stands on it, triangles steeper than 60° are walls: a house's wall is a
/// slope of one cell. Cells without a value stay open. Throws InputError when it is no such raster, turned, or longer
/// than kLongestGrid; Interrupted when `progress` wants to stop.
ReadFile read_raster(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                     FindingLog& findings, Progress& progress);

}  // namespace skybake::io
