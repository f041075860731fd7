// Areas on the ground for studies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/receivers.h"

namespace skybake::io {

/// The polygons of a GeoJSON, GeoPackage or Shapefile, in the coordinates of `crs`
/// (whatever PROJ understands). The id is the attribute "id", or "name", or the feature's number. A file that names a
/// reference system is transformed from it; one that names none is taken to be in `crs` (GeoJSON without "crs" is in
/// WGS 84, RFC 7946, unless its numbers cannot be degrees). Throws InputError for a file that cannot be read, has no
/// polygon, or lies wholly outside `lo`…`hi`, naming both extents.
std::vector<AreaPolygon> read_polygons(const std::filesystem::path& path, const std::string& crs, const Vec2d& lo,
                                       const Vec2d& hi);

}  // namespace skybake::io
