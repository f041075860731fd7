// Material libraries of Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::io {

/// A material of a library: numbers in ObjMaterials.
struct ObjMaterial {
    MaterialId material;
    std::optional<TextureId> texture;
};

struct ObjMaterials {
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::map<std::string, ObjMaterial, std::less<>> by_name;
};

/// Adds the materials of the library `uri`, which is looked for below `folder` only: diffuse colour (Kd), its image
/// (map_Kd) and opacity (d, Tr). A library that is absent or outside the folder is a finding.
void read_mtl(const std::string& uri, const std::filesystem::path& folder, const std::string& where,
              ObjMaterials& materials, FindingLog& findings);

}  // namespace skybake::io
