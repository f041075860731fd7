// The town's lamps as a lamp file.
#pragma once

#include <filesystem>
#include <span>

#include "city/town/town.h"

namespace skybake::io {

/// Writes the lamps as spots that shine straight down with a cone of 105°, fading from 60° on: lanterns. Throws
/// InputError when the place cannot be written.
void write_town_lamps(const std::filesystem::path& path, std::span<const StreetLamp> lamps);

}  // namespace skybake::io
