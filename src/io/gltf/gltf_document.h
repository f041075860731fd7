// The container of a glTF asset: its JSON and its bytes, wherever they stand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace skybake::io {

/// A part of an asset that is not built as glTF says: that part is left out, and told. Thrown and caught in this
/// folder.
class GltfFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

using GltfJson = nlohmann::json;
using Bytes = std::span<const std::uint8_t>;

/// The member `key` of an object; null where there is none.
const GltfJson& member(const GltfJson& object, std::string_view key);
/// The member `key` as a whole number from 0 on; none where there is no such member. Throws GltfFault for anything
/// else.
std::optional<std::size_t> index_at(const GltfJson& object, std::string_view key);
/// The same with a value that holds where the member is absent.
std::size_t index_or(const GltfJson& object, std::string_view key, std::size_t absent);
/// Entry `index` of the array `key` of the asset. Throws GltfFault where there is none.
const GltfJson& entry(const GltfJson& asset, std::string_view key, std::size_t index);
/// `count` finite numbers of the array `key`; none where there is no such member. Throws GltfFault for anything else.
std::optional<std::vector<double>> numbers_at(const GltfJson& object, std::string_view key, std::size_t count);
/// The string `key`, or nothing.
std::string text_at(const GltfJson& object, std::string_view key);

/// A glTF 2.0 asset, out of .gltf, .glb or .b3dm.
class GltfDocument {
  public:
    /// Reads the file and the buffers that it names, which lie below its folder. Throws InputError when it is no glTF
    /// 2.0, is cut short, or requires an extension that is not known here.
    explicit GltfDocument(const std::filesystem::path& path);

    const GltfJson& json() const { return json_; }
    const std::filesystem::path& folder() const { return folder_; }
    /// The bytes of a bufferView, decompressed. Throws GltfFault when they are not all there.
    Bytes view(std::size_t index) const;
    /// Where the asset's zero lies in the frame with z up (RTC_CENTER of 3D Tiles, CESIUM_RTC); zero without.
    const Vec3d& center() const { return center_; }
    /// Of the file itself, for its hash.
    Bytes file() const { return file_; }
    /// Of the file and its buffers together.
    std::uint64_t byte_count() const { return byte_count_; }

  private:
    void read_container(const std::string& name);
    void read_buffers(const std::string& name);
    std::vector<std::uint8_t> read_buffer(const std::string& uri, const std::string& name) const;
    void check_extensions(const std::string& name) const;

    std::filesystem::path folder_;
    std::vector<std::uint8_t> file_;
    std::optional<Bytes> binary_;  // the GLB's own chunk
    GltfJson json_;
    std::map<std::string, std::vector<std::uint8_t>> buffer_files_;  // by address, each once
    std::vector<Bytes> buffers_;                                     // empty ones stand for the binary chunk
    std::uint64_t byte_count_ = 0;
    mutable std::map<std::size_t, std::vector<std::uint8_t>> decompressed_;
    mutable std::uint64_t decompressed_bytes_ = 0;
    Vec3d center_{0.0};
};

/// The bytes of "data:…;base64,…". Throws GltfFault when they are no base64.
std::vector<std::uint8_t> decode_data_uri(std::string_view uri);

/// A name in a URI with its %XX resolved.
std::string decode_percent(std::string_view uri);

}  // namespace skybake::io
