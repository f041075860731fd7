// Lamps from a JSON file (docs/formats.md, "Lamps").
#pragma once

#include <filesystem>
#include <vector>

#include "light/lamp.h"

namespace skybake::io {

/// The lamps, with positions about `origin` (map coordinates). Throws InputError, with file and lamp, for broken JSON,
/// unknown or missing keys, values out of range, and two lamps of one id.
std::vector<Lamp> read_lamps(const std::filesystem::path& path, const Vec3d& origin);

}  // namespace skybake::io
