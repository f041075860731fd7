// The nodes of a glTF asset: which meshes stand where.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "base/finding.h"
#include "io/gltf/gltf_document.h"

namespace skybake::io {

/// A mesh in its place.
struct GltfInstance {
    std::size_t mesh = 0;
    std::string name;          // of the node, with the number of the instance where it has several
    glm::dmat4 to_asset{1.0};  // from the mesh's coordinates to the asset's, both y up
};

/// All meshes of the default scene (of all root nodes where no scene is named), nodes in depth-first order,
/// EXT_mesh_gpu_instancing resolved. A node that is its own ancestor, hangs on two parents, or is not built as glTF
/// says is left out (SB101). At most 10⁶ instances.
std::vector<GltfInstance> read_scene(const GltfDocument& document, const std::string& name, FindingLog& findings);

}  // namespace skybake::io
