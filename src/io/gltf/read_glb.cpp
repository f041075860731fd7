#include "io/gltf/read_glb.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/image/image.h"

namespace skybake::io {
namespace {

using Json = nlohmann::json;

// Numbers of the glTF 2.0 specification.
constexpr std::uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN"
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kTriangles = 4;
constexpr int kMirroredRepeat = 33648;
constexpr int kClampToEdge = 33071;

/// What an accessor leads to: `count` elements, `stride` bytes from one to the next.
struct Elements {
    const std::uint8_t* first = nullptr;
    std::size_t count = 0;
    std::size_t stride = 0;

    template <typename T>
    T at(std::size_t index) const {
        T value;
        std::memcpy(&value, first + index * stride, sizeof(T));
        return value;
    }
};

AlbedoImage albedo_image(const Image8& picture) {
    AlbedoImage image{picture.width, picture.height, {}};
    const std::size_t channels = static_cast<std::size_t>(picture.channels);
    image.pixels.resize(picture.pixels.size() / channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.pixels[i][c] = picture.pixels[i * channels + (channels < 3 ? 0 : c)];
    }
    return image;
}

TextureWrap wrap_of(const Json& sampler) {
    const int number = sampler.value("wrapS", 10497);
    return number == kClampToEdge      ? TextureWrap::clamp
           : number == kMirroredRepeat ? TextureWrap::mirror
                                       : TextureWrap::repeat;
}

class GlbReader {
  public:
    GlbReader(const std::filesystem::path& path, std::span<const Vec2i> page_sizes)
        : path_(path), page_sizes_(page_sizes), bytes_(read_file(path)) {}

    PictureScene read() {
        try {
            find_chunks();
            for (const Json& material : list("materials")) read_material(material);
            for (const Json& mesh : list("meshes")) {
                for (const Json& primitive : mesh.at("primitives")) read_primitive(primitive);
            }
            for (const Json& node : list("nodes")) {
                for (const char* key : {"matrix", "translation", "rotation", "scale"})
                    if (node.contains(key)) fail("moves a part of the city, which skybake never does");
            }
        } catch (const Json::exception& fault) {
            fail(fault.what());
        }
        read_textures();
        return std::move(scene_);
    }

  private:
    [[noreturn]] void fail(const std::string& fault) const {
        throw InputError(fmt::format("{}: is no city of a bake ({}). Bake again.", path_.string(), fault));
    }

    const Json& list(const char* name) const {
        static const Json kNone = Json::array();
        const auto found = json_.find(name);
        return found == json_.end() ? kNone : *found;
    }

    std::uint32_t word(std::size_t offset) const {
        if (offset + 4 > bytes_.size()) fail("it ends early");
        std::uint32_t value = 0;
        std::memcpy(&value, bytes_.data() + offset, 4);
        return value;
    }

    void find_chunks() {
        if (word(0) != kMagic || word(4) != 2) fail("it is no GLB 2");
        const std::size_t json_size = word(12);
        if (word(16) != kJsonChunk || json_size > bytes_.size() - 20) fail("it ends early");
        const auto* text = reinterpret_cast<const char*>(bytes_.data()) + 20;
        json_ = Json::parse(text, text + json_size);
        const std::size_t next = 20 + json_size;
        if (next >= bytes_.size()) return;  // no geometry
        const std::size_t bin_size = word(next);
        if (word(next + 4) != kBinChunk || bin_size > bytes_.size() - next - 8) fail("it ends early");
        buffer_ = std::span(bytes_).subspan(next + 8, bin_size);
    }

    std::span<const std::uint8_t> view(std::size_t index) const {
        const Json& view = json_.at("bufferViews").at(index);
        const auto offset = view.value("byteOffset", std::uint64_t{0});
        const auto length = view.at("byteLength").get<std::uint64_t>();
        if (offset > buffer_.size() || length > buffer_.size() - offset)
            fail(fmt::format("buffer view {} leaves the file", index));
        return buffer_.subspan(offset, length);
    }

    Elements elements(const Json& index, int component, const char* type, std::size_t size) const {
        const std::size_t number = index.get<std::size_t>();
        const Json& accessor = json_.at("accessors").at(number);
        if (accessor.at("componentType") != component || accessor.at("type") != type)
            fail(fmt::format("accessor {} is of another type", number));
        const std::size_t view_number = accessor.at("bufferView").get<std::size_t>();
        const std::span<const std::uint8_t> bytes = view(view_number);
        const auto offset = accessor.value("byteOffset", std::uint64_t{0});
        Elements elements;
        elements.count = accessor.at("count").get<std::size_t>();
        elements.stride = json_["bufferViews"][view_number].value("byteStride", size);
        if (elements.stride < size || offset > bytes.size() || elements.count == 0 ||
            elements.count - 1 > (bytes.size() - offset) / elements.stride ||
            (elements.count - 1) * elements.stride + size > bytes.size() - offset)
            fail(fmt::format("accessor {} leaves its buffer view", number));
        elements.first = bytes.data() + offset;
        return elements;
    }

    void read_material(const Json& material) {
        PictureMaterial read;
        const Json& pbr = material.at("pbrMetallicRoughness");
        read.base_colour = Rgb(1.0f);
        if (pbr.contains("baseColorFactor")) {
            for (int c = 0; c < 3; ++c)
                read.base_colour[c] = pbr["baseColorFactor"].at(static_cast<std::size_t>(c)).get<float>();
        }
        if (pbr.contains("baseColorTexture")) {
            const Json& texture = json_.at("textures").at(pbr["baseColorTexture"].at("index").get<std::size_t>());
            if (texture.contains("sampler"))
                read.wrap = wrap_of(json_.at("samplers").at(texture["sampler"].get<std::size_t>()));
            read.texture = texture_of_image(texture.at("source").get<std::size_t>());
        }
        scene_.materials.push_back(read);
        const std::size_t page = material.at("extensions").at("SKYBAKE_lightmap").at("page").get<std::size_t>();
        if (page >= page_sizes_.size()) fail(fmt::format("a material lies on page {} of {}", page, page_sizes_.size()));
        page_of_material_.push_back(static_cast<std::uint32_t>(page));
    }

    std::uint32_t texture_of_image(std::size_t image) {
        for (std::size_t i = 0; i < images_.size(); ++i)
            if (images_[i] == image) return static_cast<std::uint32_t>(i);
        images_.push_back(image);
        return static_cast<std::uint32_t>(images_.size() - 1);
    }

    void read_primitive(const Json& primitive) {
        if (primitive.value("mode", kTriangles) != kTriangles) fail("a primitive is not of triangles");
        const Json& attributes = primitive.at("attributes");
        const Elements positions = elements(attributes.at("POSITION"), kFloat, "VEC3", 12);
        const Elements albedo_uvs = elements(attributes.at("TEXCOORD_0"), kFloat, "VEC2", 8);
        const Elements light_uvs = elements(attributes.at("TEXCOORD_1"), kFloat, "VEC2", 8);
        const Elements indices = elements(primitive.at("indices"), kUnsignedInt, "SCALAR", 4);
        const std::size_t vertices = positions.count;
        if (albedo_uvs.count != vertices || light_uvs.count != vertices || indices.count % 3 != 0)
            fail("the attributes of a primitive differ in number");
        PictureSurface surface;
        surface.material = primitive.at("material").get<std::uint32_t>();
        if (surface.material >= scene_.materials.size()) fail("a primitive names no material");
        surface.page = page_of_material_[surface.material];
        const Vec2f page_size(page_sizes_[surface.page]);
        for (std::size_t i = 0; i < indices.count; i += 3) {
            std::array<Vec3f, 3> triangle;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = indices.at<std::uint32_t>(i + corner);
                if (vertex >= vertices) fail(fmt::format("a triangle names vertex {} of {}", vertex, vertices));
                const Vec3f p = positions.at<Vec3f>(vertex);  // y up: x = east, z = south
                const Vec2f uv = albedo_uvs.at<Vec2f>(vertex);
                const Vec2f light_uv = light_uvs.at<Vec2f>(vertex);
                const float sum = p.x + p.y + p.z + uv.x + uv.y + light_uv.x + light_uv.y;
                if (!std::isfinite(sum)) fail(fmt::format("vertex {} is not finite", vertex));
                triangle[corner] = {p.x, -p.z, p.y};
                surface.albedo_uv[corner] = {uv.x, 1.0f - uv.y};
                surface.texel[corner] = light_uv * page_size;
                scene_.bounds.extend(triangle[corner]);
            }
            scene_.triangles.push_back(triangle);
            scene_.surfaces.push_back(surface);
        }
    }

    void read_textures() {
        std::vector<std::optional<MipTexture>> textures(images_.size());
        tbb::parallel_for(std::size_t{0}, images_.size(), [&](std::size_t i) {
            std::span<const std::uint8_t> bytes;
            try {
                bytes = view(json_.at("images").at(images_[i]).at("bufferView").get<std::size_t>());
            } catch (const Json::exception& fault) {
                fail(fault.what());
            }
            const std::string name = fmt::format("{}, image {}", path_.string(), images_[i]);
            textures[i].emplace(albedo_image(decode_image(bytes, name)));
        });
        for (std::optional<MipTexture>& texture : textures) scene_.textures.push_back(std::move(*texture));
    }

    const std::filesystem::path& path_;
    std::span<const Vec2i> page_sizes_;
    std::vector<std::uint8_t> bytes_;
    std::span<const std::uint8_t> buffer_;
    Json json_;
    std::vector<std::uint32_t> page_of_material_;
    std::vector<std::size_t> images_;  // of glTF, in the order of PictureScene::textures
    PictureScene scene_;
};

}  // namespace

PictureScene read_glb(const std::filesystem::path& path, std::span<const Vec2i> page_sizes) {
    return GlbReader(path, page_sizes).read();
}

}  // namespace skybake::io
