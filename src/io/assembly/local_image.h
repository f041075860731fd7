// Images that a city file names: what their names, colours and wrap modes mean, the same for every format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::io {

/// The file that a city file calls `uri`, below `folder`, whether it is there or not; none when the name leaves the
/// folder, by itself or by links. Backslashes count as slashes.
std::optional<std::filesystem::path> path_below(const std::filesystem::path& folder, std::string_view uri);

/// Sets path and is_missing of a texture whose `uri` is set. The image is looked for below `folder` only, and not
/// opened: remote addresses (SB401), paths that leave the folder (SB402) and absent files (SB401) leave it missing.
void find_image(Texture& texture, const std::filesystem::path& folder, const std::string& where, FindingLog& findings);

/// Colours of city files are display colours, thus sRGB-encoded; albedo is linear. Clamped to [0, 1].
Rgb linear_from_display(double red, double green, double blue);

}  // namespace skybake::io
