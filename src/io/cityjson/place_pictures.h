// Pictures beside a city file that names them.
#pragma once

#include <filesystem>

#include "city/city_model.h"

namespace skybake::io {

/// Makes the pictures of the city's textures names below the folder of `city_file`: those that lie there already are
/// named as they lie, others, and those embedded in the city's own file, are copied to "STEM_textures" beside it.
/// Throws InputError when a picture cannot be read or written.
void place_pictures(CityModel& city, const std::filesystem::path& city_file);

}  // namespace skybake::io
