// Based on: KHR_draco_mesh_compression and EXT_meshopt_compression, https://github.com/KhronosGroup/glTF,
// extensions/2.0.
#include "io/gltf/gltf_compression.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <array>
#include <memory>

namespace skybake::io {
namespace {}  // namespace

DracoMesh decode_draco(Bytes bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) throw GltfFault(fmt::format("Draco data is damaged ({})", decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    DracoMesh result;
    result.vertex_count = mesh->num_points();
    result.indices.reserve(std::size_t{3} * mesh->num_faces());
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) result.indices.push_back(mesh->face(f)[k].value());
    }
    for (std::int32_t a = 0; a < mesh->num_attributes(); ++a) {
        const draco::PointAttribute* attribute = mesh->attribute(a);
        DracoMesh::Values& values = result.attributes[attribute->unique_id()];
        values.components = static_cast<std::size_t>(attribute->num_components());
        if (values.components > 4) throw GltfFault("a Draco attribute has more than four components");
        std::array<float, 4> value{};
        for (draco::PointIndex p(0); p < mesh->num_points(); ++p) {
            if (!attribute->ConvertValue<float>(attribute->mapped_index(p), static_cast<std::int8_t>(values.components),
                                                value.data()))
                throw GltfFault("a Draco attribute is no list of numbers");
            values.values.insert(values.values.end(), value.begin(),
                                 value.begin() + static_cast<std::ptrdiff_t>(values.components));
        }
    }
    return result;
}

std::vector<std::uint8_t> decode_meshopt(Bytes bytes, const GltfJson& extension) {
    const std::size_t count = index_or(extension, "count", 0), stride = index_or(extension, "byteStride", 0);
    const std::string mode = text_at(extension, "mode"), filter = text_at(extension, "filter");
    const bool is_attributes = mode == "ATTRIBUTES";
    const bool is_stride_good =
        is_attributes ? stride > 0 && stride % 4 == 0 && stride <= 256 : stride == 2 || stride == 4;
    if (!is_stride_good || count > kMostMeshoptExpansion * bytes.size() / stride)
        throw GltfFault("count or byteStride of EXT_meshopt_compression cannot be");
    if (mode == "TRIANGLES" && count % 3 != 0) throw GltfFault("a compressed triangle list has no whole triangles");
    std::vector<std::uint8_t> out(count * stride);
    int fault = 0;
    if (is_attributes) {
        fault = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
    } else if (mode == "TRIANGLES") {
        fault = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
    } else if (mode == "INDICES") {
        fault = meshopt_decodeIndexSequence(out.data(), count, stride, bytes.data(), bytes.size());
    } else {
        throw GltfFault(fmt::format("mode '{}' of EXT_meshopt_compression is unknown", mode.substr(0, 40)));
    }
    if (fault != 0) throw GltfFault("meshopt data is damaged");
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
        meshopt_decodeFilterOct(out.data(), count, stride);
    } else if (filter == "QUATERNION" && stride == 8) {
        meshopt_decodeFilterQuat(out.data(), count, stride);
    } else if (filter == "EXPONENTIAL" && is_attributes) {
        meshopt_decodeFilterExp(out.data(), count, stride);
    } else if (!filter.empty() && filter != "NONE") {
        throw GltfFault(fmt::format("filter '{}' of EXT_meshopt_compression does not fit", filter.substr(0, 40)));
    }
    return out;
}

}  // namespace skybake::io
