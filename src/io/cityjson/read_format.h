// Which format a file is that is no CityJSON, to refuse it by name.
#pragma once

#include <string>
#include <string_view>

namespace skybake::io {

/// What the first bytes of a file look like: "CityGML", "Wavefront OBJ", "3D Tiles (b3dm)" …; empty when it may be
/// JSON.
std::string foreign_format(std::string_view head);

}  // namespace skybake::io
