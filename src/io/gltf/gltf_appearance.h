// Materials, textures and images of a glTF asset.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"
#include "io/gltf/gltf_document.h"

namespace skybake::io {

/// A material as surfaces use it.
struct GltfMaterial {
    std::string name;
    std::optional<MaterialId> material;  // number in GltfAppearance
    std::optional<TextureId> texture;
    std::size_t uv_set = 0;  // TEXCOORD_n
    /// KHR_texture_transform: uv' = (m[0] u + m[1] v + m[2], m[3] u + m[4] v + m[5]).
    std::array<double, 6> uv_transform{1, 0, 0, 0, 1, 0};
};

struct GltfAppearance {
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<GltfMaterial> all;  // in the asset's order
};

/// Base colours and their images. A material that only emits (an unlit photo: black base colour, emissive image) takes
/// what it emits as its albedo. Images inside the asset are kept encoded; those that are files are looked for below its
/// folder. What does not fit is a finding, and surfaces go without it. `name` is what findings call the file.
GltfAppearance read_appearance(const GltfDocument& document, const std::string& name, FindingLog& findings);

}  // namespace skybake::io
