// Typed arrays of a glTF asset.
#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf/gltf_document.h"

namespace skybake::io {

/// The values of an accessor as glTF means them: normalised integers as -1…1 or 0…1, sparse ones filled in.
struct GltfArray {
    std::size_t components = 1;  // 1 SCALAR, 2 VEC2, 3 VEC3, 4 VEC4
    std::vector<double> values;  // components × count

    std::size_t count() const { return values.size() / components; }
};

/// Throws GltfFault when the accessor does not exist, or its bytes are not all there. At most 2²⁸ values.
GltfArray read_accessor(const GltfDocument& document, std::size_t index);

/// The same for vertex numbers. Throws GltfFault besides when one is not below `vertices`.
std::vector<std::uint32_t> read_indices(const GltfDocument& document, std::size_t index, std::size_t vertices);

}  // namespace skybake::io
