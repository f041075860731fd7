// The city with its light painted on: a GLB that shows lit in viewers which know no lightmaps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace skybake::io {

/// Writes `target` from the city.glb of a bake: the same geometry, one material a lightmap page, `KHR_materials_unlit`,
/// whose base colour is that page's picture (PNG, one of `page_pngs` each) on TEXCOORD_0. Albedo textures, second
/// coordinates and `_CHART` are left out. Beside and renamed. Throws InputError when `city` is no GLB of a bake, or
/// `target` cannot be written.
void write_unlit_glb(const std::filesystem::path& city, const std::filesystem::path& target,
                     std::span<const std::vector<std::uint8_t>> page_pngs, const std::string& generator);

}  // namespace skybake::io
