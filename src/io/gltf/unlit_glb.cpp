#include "io/gltf/unlit_glb.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::size_t padded(std::size_t size) {
    return (size + 3) / 4 * 4;
}

std::uint32_t word_at(Bytes bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof(word));
    return word;
}

struct Parts {
    Json json;
    Bytes binary;
};

/// The two chunks of a GLB that skybake wrote. Throws std::exception for what is none.
Parts parts_of(Bytes bytes) {
    if (bytes.size() < kHeader + kChunkHeader || word_at(bytes, 0) != 0x46546c67) throw std::runtime_error("no GLB");
    const std::size_t json_size = word_at(bytes, kHeader);
    const std::size_t binary = kHeader + kChunkHeader + json_size;
    if (bytes.size() < binary + kChunkHeader) throw std::runtime_error("it ends early");
    const std::size_t binary_size = word_at(bytes, binary);
    if (bytes.size() < binary + kChunkHeader + binary_size) throw std::runtime_error("it ends early");
    const char* text = reinterpret_cast<const char*>(bytes.data()) + kHeader + kChunkHeader;
    return {Json::parse(text, text + json_size), bytes.subspan(binary + kChunkHeader, binary_size)};
}

/// The new file's buffer: pieces of the old one and pictures, one after the other.
class Buffer {
  public:
    std::size_t add(Bytes piece, Json view) {
        view["buffer"] = 0;
        view["byteOffset"] = size_;
        view["byteLength"] = piece.size();
        views.push_back(std::move(view));
        pieces_.push_back(piece);
        size_ += padded(piece.size());
        return views.size() - 1;
    }
    std::size_t size() const { return size_; }
    void write(FileReplacement& file) const {
        static constexpr std::array<std::uint8_t, 3> kZeros{};
        for (const Bytes& piece : pieces_) {
            file.write(piece);
            file.write(Bytes(kZeros).first(padded(piece.size()) - piece.size()));
        }
    }
    Json views = Json::array();

  private:
    std::vector<Bytes> pieces_;
    std::size_t size_ = 0;
};

Json material_of(std::size_t page) {
    return {{"name", fmt::format("page {}", page)},
            {"doubleSided", true},  // real cities have inverted faces
            {"pbrMetallicRoughness",
             {{"baseColorTexture", {{"index", page}, {"texCoord", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
            {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
}

Json unlit_json(const Parts& city, std::span<const std::vector<std::uint8_t>> page_pngs, const std::string& generator,
                Buffer& buffer) {
    const Json& old = city.json;
    Json accessors = Json::array();
    std::map<std::size_t, std::size_t> new_accessor, new_view;
    const auto accessor = [&](const Json& index) {
        const std::size_t from = index.get<std::size_t>();
        const auto [entry, is_new] = new_accessor.try_emplace(from, accessors.size());
        if (!is_new) return entry->second;
        Json copy = old.at("accessors").at(from);
        const std::size_t view_from = copy.at("bufferView").get<std::size_t>();
        if (const auto known = new_view.find(view_from); known != new_view.end()) {
            copy["bufferView"] = known->second;
        } else {
            const Json& view = old.at("bufferViews").at(view_from);
            const std::size_t offset = view.value("byteOffset", std::size_t{0});
            const std::size_t size = view.at("byteLength").get<std::size_t>();
            if (offset > city.binary.size() || size > city.binary.size() - offset)
                throw std::runtime_error("a view leads out of it");
            copy["bufferView"] = new_view[view_from] = buffer.add(city.binary.subspan(offset, size), view);
        }
        accessors.push_back(std::move(copy));
        return entry->second;
    };
    Json primitives = Json::array();
    for (const Json& mesh : old.at("meshes")) {
        for (const Json& primitive : mesh.at("primitives")) {
            const Json& attributes = primitive.at("attributes");
            const Json& material = old.at("materials").at(primitive.at("material").get<std::size_t>());
            const std::size_t page = material.at("extensions").at("SKYBAKE_lightmap").at("page").get<std::size_t>();
            if (page >= page_pngs.size()) throw std::runtime_error("it names a page that the bake does not have");
            primitives.push_back({{"attributes",
                                   {{"POSITION", accessor(attributes.at("POSITION"))},
                                    {"NORMAL", accessor(attributes.at("NORMAL"))},
                                    {"TEXCOORD_0", accessor(attributes.at("TEXCOORD_1"))}}},
                                  {"indices", accessor(primitive.at("indices"))},
                                  {"material", page}});
        }
    }
    Json materials = Json::array(), textures = Json::array(), images = Json::array();
    for (std::size_t p = 0; p < page_pngs.size(); ++p) {
        images.push_back({{"bufferView", buffer.add(page_pngs[p], Json::object())}, {"mimeType", "image/png"}});
        textures.push_back({{"sampler", 0}, {"source", p}});
        materials.push_back(material_of(p));
    }
    // Linear without mipmaps, clamped: beyond the gutter other charts begin.
    const Json sampler = {{"magFilter", 9729}, {"minFilter", 9729}, {"wrapS", 33071}, {"wrapT", 33071}};
    return {{"asset", {{"version", "2.0"}, {"generator", generator}}},
            {"extensionsUsed", {"KHR_materials_unlit"}},
            {"scene", 0},
            {"scenes", old.at("scenes")},
            {"nodes", Json::array({{{"name", "city"}, {"mesh", 0}}})},
            {"meshes", Json::array({{{"name", "city"}, {"primitives", primitives}}})},
            {"materials", materials},
            {"textures", textures},
            {"samplers", Json::array({sampler})},
            {"images", images},
            {"accessors", accessors},
            {"bufferViews", buffer.views},
            {"buffers", Json::array({{{"byteLength", buffer.size()}}})}};
}

void write_word(FileReplacement& file, std::uint32_t word) {
    std::array<std::uint8_t, 4> bytes{};
    std::memcpy(bytes.data(), &word, sizeof(word));
    file.write(Bytes(bytes));
}

}  // namespace

void write_unlit_glb(const std::filesystem::path& city, const std::filesystem::path& target,
                     std::span<const std::vector<std::uint8_t>> page_pngs, const std::string& generator) {
    const std::vector<std::uint8_t> bytes = read_file(city);
    Buffer buffer;
    std::string json;
    try {
        json = unlit_json(parts_of(bytes), page_pngs, generator, buffer)
                   .dump(-1, ' ', false, Json::error_handler_t::replace);
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: is not the city of a bake ({}). Bake again.", city.string(), error.what()));
    }
    json.resize(padded(json.size()), ' ');
    const std::size_t total = kHeader + kChunkHeader + json.size() + kChunkHeader + buffer.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw InputError(fmt::format("{}: would have {} bytes, more than the 4 GiB of a GLB. Lower --detail.",
                                     target.string(), total));
    FileReplacement file(target);
    for (const std::size_t word :
         {std::size_t{0x46546c67}, std::size_t{2}, total, json.size(), std::size_t{0x4e4f534a}})
        write_word(file, static_cast<std::uint32_t>(word));
    file.write(std::string_view(json));
    for (const std::size_t word : {buffer.size(), std::size_t{0x004e4942}})
        write_word(file, static_cast<std::uint32_t>(word));
    buffer.write(file);
    file.commit();
}

}  // namespace skybake::io
