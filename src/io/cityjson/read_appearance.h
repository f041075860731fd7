// Materials, textures and texture vertices of a CityJSON file or feature.
#pragma once

#include <simdjson.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::io {

struct CityJsonAppearance {
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Vec2f> uvs;
    std::string default_material_theme;  // empty when none is named
    std::string default_texture_theme;
};

/// Reads an "appearance" object. Images are looked for below `folder` only, and not opened. `where` names file and
/// place.
CityJsonAppearance read_appearance(simdjson::dom::element appearance, const std::filesystem::path& folder,
                                   const std::string& where, FindingLog& findings);

}  // namespace skybake::io
