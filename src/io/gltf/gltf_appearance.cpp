// Based on: glTF 2.0 specification, sections 3.8 (textures) and 3.9 (materials); KHR_texture_transform.
#include "io/gltf/gltf_appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "city/finding_codes.h"
#include "io/assembly/city_assembly.h"
#include "io/assembly/local_image.h"

namespace skybake::io {
namespace {

constexpr std::size_t kMirroredRepeat = 33648, kClampToEdge = 33071;

class AppearanceReader {
  public:
    AppearanceReader(const GltfDocument& document, std::string name, FindingLog& findings)
        : document_(document), name_(std::move(name)), findings_(findings) {}

    GltfAppearance read() {
        const GltfJson& list = member(document_.json(), "materials");
        for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
            const std::string where = fmt::format("{}: materials[{}]", name_, i);
            try {
                read_material(list[i], where);
            } catch (const GltfFault& fault) {
                result_.all.resize(i + 1);
                findings_.add(make_finding("SB404", where, fmt::format("{}; default albedos are used.", fault.what())));
            }
        }
        return std::move(result_);
    }

  private:
    void read_material(const GltfJson& json, const std::string& where) {
        GltfMaterial& material = result_.all.emplace_back();
        material.name = text_at(json, "name");
        const GltfJson& pbr = member(json, "pbrMetallicRoughness");
        std::vector<double> color = numbers_at(pbr, "baseColorFactor", 4).value_or(std::vector<double>{1, 1, 1, 1});
        const GltfJson* image = &member(pbr, "baseColorTexture");
        const GltfJson& emitted = member(json, "emissiveTexture");
        const bool is_black = color[0] + color[1] + color[2] == 0.0;
        if (is_black && !emitted.is_null()) {
            image = &emitted;
            const auto factor = numbers_at(json, "emissiveFactor", 3).value_or(std::vector<double>{0, 0, 0});
            color = {factor[0], factor[1], factor[2], 1.0};
        }
        if (*std::min_element(color.begin(), color.end()) < 0.0 || *std::max_element(color.begin(), color.end()) > 1.0)
            findings_.add(make_finding("SB405", where, "baseColorFactor is outside 0 to 1; clamped."));
        Material stated;
        stated.name = material.name;
        for (int c = 0; c < 3; ++c)
            stated.albedo[c] = static_cast<float>(std::clamp(color[static_cast<std::size_t>(c)], 0.0, 1.0));
        if (text_at(json, "alphaMode") == "BLEND" && color[3] < 1.0) {
            stated.transparency = static_cast<float>(1.0 - std::clamp(color[3], 0.0, 1.0));
            findings_.add(make_finding("SB406", where,
                                       fmt::format("material is {:.0f} % transparent; taken as opaque.",
                                                   100.0 * static_cast<double>(stated.transparency))));
        }
        material.material = MaterialId(result_.materials.size());
        result_.materials.push_back(std::move(stated));
        if (!image->is_null()) read_texture(*image, material, where);
    }

    void read_texture(const GltfJson& info, GltfMaterial& material, const std::string& where) {
        const GltfJson& json = entry(document_.json(), "textures", index_or(info, "index", ~std::size_t{0}));
        material.uv_set = index_or(info, "texCoord", 0);
        const GltfJson& transform = member(member(info, "extensions"), "KHR_texture_transform");
        material.uv_set = index_or(transform, "texCoord", material.uv_set);
        const auto offset = numbers_at(transform, "offset", 2).value_or(std::vector<double>{0, 0});
        const auto scale = numbers_at(transform, "scale", 2).value_or(std::vector<double>{1, 1});
        const GltfJson& rotation = member(transform, "rotation");
        const double angle = rotation.is_number() ? rotation.get<double>() : 0.0;
        const double c = std::cos(angle), s = std::sin(angle);
        material.uv_transform = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};

        Texture texture;
        if (const auto sampler = index_at(json, "sampler")) {
            const std::size_t wrap = index_or(entry(document_.json(), "samplers", *sampler), "wrapS", 0);
            if (wrap == kClampToEdge) texture.wrap = TextureWrap::clamp;
            if (wrap == kMirroredRepeat) texture.wrap = TextureWrap::mirror;
        }
        const std::optional<std::size_t> source = index_at(json, "source");
        if (!source) {
            findings_.add(
                make_finding("SB408", where, "its image is neither PNG nor JPEG; the base colour is used without it."));
            return;
        }
        read_image(*source, texture, where);
        material.texture = TextureId(result_.textures.size());
        result_.textures.push_back(std::move(texture));
    }

    void read_image(std::size_t index, Texture& texture, const std::string& where) {
        if (const auto known = embedded_.find(index); known != embedded_.end()) {
            texture.uri = known->second.uri;
            texture.embedded = known->second.embedded;
            return;
        }
        const GltfJson& json = entry(document_.json(), "images", index);
        const std::string uri = text_at(json, "uri");
        std::shared_ptr<std::vector<std::uint8_t>> bytes;
        if (const auto view = index_at(json, "bufferView")) {
            const Bytes encoded = document_.view(*view);
            embedded_bytes_ += encoded.size();
            if (embedded_bytes_ > document_.byte_count())
                throw GltfFault("its images name the same bytes again and again");
            bytes = std::make_shared<std::vector<std::uint8_t>>(encoded.begin(), encoded.end());
        } else if (uri.substr(0, 5) == "data:") {
            bytes = std::make_shared<std::vector<std::uint8_t>>(decode_data_uri(uri));
        } else {
            texture.uri = decode_percent(uri);
            find_image(texture, document_.folder(), where, findings_);
            return;
        }
        ContentHash hash;
        hash.add({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
        texture.uri = fmt::format("{}#{:016x}", name_, hash.value());
        texture.embedded = std::move(bytes);
        embedded_.emplace(index, texture);
    }

    const GltfDocument& document_;
    std::string name_;
    FindingLog& findings_;
    std::map<std::size_t, Texture> embedded_;  // by the number of their image, which many materials may show
    std::uint64_t embedded_bytes_ = 0;
    GltfAppearance result_;
};

}  // namespace

GltfAppearance read_appearance(const GltfDocument& document, const std::string& name, FindingLog& findings) {
    return AppearanceReader(document, name, findings).read();
}

}  // namespace skybake::io
