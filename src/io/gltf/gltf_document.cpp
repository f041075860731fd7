// Based on: glTF 2.0 specification, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html, sections 3.6 (buffers)
// and 4 (GLB); 3D Tiles 1.1, OGC 22-025r4, "Batched 3D Model"; CESIUM_RTC.
#include "io/gltf/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "io/assembly/file_format.h"
#include "io/assembly/local_image.h"
#include "io/file/replace_file.h"
#include "io/gltf/gltf_compression.h"

namespace skybake::io {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr std::size_t kGlbHeader = 12, kChunkHeader = 8, kB3dmHeader = 28;

/// Extensions that may be required: those that are read, and those that say nothing of shape and colour.
constexpr std::array kKnownExtensions{
    std::string_view{"KHR_draco_mesh_compression"},
    std::string_view{"EXT_meshopt_compression"},
    std::string_view{"KHR_mesh_quantization"},
    std::string_view{"KHR_texture_transform"},
    std::string_view{"EXT_mesh_gpu_instancing"},
    std::string_view{"CESIUM_RTC"},
    std::string_view{"KHR_materials_unlit"},
    std::string_view{"KHR_lights_punctual"},
    std::string_view{"EXT_mesh_features"},
    std::string_view{"EXT_structural_metadata"},
    std::string_view{"EXT_feature_metadata"},
    std::string_view{"KHR_materials_variants"},
    std::string_view{"KHR_materials_emissive_strength"},
};

std::uint32_t number_at(Bytes bytes, std::size_t offset) {
    std::uint32_t value = 0;
    if (offset + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + offset, 4);
    return value;
}

GltfJson parse(Bytes text, const std::string& name, std::string_view what) {
    GltfJson json = GltfJson::parse(text.begin(), text.end(), nullptr, false);
    if (json.is_discarded() || !json.is_object())
        throw InputError(fmt::format("{}: {} is no JSON object. Export the file again.", name, what));
    return json;
}

[[noreturn]] void fail_short(const std::string& name, std::string_view what) {
    throw InputError(
        fmt::format("{}: {} reaches beyond the end of the file. Is it a download that broke off?", name, what));
}

std::optional<int> base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return std::nullopt;
}

}  // namespace

const GltfJson& member(const GltfJson& object, std::string_view key) {
    static const GltfJson kNone;
    if (!object.is_object()) return kNone;
    const auto found = object.find(key);
    return found == object.end() ? kNone : *found;
}

std::optional<std::size_t> index_at(const GltfJson& object, std::string_view key) {
    const GltfJson& value = member(object, key);
    if (value.is_null()) return std::nullopt;
    if (value.is_number_unsigned()) return value.get<std::size_t>();
    throw GltfFault(fmt::format("'{}' is no whole number from 0 on", key));
}

std::size_t index_or(const GltfJson& object, std::string_view key, std::size_t absent) {
    return index_at(object, key).value_or(absent);
}

const GltfJson& entry(const GltfJson& asset, std::string_view key, std::size_t index) {
    const GltfJson& list = member(asset, key);
    if (!list.is_array() || index >= list.size())
        throw GltfFault(fmt::format("{}[{}] does not exist among {}", key, index, list.is_array() ? list.size() : 0));
    return list[index];
}

std::optional<std::vector<double>> numbers_at(const GltfJson& object, std::string_view key, std::size_t count) {
    const GltfJson& list = member(object, key);
    if (list.is_null()) return std::nullopt;
    std::vector<double> numbers;
    for (std::size_t i = 0; list.is_array() && i < list.size() && list[i].is_number(); ++i)
        numbers.push_back(list[i].get<double>());
    if (!list.is_array() || list.size() != count || numbers.size() != count ||
        !std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); }))
        throw GltfFault(fmt::format("'{}' is not {} finite numbers", key, count));
    return numbers;
}

std::string text_at(const GltfJson& object, std::string_view key) {
    const GltfJson& value = member(object, key);
    return value.is_string() ? value.get<std::string>() : std::string();
}

std::vector<std::uint8_t> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || uri.substr(0, comma).find(";base64") == std::string_view::npos)
        throw GltfFault("a data URI is not in base64");
    std::vector<std::uint8_t> bytes;
    bytes.reserve((uri.size() - comma) * 3 / 4);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : uri.substr(comma + 1)) {
        if (c == '=') break;
        const std::optional<int> value = base64_value(c);
        if (!value) throw GltfFault("a data URI is not in base64");
        bits = bits << 6 | static_cast<std::uint32_t>(*value);
        if ((count += 6) < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
    return bytes;
}

std::string decode_percent(std::string_view uri) {
    const auto hex = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) ? c - '0' : (c | 32) - 'a' + 10; };
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_code = uri[i] == '%' && i + 2 < uri.size() &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 2]));
        name += is_code ? static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2])) : uri[i];
        if (is_code) i += 2;
    }
    return name;
}

GltfDocument::GltfDocument(const std::filesystem::path& path) : folder_(path.parent_path()), file_(read_file(path)) {
    const std::string name = path.string();
    try {
        read_container(name);
        const std::string version = text_at(member(json_, "asset"), "version");
        if (version.substr(0, 2) != "2.") {
            throw InputError(
                fmt::format("{}: is glTF {}; glTF 2.0 is read. Convert it, with gltf-pipeline for example.", name,
                            version.empty() ? "without a version" : version));
        }
        check_extensions(name);
        const GltfJson& rtc = member(member(json_, "extensions"), "CESIUM_RTC");
        if (const auto center = numbers_at(rtc, "center", 3))
            center_ += Vec3d((*center)[0], (*center)[1], (*center)[2]);
        read_buffers(name);
    } catch (const GltfFault& fault) {
        throw InputError(fmt::format("{}: {}. Export the file again.", name, fault.what()));
    }
}

void GltfDocument::read_container(const std::string& name) {
    Bytes bytes = file_;
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "b3dm", 4) == 0) {
        if (bytes.size() < kB3dmHeader) fail_short(name, "the header");
        // After the magic: version, length, and the lengths of the four tables before the GLB.
        std::uint64_t begin = kB3dmHeader;
        for (std::size_t table = 0; table < 4; ++table) begin += number_at(bytes, 12 + 4 * table);
        if (begin > bytes.size()) fail_short(name, "a table of the b3dm");
        const std::uint32_t feature_bytes = number_at(bytes, 12);
        if (feature_bytes > 0) {
            const GltfJson features = parse(bytes.subspan(kB3dmHeader, feature_bytes), name, "its feature table");
            if (const auto center = numbers_at(features, "RTC_CENTER", 3))
                center_ = {(*center)[0], (*center)[1], (*center)[2]};
        }
        bytes = bytes.subspan(static_cast<std::size_t>(begin));
        if (number_at(bytes, 0) != kGlbMagic)
            throw InputError(fmt::format("{}: there is no GLB in this b3dm. Export the tile again.", name));
    }
    if (number_at(bytes, 0) != kGlbMagic) {
        json_ = parse(bytes, name, "the file");
        return;
    }
    if (bytes.size() < kGlbHeader) fail_short(name, "the header");
    if (number_at(bytes, 4) != 2)
        throw InputError(fmt::format("{}: is GLB version {}; version 2 is read.", name, number_at(bytes, 4)));
    const std::size_t end = number_at(bytes, 8);
    if (end > bytes.size()) fail_short(name, "the GLB");
    std::size_t at = kGlbHeader;
    while (at + kChunkHeader <= end) {
        const std::size_t length = number_at(bytes, at);
        const std::uint32_t kind = number_at(bytes, at + 4);
        at += kChunkHeader;
        if (length > end - at) fail_short(name, "a chunk of the GLB");
        if (kind == kJsonChunk && json_.is_null()) json_ = parse(bytes.subspan(at, length), name, "its JSON chunk");
        if (kind == kBinaryChunk && !binary_) binary_ = bytes.subspan(at, length);
        at += length;
    }
    if (json_.is_null()) throw InputError(fmt::format("{}: the GLB has no JSON chunk. Export it again.", name));
}

void GltfDocument::check_extensions(const std::string& name) const {
    const GltfJson& required = member(json_, "extensionsRequired");
    if (!required.is_array()) return;
    for (const GltfJson& extension : required) {
        const std::string wanted = extension.is_string() ? extension.get<std::string>() : std::string("?");
        if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), wanted) != kKnownExtensions.end()) continue;
        throw InputError(fmt::format(
            "{}: requires the extension {}, which is not read. Export it without, with gltf-transform for example.",
            name, wanted));
    }
}

void GltfDocument::read_buffers(const std::string& name) {
    const GltfJson& list = member(json_, "buffers");
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
        const std::string uri = text_at(list[i], "uri");
        buffers_.emplace_back();
        // A buffer without address is the binary chunk, or the stand-in for what is compressed (EXT_meshopt).
        if (uri.empty()) continue;
        const auto [known, is_new] = buffer_files_.try_emplace(uri);
        if (is_new) known->second = read_buffer(uri, name);
        buffers_.back() = known->second;
    }
    byte_count_ = file_.size();
    for (const auto& [uri, bytes] : buffer_files_) byte_count_ += bytes.size();
}

std::vector<std::uint8_t> GltfDocument::read_buffer(const std::string& uri, const std::string& name) const {
    if (uri.substr(0, 5) == "data:") return decode_data_uri(uri);
    const std::optional<std::filesystem::path> path = path_below(folder_, decode_percent(uri));
    if (!path || uri.find("://") != std::string::npos) {
        throw InputError(fmt::format("{}: buffer '{}' lies outside the file's folder; refused. Put it below.", name,
                                     uri.substr(0, 200)));
    }
    checked_file_size(*path);
    return read_file(*path);
}

Bytes GltfDocument::view(std::size_t index) const {
    const GltfJson& view = entry(json_, "bufferViews", index);
    const GltfJson& extensions = member(view, "extensions");
    const GltfJson& meshopt = member(extensions, "EXT_meshopt_compression");
    const GltfJson& place = meshopt.is_null() ? view : meshopt;
    if (const auto known = decompressed_.find(index); known != decompressed_.end()) return known->second;
    const std::size_t buffer = index_at(place, "buffer").value_or(~std::size_t{0});
    if (buffer >= buffers_.size()) throw GltfFault(fmt::format("buffer of bufferViews[{}] does not exist", index));
    const bool is_chunk = buffer == 0 && binary_ && text_at(member(json_, "buffers")[0], "uri").empty();
    const Bytes whole = is_chunk ? *binary_ : buffers_[buffer];
    const std::size_t offset = index_or(place, "byteOffset", 0), length = index_or(place, "byteLength", 0);
    if (offset > whole.size() || length > whole.size() - offset)
        throw GltfFault(fmt::format("bufferViews[{}] reaches beyond the end of its buffer", index));
    const Bytes bytes = whole.subspan(offset, length);
    if (meshopt.is_null()) return bytes;
    std::vector<std::uint8_t> decompressed = decode_meshopt(bytes, meshopt);
    decompressed_bytes_ += decompressed.size();
    if (decompressed_bytes_ > kMostMeshoptExpansion * byte_count_)
        throw GltfFault("its bufferViews decompress the same bytes again and again");
    return decompressed_.emplace(index, std::move(decompressed)).first->second;
}

}  // namespace skybake::io
