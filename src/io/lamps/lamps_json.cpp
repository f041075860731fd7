#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "base/error.h"
#include "io/lamps/lamp_json.h"
#include "io/photometry/read_profile.h"

namespace skybake::io {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 11> kKeys{"id",
                                                 "type",
                                                 "position",
                                                 "intensity_cd",
                                                 "flux_lm",
                                                 "direction",
                                                 "blend_deg",
                                                 "cone_half_angle_deg",
                                                 "color_temperature_k",
                                                 "profile",
                                                 "c0_direction"};

/// Each file of a profile is read once.
using Profiles = std::map<std::filesystem::path, std::shared_ptr<const LightProfile>>;

/// One lamp of the file; every fault names the place.
class LampReader {
  public:
    LampReader(const Json& json, std::string where, std::filesystem::path folder, Profiles& profiles)
        : json_(json), where_(std::move(where)), folder_(std::move(folder)), profiles_(profiles) {
        if (!json.is_object()) fail("is no object");
        for (const auto& [key, value] : json.items()) {
            if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
                fail(fmt::format("has the unknown key '{}'", key));
        }
    }

    Lamp read(const Vec3d& origin) const {
        Lamp lamp;
        lamp.id = text("id");
        lamp.type = type();
        lamp.position = Vec3f(vector("position") - origin);
        const bool is_spot = lamp.type == Lamp::Type::spot, is_profile = lamp.type == Lamp::Type::profile;
        refuse_unless(is_spot, {"blend_deg", "cone_half_angle_deg"}, "only a spot has");
        refuse_unless(is_profile, {"profile", "c0_direction"}, "only a profile has");
        refuse_unless(is_spot || is_profile, {"direction"}, "a point has not");
        if (is_spot) read_cone(lamp);
        if (is_profile) read_profile(lamp);
        if (json_.contains("intensity_cd") && json_.contains("flux_lm")) fail("has both 'intensity_cd' and 'flux_lm'");
        double candela = is_profile ? lamp.profile->peak_cd() : 0.0;
        if (json_.contains("intensity_cd")) {
            candela = number("intensity_cd", 0.0, 1e12);
        } else if (json_.contains("flux_lm")) {
            candela = number("flux_lm", 0.0, 1e12) / effective_solid_angle(lamp);
        } else if (!is_profile) {
            fail("needs one of 'intensity_cd' and 'flux_lm'");
        }
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
    Lamp::Type type() const {
        const std::string type = text("type");
        if (type == "point") return Lamp::Type::point;
        if (type == "spot") return Lamp::Type::spot;
        if (type == "profile") return Lamp::Type::profile;
        fail(fmt::format("has the type '{}', not point, spot or profile", type));
    }
    void refuse_unless(bool is_its_kind, std::initializer_list<const char*> keys, const char* who) const {
        for (const char* key : keys) {
            if (!is_its_kind && json_.contains(key)) fail(fmt::format("has '{}', which {}", key, who));
        }
    }
    Vec3f unit(const char* key) const {
        const Vec3d direction = vector(key);
        if (!(glm::length(direction) > 0.0)) fail(fmt::format("has a {} without length", key));
        return Vec3f(glm::normalize(direction));
    }
    void read_cone(Lamp& lamp) const {
        lamp.axis = unit("direction");
        const double half = number("cone_half_angle_deg", 0.01, 180.0);
        const double blend = json_.contains("blend_deg") ? number("blend_deg", 0.0, half) : 0.0;
        lamp.cone_half_angle_rad = static_cast<float>(radians_from_degrees(half));
        lamp.blend_rad = static_cast<float>(radians_from_degrees(blend));
    }
    void read_profile(Lamp& lamp) const {
        if (json_.contains("direction")) lamp.axis = unit("direction");
        const Vec3f c_zero = json_.contains("c0_direction") ? unit("c0_direction") : Vec3f(1.0f, 0.0f, 0.0f);
        const Vec3f across = c_zero - glm::dot(c_zero, lamp.axis) * lamp.axis;
        if (!(glm::length(across) > 1e-3f)) fail("has a c0_direction along its direction");
        lamp.c_zero = glm::normalize(across);
        const std::filesystem::path file = folder_ / text("profile");
        std::shared_ptr<const LightProfile>& profile = profiles_[file];
        if (!profile) profile = std::make_shared<const LightProfile>(io::read_profile(file));
        lamp.profile = profile;
    }
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
    std::filesystem::path folder_;  // of the lamps' file
    Profiles& profiles_;
};

}  // namespace

LampFile lamps_of_json(const Json& file, const std::filesystem::path& path, const Vec3d& origin) {
    if (!file.is_object() || !file.contains("lamps") || !file["lamps"].is_array())
        throw InputError(fmt::format("{}: has no list 'lamps'. Write it as docs/formats.md shows.", path.string()));
    LampFile read;
    Profiles profiles;
    std::set<std::string> ids;
    for (std::size_t i = 0; i < file["lamps"].size(); ++i) {
        const LampReader reader(file["lamps"][i], fmt::format("{}: lamp {}", path.string(), i + 1), path.parent_path(),
                                profiles);
        read.lamps.push_back(reader.read(origin));
        if (!ids.insert(read.lamps.back().id).second)
            reader.fail(fmt::format("has the id '{}' of another lamp", read.lamps.back().id));
    }
    read.files.push_back(path);
    for (const auto& [name, profile] : profiles) read.files.push_back(name);
    return read;
}

}  // namespace skybake::io
