#include "io/lamps/lamps_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/error.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 9> kKeys{"id",
                                                "type",
                                                "position",
                                                "intensity_cd",
                                                "flux_lm",
                                                "direction",
                                                "blend_deg",
                                                "cone_half_angle_deg",
                                                "color_temperature_k"};

/// One lamp of the file; every fault names the place.
class LampReader {
  public:
    LampReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
        if (!json.is_object()) fail("is no object");
        for (const auto& [key, value] : json.items()) {
            if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
                fail(fmt::format("has the unknown key '{}'", key));
        }
    }

    Lamp read(const Vec3d& origin) const {
        Lamp lamp;
        lamp.id = text("id");
        const std::string type = text("type");
        if (type != "point" && type != "spot") fail(fmt::format("has the type '{}', not point or spot", type));
        lamp.type = type == "point" ? Lamp::Type::point : Lamp::Type::spot;
        lamp.position = Vec3f(vector("position") - origin);
        if (lamp.type == Lamp::Type::spot) {
            const Vec3d direction = vector("direction");
            if (!(glm::length(direction) > 0.0)) fail("has a direction without length");
            lamp.axis = Vec3f(glm::normalize(direction));
            const double half = number("cone_half_angle_deg", 0.01, 180.0);
            const double blend = json_.contains("blend_deg") ? number("blend_deg", 0.0, half) : 0.0;
            lamp.cone_half_angle_rad = static_cast<float>(radians_from_degrees(half));
            lamp.blend_rad = static_cast<float>(radians_from_degrees(blend));
        } else {
            for (const char* key : {"direction", "blend_deg", "cone_half_angle_deg"}) {
                if (json_.contains(key)) fail(fmt::format("is a point and has '{}', which only a spot has", key));
            }
        }
        if (json_.contains("intensity_cd") == json_.contains("flux_lm"))
            fail("needs one of 'intensity_cd' and 'flux_lm'");
        const double candela = json_.contains("intensity_cd")
                                   ? number("intensity_cd", 0.0, 1e12)
                                   : number("flux_lm", 0.0, 1e12) / effective_solid_angle(lamp);
        const Rgb colour = json_.contains("color_temperature_k")
                               ? black_body_colour(number("color_temperature_k", 1000.0, 40000.0))
                               : Rgb(1.0f);
        lamp.intensity = static_cast<float>(candela) * colour;
        return lamp;
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}. Write it as docs/formats.md shows.", where_, what));
    }

  private:
    std::string text(const char* key) const {
        if (!json_.contains(key) || !json_[key].is_string()) fail(fmt::format("needs the text '{}'", key));
        return json_[key];
    }
    double number(const char* key, double lowest, double highest) const {
        if (!json_.contains(key) || !json_[key].is_number()) fail(fmt::format("needs the number '{}'", key));
        const double value = json_[key];
        if (!(value >= lowest && value <= highest))
            fail(fmt::format("has '{}' of {}, not within {} and {}", key, value, lowest, highest));
        return value;
    }
    Vec3d vector(const char* key) const {
        if (!json_.contains(key) || !json_[key].is_array() || json_[key].size() != 3)
            fail(fmt::format("needs '{}' of three numbers", key));
        Vec3d value(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const Json& item = json_[key][static_cast<std::size_t>(axis)];
            if (!item.is_number()) fail(fmt::format("needs '{}' of three numbers", key));
            value[axis] = item;
        }
        return value;
    }

    const Json& json_;
    std::string where_;
};

}  // namespace

std::vector<Lamp> read_lamps(const std::filesystem::path& path, const Vec3d& origin) {
    const std::vector<std::uint8_t> bytes = read_file(path);
    Json file;
    try {
        file = Json::parse(bytes.begin(), bytes.end());
    } catch (const Json::parse_error& error) {
        throw InputError(fmt::format("{}: is no JSON: {}", path.string(), error.what()));
    }
    if (!file.is_object() || !file.contains("lamps") || !file["lamps"].is_array())
        throw InputError(fmt::format("{}: has no list 'lamps'. Write it as docs/formats.md shows.", path.string()));
    std::vector<Lamp> lamps;
    std::set<std::string> ids;
    for (std::size_t i = 0; i < file["lamps"].size(); ++i) {
        const LampReader reader(file["lamps"][i], fmt::format("{}: lamp {}", path.string(), i + 1));
        lamps.push_back(reader.read(origin));
        if (!ids.insert(lamps.back().id).second)
            reader.fail(fmt::format("has the id '{}' of another lamp", lamps.back().id));
    }
    return lamps;
}

}  // namespace skybake::io
