#include "io/cityjson/place_pictures.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "io/file/replace_file.h"
#include "io/image/image.h"

namespace skybake::io {
namespace {

namespace fs = std::filesystem;

/// "town" of "out/town.city.json".
std::string stem_of(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.substr(0, name.find('.'));
}

const char* extension_of(const std::vector<std::uint8_t>& bytes) {
    return image_format(bytes) == ImageFormat::jpeg ? ".jpg" : ".png";
}

}  // namespace

void place_pictures(CityModel& city, const fs::path& city_file) {
    const fs::path folder = fs::weakly_canonical(fs::absolute(city_file)).parent_path();
    const std::string copies = stem_of(city_file) + "_textures";
    std::map<std::string, std::string> placed;  // new names by path, or by the name of embedded content
    for (Texture& texture : city.textures) {
        if (texture.is_missing) continue;
        const auto [entry, is_new] = placed.try_emplace(texture.embedded ? texture.uri : texture.path);
        if (is_new) {
            const fs::path below = texture.embedded
                                       ? fs::path()
                                       : fs::weakly_canonical(fs::absolute(texture.path)).lexically_relative(folder);
            if (!below.empty() && *below.begin() != "..") {
                entry->second = below.generic_string();
            } else {
                const std::vector<std::uint8_t> bytes = texture.embedded ? *texture.embedded : read_file(texture.path);
                fs::create_directories(folder / copies);
                entry->second = fmt::format("{}/{:04}{}", copies, placed.size(), extension_of(bytes));
                write_file(folder / entry->second, bytes);
            }
        }
        texture.uri = entry->second;
        texture.path = (folder / entry->second).string();
        texture.embedded = nullptr;
    }
}

}  // namespace skybake::io
