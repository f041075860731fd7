// Orthophotos: pictures from above that lie on the ground.
#pragma once

#include <filesystem>
#include <string>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::io {

/// Puts the picture (GeoTIFF, or PNG or JPEG with a world file; 8 bits, grey or RGB) on all ground of the city that has
/// no texture, faces up and lies under it at least in part; beyond the picture, and where it has no data, that ground
/// has the default albedo of terrain. `city_crs` is the system of the city's coordinates as PROJ reads it; each corner
/// is brought into the picture's. Empty, or where the picture names none, both are taken as one. The picture is cut
/// into textures of at most 4096 pixels a side, coarser where a single surface needs more. Finding SB505 tells what was
/// covered. Throws InputError when the picture cannot be read, has no place, or covers nothing.
void drape_orthophoto(const std::filesystem::path& path, const std::string& city_crs, CityModel& city,
                      FindingLog& findings);

}  // namespace skybake::io
