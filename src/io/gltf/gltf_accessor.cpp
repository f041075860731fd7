// Based on: glTF 2.0 specification, section 3.6.2 (accessors, sparse accessors, normalised integers).
#include "io/gltf/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace skybake::io {
namespace {

constexpr std::size_t kMostValues = std::size_t{1} << 28;

std::size_t size_of_component(std::size_t type) {
    switch (type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            throw GltfFault(fmt::format("component type {} is unknown", type));
    }
}

template <typename T>
double number_as(const std::uint8_t* at, double divisor) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    const double number = static_cast<double>(value);
    return divisor == 0.0 ? number : std::max(number / divisor, -1.0);
}

double component(const std::uint8_t* at, std::size_t type, bool is_normalized) {
    switch (type) {
        case 5120:
            return number_as<std::int8_t>(at, is_normalized ? 127.0 : 0.0);
        case 5121:
            return number_as<std::uint8_t>(at, is_normalized ? 255.0 : 0.0);
        case 5122:
            return number_as<std::int16_t>(at, is_normalized ? 32767.0 : 0.0);
        case 5123:
            return number_as<std::uint16_t>(at, is_normalized ? 65535.0 : 0.0);
        case 5125:
            return number_as<std::uint32_t>(at, 0.0);
        default:
            return number_as<float>(at, 0.0);
    }
}

std::size_t components_of(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4") return 4;
    throw GltfFault(fmt::format("accessor of type '{}' holds no vectors", type.substr(0, 40)));
}

/// Where `count` elements of a view stand.
struct Elements {
    Bytes bytes;
    std::size_t stride = 0;
};

Elements elements(const GltfDocument& document, const GltfJson& place, std::size_t view, std::size_t count,
                  std::size_t element_bytes) {
    const Bytes bytes = document.view(view);
    const std::size_t offset = index_or(place, "byteOffset", 0);
    const std::size_t stride = index_or(entry(document.json(), "bufferViews", view), "byteStride", element_bytes);
    if (stride < element_bytes || stride > 252 + element_bytes) throw GltfFault("a byteStride cannot be");
    // Counts are below 2²⁸ and strides below 2⁹: no overflow.
    if (count > 0 && (offset > bytes.size() || (count - 1) * stride + element_bytes > bytes.size() - offset))
        throw GltfFault(fmt::format("an accessor reaches beyond the end of bufferViews[{}]", view));
    return {bytes.subspan(std::min(offset, bytes.size())), stride};
}

void fill_sparse(const GltfDocument& document, const GltfJson& sparse, std::size_t type, bool is_normalized,
                 GltfArray& array) {
    const std::size_t count = index_or(sparse, "count", 0);
    if (count > array.count()) throw GltfFault("a sparse accessor replaces more than there is");
    const GltfJson& indices = member(sparse, "indices");
    const GltfJson& values = member(sparse, "values");
    const std::size_t index_type = index_or(indices, "componentType", 0);
    const std::size_t index_bytes = size_of_component(index_type);
    const std::size_t value_bytes = size_of_component(type) * array.components;
    const Elements where =
        elements(document, indices, index_or(indices, "bufferView", ~std::size_t{0}), count, index_bytes);
    const Elements what =
        elements(document, values, index_or(values, "bufferView", ~std::size_t{0}), count, value_bytes);
    for (std::size_t i = 0; i < count; ++i) {
        const double index = component(where.bytes.data() + i * where.stride, index_type, false);
        if (index < 0.0 || index >= static_cast<double>(array.count()))
            throw GltfFault("a sparse accessor replaces what is not there");
        for (std::size_t c = 0; c < array.components; ++c) {
            array.values[static_cast<std::size_t>(index) * array.components + c] =
                component(what.bytes.data() + i * what.stride + c * size_of_component(type), type, is_normalized);
        }
    }
}

}  // namespace

GltfArray read_accessor(const GltfDocument& document, std::size_t index) {
    const GltfJson& accessor = entry(document.json(), "accessors", index);
    GltfArray array;
    array.components = components_of(text_at(accessor, "type"));
    const std::size_t count = index_or(accessor, "count", 0), type = index_or(accessor, "componentType", 0);
    const std::size_t bytes = size_of_component(type);
    const bool is_normalized = member(accessor, "normalized") == true;
    if (count > kMostValues / array.components) throw GltfFault(fmt::format("{} elements are too many", count));
    if (const auto view = index_at(accessor, "bufferView")) {
        const Elements from = elements(document, accessor, *view, count, bytes * array.components);
        array.values.reserve(count * array.components);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < array.components; ++c)
                array.values.push_back(component(from.bytes.data() + i * from.stride + c * bytes, type, is_normalized));
        }
    } else {
        // Zeros until sparse values come; as many as the file has bytes are enough for all honest ones.
        if (count > document.file().size()) throw GltfFault(fmt::format("{} zeros are too many", count));
        array.values.assign(count * array.components, 0.0);
    }
    if (const GltfJson& sparse = member(accessor, "sparse"); !sparse.is_null())
        fill_sparse(document, sparse, type, is_normalized, array);
    return array;
}

std::vector<std::uint32_t> read_indices(const GltfDocument& document, std::size_t index, std::size_t vertices) {
    const GltfArray array = read_accessor(document, index);
    if (array.components != 1) throw GltfFault("vertex numbers are no scalars");
    std::vector<std::uint32_t> indices;
    indices.reserve(array.values.size());
    for (const double value : array.values) {
        if (!(value >= 0.0) || value >= static_cast<double>(vertices))
            throw GltfFault(fmt::format("vertex {:.0f} of {} does not exist", value, vertices));
        indices.push_back(static_cast<std::uint32_t>(value));
    }
    return indices;
}

}  // namespace skybake::io
