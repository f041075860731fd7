// glTF assets of a few triangles for tests.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace skybake {

using Json = nlohmann::json;

/// Collects arrays in one buffer, and the JSON that names them.
struct GltfMaker {
    Json json = {{"asset", {{"version", "2.0"}}},
                 {"bufferViews", Json::array()},
                 {"accessors", Json::array()},
                 {"meshes", Json::array()},
                 {"nodes", Json::array()}};
    std::string bytes;

    template <typename T>
    int view(const std::vector<T>& values) {
        while (bytes.size() % 4 != 0) bytes += '\0';
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }
    int accessor(int view, int component_type, const std::string& type, std::size_t count) {
        json["accessors"].push_back(
            {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    int floats(const std::vector<float>& values, const std::string& type) {
        const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
        return accessor(view(values), 5126, type, values.size() / components);
    }
    int indices(const std::vector<std::uint16_t>& values) {
        return accessor(view(values), 5123, "SCALAR", values.size());
    }
    /// A mesh of one primitive.
    int mesh(Json primitive) {
        json["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
        return static_cast<int>(json["meshes"].size()) - 1;
    }

    static std::string little_endian(std::uint32_t value) {
        std::string text(4, '\0');
        std::memcpy(text.data(), &value, 4);
        return text;
    }
    std::string glb() {
        json["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
        std::string text = json.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string binary = bytes;
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const auto size = static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size());
        return "glTF" + little_endian(2) + little_endian(size) +
               little_endian(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
               little_endian(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
    }
    /// As JSON with its buffer as data.
    std::string gltf() {
        static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 3; ++k)
                bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
            for (std::size_t k = 0; k < 4; ++k)
                text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63u];
        }
        json["buffers"] =
            Json::array({{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + text}}});
        return json.dump();
    }
};

/// A unit cube's corners in a frame with y up, and its outward triangles.
inline const std::vector<float> kCubeCorners = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
inline const std::vector<std::uint16_t> kCubeTriangles = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                                          1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};

inline GltfMaker cube_asset() {
    GltfMaker maker;
    const int positions = maker.floats(kCubeCorners, "VEC3");
    maker.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", maker.indices(kCubeTriangles)}});
    maker.json["nodes"].push_back({{"mesh", 0}, {"name", "cube"}});
    return maker;
}

}  // namespace skybake
