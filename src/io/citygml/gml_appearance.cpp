// Based on: OGC City Geography Markup Language (CityGML) 2.0, OGC 12-019, clause 9 (appearance); 3.0: OGC 21-006r2.
#include "io/citygml/gml_appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/hash_rng.h"
#include "city/finding_codes.h"
#include "io/assembly/local_image.h"
#include "io/citygml/gml_numbers.h"
#include "io/image/image.h"

namespace skybake::io {
namespace {

std::vector<double> numbers_of(XmlElement e) {
    std::vector<double> numbers;
    if (!e || !read_numbers(e.text(), numbers)) numbers.clear();
    return numbers;
}

TextureWrap wrap_from(std::string_view mode) {
    if (mode == "none") return TextureWrap::none;
    if (mode == "mirror") return TextureWrap::mirror;
    if (mode == "clamp") return TextureWrap::clamp;
    if (mode == "border") return TextureWrap::border;
    return TextureWrap::repeat;
}

bool is_front(XmlElement data) {
    const XmlElement e = data.child("isFront");
    return !e || (e.text() != "false" && e.text() != "0");
}

/// The ids that a surface data element is put on: in attributes or texts of `target`.
std::vector<std::string_view> targets_of(XmlElement data) {
    std::vector<std::string_view> ids;
    data.for_each_child([&](XmlElement e) {
        if (e.name() != "target") return;
        std::string_view reference = e.attribute("uri");
        if (reference.empty()) reference = e.attribute("href");
        if (reference.empty()) reference = e.text();
        if (const std::string_view id = local_id(reference); !id.empty()) ids.push_back(id);
    });
    return ids;
}

/// From a pixel's centre (column, row) to the place on the map: x = a column + b row + x0, y = c column + d row + y0.
struct PixelToMap {
    double a = 0, b = 0, x0 = 0, c = 0, d = 0, y0 = 0;
};

/// The six numbers of a world file beside the image ("roof.jgw", "roof.jpgw", "roof.wld").
std::optional<PixelToMap> read_world_file(const std::filesystem::path& image) {
    const std::string extension = image.extension().string();
    std::vector<std::string> endings{extension + "w", ".wld"};
    if (extension.size() >= 3) endings.insert(endings.begin(), {'.', extension[1], extension.back(), 'w'});
    for (const std::string& ending : endings) {
        std::filesystem::path path = image;
        path.replace_extension(ending);
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error)) continue;
        std::ifstream in(path);
        std::array<double, 6> v{};
        bool is_whole = in.is_open();
        for (double& value : v) is_whole = is_whole && static_cast<bool>(in >> value);
        if (is_whole) return PixelToMap{v[0], v[2], v[4], v[1], v[3], v[5]};
    }
    return std::nullopt;
}

}  // namespace

std::string_view local_id(std::string_view reference) {
    if (!reference.empty() && reference.front() == '#') return reference.substr(1);
    return reference.find_first_of("#/") == std::string_view::npos ? reference : std::string_view();
}

bool GmlAppearance::Themes::admits(const std::string& theme) {
    if (std::find(names.begin(), names.end(), theme) == names.end()) names.push_back(theme);
    return names.front() == theme;
}

std::string GmlAppearance::place(XmlElement e) const {
    return fmt::format("{}: line {}: {}", file_, e.line(), e.name());
}

void GmlAppearance::add(XmlElement data, const std::string& theme, FindingLog& findings) {
    if (data.name() == "X3DMaterial") {
        if (material_themes_.admits(theme)) add_material(data, findings);
    } else if (data.name() == "ParameterizedTexture") {
        if (texture_themes_.admits(theme)) add_parameterized(data, findings);
    } else if (data.name() == "GeoreferencedTexture") {
        if (texture_themes_.admits(theme)) add_georeferenced(data, findings);
    }
}

void GmlAppearance::finish(FindingLog& findings) const {
    const auto tell = [&](const Themes& themes, std::string_view what) {
        if (themes.names.size() > 1) {
            findings.add(make_finding(
                "SB407", file_,
                fmt::format("{} have {} themes; '{}' is used.", what, themes.names.size(), themes.names.front())));
        }
    };
    tell(material_themes_, "materials");
    tell(texture_themes_, "textures");
}

const RingTexture* GmlAppearance::ring(std::string_view id) const {
    const auto found = rings_.find(hash_of(id));
    return found == rings_.end() ? nullptr : &found->second;
}

const SurfaceWear* GmlAppearance::surface(std::string_view id) const {
    const auto found = surfaces_.find(hash_of(id));
    return found == surfaces_.end() ? nullptr : &found->second;
}

void GmlAppearance::add_material(XmlElement data, FindingLog& findings) {
    Material material;
    material.name = data.attribute("id");
    if (const std::vector<double> color = numbers_of(data.child("diffuseColor")); color.size() >= 3) {
        const bool is_inside =
            std::all_of(color.begin(), color.begin() + 3, [](double v) { return v >= 0.0 && v <= 1.0; });
        if (!is_inside) {
            findings.add(make_finding(
                "SB405", place(data),
                fmt::format("diffuseColor {}, {}, {} is outside 0 to 1; clamped.", color[0], color[1], color[2])));
        }
        material.albedo = linear_from_display(color[0], color[1], color[2]);
    } else {
        const float grey = linear_from_srgb(0.8f);  // X3D's default diffuse colour
        material.albedo = Rgb(grey);
    }
    if (const std::vector<double> value = numbers_of(data.child("transparency")); value.size() == 1)
        material.transparency = static_cast<float>(std::clamp(value[0], 0.0, 1.0));
    if (material.transparency > 0.0f) {
        findings.add(make_finding(
            "SB406", place(data),
            fmt::format("material is {:.0f} % transparent; taken as opaque.", 100.0 * material.transparency)));
    }
    const MaterialId id(materials.size());
    materials.push_back(std::move(material));
    const bool front = is_front(data);
    for (const std::string_view target : targets_of(data)) {
        SurfaceWear& wear = surfaces_[hash_of(target)];
        if (wear.material && (wear.is_material_front || !front)) continue;
        wear.material = id;
        wear.is_material_front = front;
    }
}

Texture GmlAppearance::read_texture(XmlElement data, FindingLog& findings) const {
    Texture texture;
    if (const XmlElement uri = data.child("imageURI")) texture.uri = uri.text();
    if (const XmlElement wrap = data.child("wrapMode")) texture.wrap = wrap_from(wrap.text());
    if (const std::vector<double> color = numbers_of(data.child("borderColor")); color.size() >= 3)
        texture.border_color = linear_from_display(color[0], color[1], color[2]);
    find_image(texture, folder_, place(data), findings);
    return texture;
}

void GmlAppearance::add_coordinates(XmlElement list, TextureId texture, bool front, FindingLog& findings) {
    // 2.0 names the ring in an attribute, 3.0 in an element that follows the coordinates.
    std::vector<XmlElement> coordinates;
    std::vector<std::string_view> rings;
    list.for_each_child([&](XmlElement e) {
        if (e.name() == "textureCoordinates") {
            coordinates.push_back(e);
            if (const std::string_view ring = e.attribute("ring"); !ring.empty()) rings.push_back(ring);
        } else if (e.name() == "ring") {
            rings.push_back(e.text());
        }
    });
    std::vector<double> numbers;
    for (std::size_t i = 0; i < std::min(coordinates.size(), rings.size()); ++i) {
        numbers.clear();
        const bool is_list = read_numbers(coordinates[i].text(), numbers) && numbers.size() % 2 == 0;
        const bool is_finite = std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
        if (!is_list || !is_finite) {
            findings.add(make_finding("SB403", place(coordinates[i]),
                                      "its texture coordinates are no pairs of numbers; the surface is taken without "
                                      "texture."));
            continue;
        }
        const auto [entry, is_new] = rings_.try_emplace(hash_of(local_id(rings[i])));
        if (!is_new && (entry->second.is_front || !front)) continue;
        entry->second = {texture, uvs_.size(), static_cast<std::uint32_t>(numbers.size() / 2), front};
        for (std::size_t k = 0; k + 1 < numbers.size(); k += 2)
            uvs_.emplace_back(static_cast<float>(numbers[k]), static_cast<float>(numbers[k + 1]));
    }
}

void GmlAppearance::put_projected(std::string_view target, std::uint32_t number, bool front) {
    SurfaceWear& wear = surfaces_[hash_of(target)];
    if (wear.projected && (wear.is_texture_front || !front)) return;
    wear.projected = number;
    wear.is_texture_front = front;
}

void GmlAppearance::add_parameterized(XmlElement data, FindingLog& findings) {
    const TextureId texture(textures.size());
    textures.push_back(read_texture(data, findings));
    const bool front = is_front(data);
    const auto add_parameters = [&](XmlElement parameters, std::string_view target) {
        if (!parameters) return;
        if (parameters.name() == "TexCoordList") {
            add_coordinates(parameters, texture, front, findings);
        } else if (parameters.name() == "TexCoordGen") {
            const std::vector<double> m = numbers_of(parameters.child("worldToTexture"));
            if (m.size() != 12 || target.empty()) {
                findings.add(make_finding("SB403", place(parameters),
                                          "worldToTexture is not 12 numbers of a matrix; the surface is taken without "
                                          "texture."));
                return;
            }
            ProjectedTexture projected{texture, {}};
            std::copy(m.begin(), m.end(), projected.m.begin());
            put_projected(target, static_cast<std::uint32_t>(projected_.size()), front);
            projected_.push_back(projected);
        }
    };
    data.for_each_child([&](XmlElement e) {
        if (e.name() == "target") {
            std::string_view target = e.attribute("uri");
            add_parameters(e.first_child(), local_id(target));
        } else if (e.name() == "textureParameterization") {  // 3.0
            const XmlElement association = e.child("TextureAssociation");
            if (!association) return;
            const XmlElement target = association.child("target");
            const XmlElement parameters = association.child("textureParameterization");
            if (parameters) add_parameters(parameters.first_child(), target ? local_id(target.text()) : "");
        }
    });
}

void GmlAppearance::add_georeferenced(XmlElement data, FindingLog& findings) {
    const TextureId texture(textures.size());
    textures.push_back(read_texture(data, findings));
    if (textures.back().is_missing) return;
    const std::filesystem::path image = textures.back().path;
    std::optional<PixelToMap> map;
    const XmlElement prefers = data.child("preferWorldFile");
    if (!prefers || (prefers.text() != "false" && prefers.text() != "0")) map = read_world_file(image);
    if (!map) {
        const std::vector<double> matrix = numbers_of(data.child("orientation"));
        std::vector<double> point;
        if (const XmlElement holder = data.child("referencePoint")) {
            if (const XmlElement p = holder.child("Point")) point = numbers_of(p.child("pos"));
        }
        if (matrix.size() == 4 && point.size() >= 2)
            map = PixelToMap{matrix[0], matrix[1], point[0], matrix[2], matrix[3], point[1]};
    }
    if (!map) map = read_world_file(image);
    const std::optional<ImageSize> size = image_size(image);
    const double det = map ? map->a * map->d - map->b * map->c : 0.0;
    if (!size || size->width <= 0 || size->height <= 0 || det == 0.0 || !std::isfinite(det)) {
        findings.add(make_finding("SB403", place(data),
                                  fmt::format("image '{}' has no place on the map (no world file, nor reference point "
                                              "and orientation); its surfaces are taken without texture.",
                                              textures.back().uri)));
        return;
    }
    // column = (d (x - x0) - b (y - y0)) / det, row = (a (y - y0) - c (x - x0)) / det; u and v count from the lower
    // left.
    const double w = size->width, h = size->height;
    ProjectedTexture projected{texture, {}};
    projected.m = {map->d / (det * w),
                   -map->b / (det * w),
                   0.0,
                   ((-map->d * map->x0 + map->b * map->y0) / det + 0.5) / w,
                   map->c / (det * h),
                   -map->a / (det * h),
                   0.0,
                   1.0 - ((-map->a * map->y0 + map->c * map->x0) / det + 0.5) / h,
                   0.0,
                   0.0,
                   0.0,
                   1.0};
    const auto number = static_cast<std::uint32_t>(projected_.size());
    projected_.push_back(projected);
    for (const std::string_view target : targets_of(data)) put_projected(target, number, is_front(data));
}

}  // namespace skybake::io
