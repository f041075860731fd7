// The lit city read back from the GLB that gltf/glb.h writes.
#pragma once

#include <filesystem>
#include <span>

#include "render/picture_scene.h"

namespace skybake::io {

/// Triangles, texels, materials and textures of a bake's city.glb, in the world frame (z up). `page_sizes` are the
/// manifest's, in texels. Of glTF it knows what write_glb() uses: one buffer, indexed triangles, images inside the
/// file, nodes without a transformation. Nothing is taken on trust: every offset, index and coordinate is checked.
/// Textures are decoded in full, four bytes a pixel in all levels. Throws InputError that names the file and the fault.
PictureScene read_glb(const std::filesystem::path& path, std::span<const Vec2i> page_sizes);

}  // namespace skybake::io
