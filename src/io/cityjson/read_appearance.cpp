#include "io/cityjson/read_appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "city/finding_codes.h"
#include "io/assembly/local_image.h"

namespace skybake::io {
namespace {

using simdjson::dom::element;

std::string string_at(element object, std::string_view key) {
    std::string_view value;
    return object[key].get_string().get(value) == simdjson::SUCCESS ? std::string(value) : std::string();
}

/// Three or four numbers; none when there are fewer or other things.
std::optional<std::array<double, 4>> color_at(element object, std::string_view key) {
    simdjson::dom::array array;
    if (object[key].get_array().get(array) != simdjson::SUCCESS) return std::nullopt;
    std::array<double, 4> color{0.0, 0.0, 0.0, 1.0};
    std::size_t count = 0;
    for (const element e : array) {
        double value = 0.0;
        if (count >= 4 || e.get_double().get(value) != simdjson::SUCCESS) return std::nullopt;
        color[count++] = value;
    }
    return count >= 3 ? std::optional(color) : std::nullopt;
}

Material read_material(element e, const std::string& where, FindingLog& findings) {
    Material material;
    material.name = string_at(e, "name");
    if (const auto color = color_at(e, "diffuseColor")) {
        const auto is_inside = [](double v) { return v >= 0.0 && v <= 1.0; };
        if (!std::all_of(color->begin(), color->begin() + 3, is_inside)) {
            findings.add(make_finding("SB405", where,
                                      fmt::format("diffuseColor {}, {}, {} is outside 0 to 1; clamped.", (*color)[0],
                                                  (*color)[1], (*color)[2])));
        }
        material.albedo = linear_from_display((*color)[0], (*color)[1], (*color)[2]);
    }
    double transparency = 0.0;
    if (e["transparency"].get_double().get(transparency) == simdjson::SUCCESS) {
        material.transparency = static_cast<float>(std::clamp(transparency, 0.0, 1.0));
    }
    if (material.transparency > 0.0f) {
        findings.add(make_finding(
            "SB406", where,
            fmt::format("material is {:.0f} % transparent; taken as opaque.", 100.0 * material.transparency)));
    }
    return material;
}

TextureWrap wrap_from(const std::string& mode) {
    if (mode == "mirror") return TextureWrap::mirror;
    if (mode == "clamp") return TextureWrap::clamp;
    if (mode == "border") return TextureWrap::border;
    if (mode == "none") return TextureWrap::none;
    return TextureWrap::repeat;
}

Texture read_texture(element e, const std::filesystem::path& folder, const std::string& where, FindingLog& findings) {
    Texture texture;
    texture.uri = string_at(e, "image");
    texture.wrap = wrap_from(string_at(e, "wrapMode"));
    if (const auto color = color_at(e, "borderColor"))
        texture.border_color = linear_from_display((*color)[0], (*color)[1], (*color)[2]);
    find_image(texture, folder, where, findings);
    return texture;
}

}  // namespace

CityJsonAppearance read_appearance(element appearance, const std::filesystem::path& folder, const std::string& where,
                                   FindingLog& findings) {
    CityJsonAppearance result;
    result.default_material_theme = string_at(appearance, "default-theme-material");
    result.default_texture_theme = string_at(appearance, "default-theme-texture");
    simdjson::dom::array array;
    if (appearance["materials"].get_array().get(array) == simdjson::SUCCESS) {
        for (const element e : array) {
            result.materials.push_back(
                read_material(e, fmt::format("{}/materials/{}", where, result.materials.size()), findings));
        }
    }
    if (appearance["textures"].get_array().get(array) == simdjson::SUCCESS) {
        for (const element e : array) {
            result.textures.push_back(
                read_texture(e, folder, fmt::format("{}/textures/{}", where, result.textures.size()), findings));
        }
    }
    if (appearance["vertices-texture"].get_array().get(array) == simdjson::SUCCESS) {
        result.uvs.reserve(array.size());
        for (const element e : array) {
            double uv[2] = {NAN, NAN};  // a vertex that is no pair of numbers makes the rings that use it untextured
            simdjson::dom::array pair;
            if (e.get_array().get(pair) == simdjson::SUCCESS && pair.size() == 2) {
                std::size_t i = 0;
                for (const element number : pair) {
                    if (number.get_double().get(uv[i++]) != simdjson::SUCCESS) uv[0] = NAN;
                }
            }
            result.uvs.emplace_back(static_cast<float>(uv[0]), static_cast<float>(uv[1]));
        }
    }
    return result;
}

}  // namespace skybake::io
