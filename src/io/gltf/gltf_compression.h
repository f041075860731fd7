// Compressed meshes in glTF: Draco and meshopt, by their own libraries.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/gltf/gltf_document.h"

namespace skybake::io {

/// Bytes that a byte of meshopt data stands for at most: two bits say that sixteen bytes of a column repeat.
inline constexpr std::uint64_t kMostMeshoptExpansion = 64;

/// A mesh out of KHR_draco_mesh_compression.
struct DracoMesh {
    std::vector<std::uint32_t> indices;  // three a triangle
    std::size_t vertex_count = 0;
    /// By the attribute's unique id: its components and their values, vertex by vertex.
    struct Values {
        std::size_t components = 0;
        std::vector<double> values;
    };
    std::map<std::uint32_t, Values> attributes;
};

/// Throws GltfFault when the bytes are no Draco mesh.
DracoMesh decode_draco(Bytes bytes);

/// The bytes of a bufferView with EXT_meshopt_compression; `extension` is that member of the view. Throws GltfFault
/// when they are damaged, or too few for what they are said to hold.
std::vector<std::uint8_t> decode_meshopt(Bytes bytes, const GltfJson& extension);

}  // namespace skybake::io
