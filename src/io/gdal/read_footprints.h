// Footprints with heights into a city.
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

/// Adds the polygons of a GeoPackage, GeoJSON or Shapefile as buildings, extruded. The height above ground is the
/// attribute `options.footprints.height_field`, else the first known one (height, building:height, measuredHeight …),
/// else storeys (building:levels …) times `storey_m`; without either the footprint is left out (SB123). OSM's
/// min_height and building:min_level raise the underside; roof:shape flat, gabled, hipped and pyramidal are built where
/// they fit (city/extrude), others are flat (SB124); roof:height or roof:levels tell how much of the height is roof.
/// Tags in `other_tags` count. Footprints with heights of their own stand at their lowest corner; others at 0, named in
/// ReadFile::above_ground. Throws InputError when the file cannot be read, Interrupted when `progress` wants to stop.
ReadFile read_footprints(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                         FindingLog& findings, Progress& progress);

}  // namespace skybake::io
