#include "io/gltf/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/gltf/welded_mesh.h"
#include "io/image/image.h"

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification (and of OpenGL, whence it has them).
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kLinear = 9729;
constexpr int kLinearMipmapLinear = 9987;
constexpr int kRepeat = 10497;
constexpr int kMirroredRepeat = 33648;
constexpr int kClampToEdge = 33071;

/// The y-up frame of glTF.
Vec3f y_up(const Vec3f& v) {
    return {v.x, v.z, -v.y};
}

int wrap_number(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::repeat:
            return kRepeat;
        case TextureWrap::mirror:
            return kMirroredRepeat;
        case TextureWrap::none:  // glTF knows no border; the edge's own colour comes nearest
        case TextureWrap::border:
        case TextureWrap::clamp:
            break;
    }
    return kClampToEdge;
}

struct EmbeddedImage {
    std::string path;  // of a file; empty when the bytes are at hand
    const std::vector<std::uint8_t>* bytes = nullptr;
    std::string mime_type;
    std::uint64_t size = 0;
};

const char* mime_type(ImageFormat format) {
    return format == ImageFormat::png ? "image/png" : "image/jpeg";
}

/// What tells pictures apart: the file, or the name of embedded content.
const std::string& name_of_picture(const Texture& texture) {
    return texture.embedded ? texture.uri : texture.path;
}

/// The file as it may be embedded; none when it is absent, or neither PNG nor JPEG.
std::optional<EmbeddedImage> embeddable(const Texture& texture) {
    if (texture.is_missing) return {};
    if (texture.embedded) {
        const ImageFormat format = image_format(*texture.embedded);
        if (format == ImageFormat::other) return {};
        return EmbeddedImage{"", texture.embedded.get(), mime_type(format), texture.embedded->size()};
    }
    std::array<std::uint8_t, 8> start{};
    std::ifstream stream(texture.path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(start.data()), start.size());
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(texture.path, error);
    const ImageFormat format = image_format(std::span(start).first(static_cast<std::size_t>(stream.gcount())));
    if (error || format == ImageFormat::other) return {};
    return EmbeddedImage{texture.path, nullptr, mime_type(format), size};
}

/// Images, samplers, textures and materials of the file, each once.
class Palette {
  public:
    Palette(const Scene& scene, std::span<const std::vector<std::uint8_t>> sky_view_pngs) : scene_(scene) {
        for (const std::vector<std::uint8_t>& png : sky_view_pngs) {
            images.push_back({"", &png, "image/png", png.size()});
            textures.push_back({{"sampler", sampler(kClampToEdge, kLinear)}, {"source", images.size() - 1}});
        }
    }

    bool has_texture(const SceneMaterial& material) { return albedo_texture(material).has_value(); }

    /// The index of the material for a primitive.
    std::size_t add_material(MaterialId id, PageId page) {
        const SceneMaterial& material = scene_.materials[id.index()];
        const std::optional<std::size_t> texture = albedo_texture(material);
        const Rgb albedo =
            material.texture && !texture ? Rgb(kAlbedoWithoutTexture) : glm::clamp(material.albedo, 0.0f, 1.0f);
        Json pbr = {
            {"baseColorFactor", {albedo.x, albedo.y, albedo.z, 1.0f}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
        if (texture) pbr["baseColorTexture"] = {{"index", *texture}};
        materials.push_back({{"name", material.name},
                             {"pbrMetallicRoughness", pbr},
                             {"occlusionTexture", {{"index", page.index()}, {"texCoord", 1}, {"strength", 1}}},
                             {"doubleSided", true},  // real cities have inverted faces
                             {"extensions", {{"SKYBAKE_lightmap", {{"page", page.index()}, {"texCoord", 1}}}}}});
        return materials.size() - 1;
    }

    std::vector<EmbeddedImage> images;
    Json samplers = Json::array();
    Json textures = Json::array();  // the pages' sky view factors first
    Json materials = Json::array();
    std::size_t textures_left_out = 0;

  private:
    std::size_t sampler(int wrap, int min_filter) {
        const Json wanted = {{"magFilter", kLinear}, {"minFilter", min_filter}, {"wrapS", wrap}, {"wrapT", wrap}};
        const auto found = std::find(samplers.begin(), samplers.end(), wanted);
        if (found != samplers.end()) return static_cast<std::size_t>(found - samplers.begin());
        samplers.push_back(wanted);
        return samplers.size() - 1;
    }

    std::optional<std::size_t> albedo_texture(const SceneMaterial& material) {
        if (!material.texture) return {};
        const Texture& texture = scene_.textures[material.texture->index()];
        const auto [entry, is_new] = texture_of_.try_emplace({name_of_picture(texture), wrap_number(material.wrap)});
        if (!is_new) return entry->second;
        const auto [image, is_new_image] = image_of_.try_emplace(name_of_picture(texture));
        if (is_new_image) {
            if (const std::optional<EmbeddedImage> embedded = embeddable(texture)) {
                image->second = images.size();
                images.push_back(*embedded);
            } else {
                ++textures_left_out;
            }
        }
        if (image->second) {
            entry->second = textures.size();
            textures.push_back(
                {{"sampler", sampler(wrap_number(material.wrap), kLinearMipmapLinear)}, {"source", *image->second}});
        }
        return entry->second;
    }

    const Scene& scene_;
    std::map<std::pair<std::string, int>, std::optional<std::size_t>> texture_of_;
    std::map<std::string, std::optional<std::size_t>> image_of_;
};

/// Gathers small writes into large ones.
class BufferedWriter {
  public:
    explicit BufferedWriter(FileReplacement& file) : file_(file) { buffer_.reserve(kCapacity); }
    template <typename T>
    void put(const T& value) {
        if (buffer_.size() + sizeof(T) > kCapacity) flush();
        const std::size_t at = buffer_.size();
        buffer_.resize(at + sizeof(T));
        std::memcpy(buffer_.data() + at, &value, sizeof(T));
    }
    void put_bytes(std::span<const std::uint8_t> bytes) {
        flush();
        file_.write(bytes);
    }
    void flush() {
        file_.write(buffer_);
        buffer_.clear();
    }

  private:
    static constexpr std::size_t kCapacity = std::size_t{1} << 20;
    FileReplacement& file_;
    std::vector<std::uint8_t> buffer_;
};

constexpr std::uint64_t padded(std::uint64_t size) {
    return (size + 3) / 4 * 4;
}

/// Plans the file from front to back, then writes it in the same order.
class GlbWriter {
  public:
    GlbWriter(const Scene& scene, const Atlas& atlas, std::span<const std::vector<std::uint8_t>> sky_view_pngs,
              const GlbInfo& info)
        : scene_(scene), atlas_(atlas), info_(info), mesh_(weld(scene, atlas)), palette_(scene, sky_view_pngs) {}

    GlbSummary write(const std::filesystem::path& path) {
        // `_CHART` is a float, which counts exactly up to here.
        if (atlas_.charts.size() > (std::size_t{1} << 24)) {
            throw InputError(fmt::format("{}: has {} charts, more than one GLB can name. Bake the city in parts.",
                                         path.string(), atlas_.charts.size()));
        }
        const std::string json = plan();
        const std::uint64_t total = 12 + 8 + padded(json.size()) + (size_ > 0 ? 8 + size_ : 0);
        if (total > std::numeric_limits<std::uint32_t>::max()) {
            throw InputError(
                fmt::format("{}: would have {} bytes, more than the 4 GiB of a GLB. Bake the city in parts.",
                            path.string(), total));
        }
        FileReplacement file(path);
        BufferedWriter out(file);
        out.put(std::uint32_t{0x46546c67});  // "glTF"
        out.put(std::uint32_t{2});
        out.put(static_cast<std::uint32_t>(total));
        out.put(static_cast<std::uint32_t>(padded(json.size())));
        out.put(std::uint32_t{0x4e4f534a});  // "JSON"
        for (const char c : json) out.put(c);
        for (std::uint64_t i = json.size(); i < padded(json.size()); ++i) out.put(' ');
        if (size_ > 0) {
            out.put(static_cast<std::uint32_t>(size_));
            out.put(std::uint32_t{0x004e4942});  // "BIN"
            write_geometry(out);
            const std::span<const EmbeddedImage> images = palette_.images;
            write_images(out, images.subspan(atlas_.pages.size()));
            for (const WeldedPrimitive& p : mesh_.primitives)
                for_each_vertex(p, [&](ChartId, const WeldedVertex& v) { out.put(y_up(v.normal)); });
            write_images(out, images.first(atlas_.pages.size()));
        }
        out.flush();
        file.commit();
        GlbSummary summary;
        summary.vertices = mesh_.vertex_corner.size();
        summary.triangles = mesh_.indices.size() / 3;
        summary.primitives = mesh_.primitives.size();
        summary.images = palette_.images.size() - atlas_.pages.size();
        summary.textures_left_out = palette_.textures_left_out;
        summary.bytes = total;
        return summary;
    }

  private:
    /// A new buffer view behind the others; `stride` and `target` are left out when 0.
    std::size_t add_view(std::uint64_t size, int stride, int target) {
        Json view = {{"buffer", 0}, {"byteOffset", size_}, {"byteLength", size}};
        if (stride > 0) view["byteStride"] = stride;
        if (target > 0) view["target"] = target;
        views_.push_back(view);
        size_ += padded(size);
        return views_.size() - 1;
    }

    std::size_t add_accessor(std::size_t view, std::uint64_t offset, int component, std::uint64_t count,
                             const char* type) {
        accessors_.push_back({{"bufferView", view},
                              {"byteOffset", offset},
                              {"componentType", component},
                              {"count", count},
                              {"type", type}});
        return accessors_.size() - 1;
    }

    /// A view for each of the images [begin, end).
    std::vector<std::size_t> add_image_views(std::size_t begin, std::size_t end) {
        std::vector<std::size_t> views;
        for (std::size_t i = begin; i < end; ++i) views.push_back(add_view(palette_.images[i].size, 0, 0));
        return views;
    }

    std::string plan() {
        Json primitives = Json::array();
        std::uint64_t textured_vertices = 0;
        std::vector<std::size_t> materials;
        std::vector<std::size_t> image_views;
        for (const WeldedPrimitive& p : mesh_.primitives) {
            is_textured_.push_back(palette_.has_texture(scene_.materials[p.material.index()]));
            if (is_textured_.back()) textured_vertices += p.vertex_end - p.vertex_begin;
            materials.push_back(palette_.add_material(p.material, p.page));
        }
        if (!mesh_.primitives.empty()) {
            const std::uint64_t vertices = mesh_.vertex_corner.size();
            const std::size_t positions = add_view(12 * vertices, 12, kArrayBuffer);
            const std::size_t light_uvs = add_view(8 * vertices, 8, kArrayBuffer);
            const std::size_t charts = add_view(4 * vertices, 4, kArrayBuffer);
            const std::size_t albedo_uvs = textured_vertices > 0 ? add_view(8 * textured_vertices, 8, kArrayBuffer) : 0;
            const std::size_t indices = add_view(4 * mesh_.indices.size(), 0, kElementArrayBuffer);
            image_views = add_image_views(atlas_.pages.size(), palette_.images.size());
            // From here on stands what the walkthrough does without: it stops reading.
            const std::size_t normals = add_view(12 * vertices, 12, kArrayBuffer);
            std::uint64_t textured_begin = 0;
            for (std::size_t i = 0; i < mesh_.primitives.size(); ++i) {
                const WeldedPrimitive& p = mesh_.primitives[i];
                const std::uint64_t count = p.vertex_end - p.vertex_begin;
                const std::size_t position = add_accessor(positions, 12 * p.vertex_begin, kFloat, count, "VEC3");
                // z = −north, so the bounds of z change places.
                accessors_.back()["min"] = {p.bounds.lo.x, p.bounds.lo.z, -p.bounds.hi.y};
                accessors_.back()["max"] = {p.bounds.hi.x, p.bounds.hi.z, -p.bounds.lo.y};
                const std::size_t normal = add_accessor(normals, 12 * p.vertex_begin, kFloat, count, "VEC3");
                const std::size_t light_uv = add_accessor(light_uvs, 8 * p.vertex_begin, kFloat, count, "VEC2");
                const std::size_t chart = add_accessor(charts, 4 * p.vertex_begin, kFloat, count, "SCALAR");
                // glTF wants a first UV set where there is a second; without a texture nothing reads it.
                std::size_t albedo_uv = light_uv;
                if (is_textured_[i]) {
                    albedo_uv = add_accessor(albedo_uvs, 8 * textured_begin, kFloat, count, "VEC2");
                    textured_begin += count;
                }
                const std::size_t index =
                    add_accessor(indices, 4 * p.index_begin, kUnsignedInt, p.index_end - p.index_begin, "SCALAR");
                primitives.push_back({{"attributes",
                                       {{"POSITION", position},
                                        {"NORMAL", normal},
                                        {"TEXCOORD_0", albedo_uv},
                                        {"TEXCOORD_1", light_uv},
                                        {"_CHART", chart}}},
                                      {"indices", index},
                                      {"material", materials[i]}});
            }
        }
        Json images = Json::array();
        const std::vector<std::size_t> page_views = add_image_views(0, atlas_.pages.size());
        image_views.insert(image_views.begin(), page_views.begin(), page_views.end());
        for (std::size_t i = 0; i < image_views.size(); ++i)
            images.push_back({{"bufferView", image_views[i]}, {"mimeType", palette_.images[i].mime_type}});
        Json pages = Json::array();
        for (const AtlasPage& page : atlas_.pages) pages.push_back({{"width", page.width}, {"height", page.height}});

        Json node = {{"name", "city"}};
        Json gltf = {
            {"asset", {{"version", "2.0"}, {"generator", info_.generator}}},
            {"extensionsUsed", {"SKYBAKE_lightmap"}},
            {"extensions",
             {{"SKYBAKE_lightmap", {{"version", 1}, {"quantity", "illuminance"}, {"unit", "klx"}, {"pages", pages}}}}},
            {"scene", 0}};
        gltf["scenes"] = Json::array(
            {{{"nodes", {0}},
              {"extras", {{"crs", info_.crs}, {"origin", {scene_.origin.x, scene_.origin.y, scene_.origin.z}}}}}});
        if (!primitives.empty()) {
            node["mesh"] = 0;
            gltf["meshes"] = Json::array({{{"name", "city"}, {"primitives", primitives}}});
        }
        gltf["nodes"] = Json::array({node});
        const auto add_unless_empty = [&](const char* name, const Json& list) {
            if (!list.empty()) gltf[name] = list;
        };
        add_unless_empty("materials", palette_.materials);
        add_unless_empty("textures", palette_.textures);
        add_unless_empty("samplers", palette_.samplers);
        add_unless_empty("images", images);
        add_unless_empty("accessors", accessors_);
        add_unless_empty("bufferViews", views_);
        if (size_ > 0) gltf["buffers"] = Json::array({{{"byteLength", size_}}});
        return gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
    }

    template <typename Put>
    void for_each_vertex(const WeldedPrimitive& primitive, Put put) const {
        for (std::uint64_t v = primitive.vertex_begin; v < primitive.vertex_end; ++v) {
            const std::uint32_t corner = mesh_.vertex_corner[v];
            const ChartId chart = atlas_.triangle_chart[corner / 3];
            put(chart, vertex_at(scene_, atlas_, atlas_.charts[chart.index()], corner));
        }
    }

    void write_geometry(BufferedWriter& out) {
        for (const WeldedPrimitive& p : mesh_.primitives) {
            for_each_vertex(p, [&](ChartId, const WeldedVertex& v) { out.put(y_up(v.position)); });
        }
        for (const WeldedPrimitive& p : mesh_.primitives) {
            const AtlasPage& page = atlas_.pages[p.page.index()];
            const Vec2f size(static_cast<float>(page.width), static_cast<float>(page.height));
            for_each_vertex(p, [&](ChartId, const WeldedVertex& v) { out.put(v.texel / size); });
        }
        for (const WeldedPrimitive& p : mesh_.primitives) {
            for_each_vertex(p, [&](ChartId chart, const WeldedVertex&) { out.put(static_cast<float>(chart.value)); });
        }
        for (std::size_t i = 0; i < mesh_.primitives.size(); ++i) {
            if (!is_textured_[i]) continue;
            for_each_vertex(mesh_.primitives[i], [&](ChartId, const WeldedVertex& v) {
                out.put(Vec2f(v.albedo_uv.x, 1.0f - v.albedo_uv.y));
            });
        }
        for (const std::uint32_t index : mesh_.indices) out.put(index);
    }

    static void write_images(BufferedWriter& out, std::span<const EmbeddedImage> images) {
        for (const EmbeddedImage& image : images) {
            const std::vector<std::uint8_t> file =
                image.bytes == nullptr ? read_file(image.path) : std::vector<std::uint8_t>();
            const std::vector<std::uint8_t>& bytes = image.bytes == nullptr ? file : *image.bytes;
            if (bytes.size() != image.size)
                throw InputError(fmt::format("{}: changed while it was read. Bake again.", image.path));
            out.put_bytes(bytes);
            for (std::uint64_t i = bytes.size(); i < padded(bytes.size()); ++i) out.put(std::uint8_t{0});
        }
    }

    const Scene& scene_;
    const Atlas& atlas_;
    const GlbInfo& info_;
    WeldedMesh mesh_;
    Palette palette_;
    std::vector<bool> is_textured_;  // one a primitive
    Json views_ = Json::array();
    Json accessors_ = Json::array();
    std::uint64_t size_ = 0;
};

}  // namespace

GlbSummary write_glb(const std::filesystem::path& path, const Scene& scene, const Atlas& atlas,
                     std::span<const std::vector<std::uint8_t>> sky_view_pngs, const GlbInfo& info) {
    return GlbWriter(scene, atlas, sky_view_pngs, info).write(path);
}

}  // namespace skybake::io
