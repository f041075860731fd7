// Lamps from a file: our JSON, or the punctual lights of a glTF (docs/formats.md, "Lamps").
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/finding.h"
#include "light/lamp.h"

namespace skybake::io {

struct LampFile {
    std::vector<Lamp> lamps;
    std::vector<std::filesystem::path> files;  // all that were read: the file, and the profiles that it names
};

/// The lamps, with positions about `origin` (map coordinates). What the file is, its content tells. `gltf_origin`: map
/// coordinates of a glTF's (0, 0, 0); without it, those that its scene states, or (0, 0, 0). Throws InputError, with
/// file and lamp, for what is unreadable, unknown keys, values out of range, and two lamps of one id; a light that is
/// no lamp is left out with a finding.
LampFile read_lamps(const std::filesystem::path& path, const Vec3d& origin, const std::optional<Vec3d>& gltf_origin,
                    FindingLog& findings);

}  // namespace skybake::io
