// Based on: Wavefront "MTL material format", appendix B1 of the Advanced Visualizer manual.
#include "io/obj/read_mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "city/finding_codes.h"
#include "io/assembly/local_image.h"
#include "io/obj/obj_text.h"

namespace skybake::io {
namespace {

/// The image's name and wrap mode out of "-s 1 1 1 -clamp on name with spaces.jpg".
void read_map(std::string_view text, Texture& texture) {
    std::string_view rest = trim(text);
    while (rest.substr(0, 1) == "-") {
        const std::string_view option = next_word(rest);
        if (option == "-s" || option == "-o" || option == "-t") {
            for (int i = 0; i < 3; ++i) {  // one to three numbers
                std::string_view ahead = rest;
                if (!number_of(next_word(ahead))) break;
                rest = ahead;
            }
        } else if (option == "-mm") {
            next_word(rest);
            next_word(rest);
        } else {
            const std::string_view value = next_word(rest);
            if (option == "-clamp" && value == "on") texture.wrap = TextureWrap::clamp;
        }
        rest = trim(rest);
    }
    texture.uri = trim(rest);
}

}  // namespace

void read_mtl(const std::string& uri, const std::filesystem::path& folder, const std::string& where,
              ObjMaterials& materials, FindingLog& findings) {
    const std::optional<std::filesystem::path> path = path_below(folder, uri);
    if (!path) {
        findings.add(make_finding(
            "SB402", where, fmt::format("material library '{}' lies outside the folder of the file; refused.", uri)));
        return;
    }
    std::error_code error;
    std::ifstream in;
    if (std::filesystem::is_regular_file(*path, error)) in.open(*path, std::ios::binary);
    if (!in.is_open()) {
        findings.add(make_finding(
            "SB404", where, fmt::format("material library '{}' is missing; surfaces take default albedos.", uri)));
        return;
    }
    Material* material = nullptr;
    ObjMaterial* entry = nullptr;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        const std::string place = fmt::format("{}: line {}", path->filename().string(), number);
        std::string_view rest = line;
        const std::string_view word = next_word(rest);
        if (word == "newmtl") {
            materials.materials.emplace_back();
            material = &materials.materials.back();
            material->name = trim(rest);
            entry = &materials.by_name[material->name];
            *entry = {MaterialId(materials.materials.size() - 1), std::nullopt};
        } else if (!material) {
            continue;
        } else if (word == "Kd") {
            const auto r = number_of(next_word(rest)), g = number_of(next_word(rest)), b = number_of(next_word(rest));
            if (!r) continue;  // a spectrum in a file of its own
            const Vec3d color(*r, g.value_or(*r), b.value_or(*r));
            if (std::min({color.x, color.y, color.z}) < 0.0 || std::max({color.x, color.y, color.z}) > 1.0) {
                findings.add(
                    make_finding("SB405", place,
                                 fmt::format("Kd {}, {}, {} is outside 0 to 1; clamped.", color.x, color.y, color.z)));
            }
            material->albedo = linear_from_display(color.x, color.y, color.z);
        } else if (word == "d" || word == "Tr") {
            const std::optional<double> value = number_of(next_word(rest));
            if (!value) continue;
            const double transparency = std::clamp(word == "d" ? 1.0 - *value : *value, 0.0, 1.0);
            material->transparency = static_cast<float>(transparency);
            if (transparency > 0.0) {
                findings.add(make_finding(
                    "SB406", place,
                    fmt::format("material is {:.0f} % transparent; taken as opaque.", 100.0 * transparency)));
            }
        } else if (word == "map_Kd") {
            Texture texture;
            read_map(rest, texture);
            find_image(texture, path->parent_path(), place, findings);
            entry->texture = TextureId(materials.textures.size());
            materials.textures.push_back(std::move(texture));
        }
    }
}

}  // namespace skybake::io
