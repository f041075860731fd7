#include "io/lamps/write_town_lamps.h"

#include <nlohmann/json.hpp>

#include "io/file/replace_file.h"

namespace skybake::io {

void write_town_lamps(const std::filesystem::path& path, std::span<const StreetLamp> lamps) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const StreetLamp& lamp : lamps) {
        list.push_back({{"id", lamp.id},
                        {"type", "spot"},
                        {"position", {lamp.position.x, lamp.position.y, lamp.position.z}},
                        {"direction", {0, 0, -1}},
                        {"cone_half_angle_deg", 105},
                        {"blend_deg", 45},
                        {"flux_lm", lamp.flux_lm},
                        {"color_temperature_k", lamp.color_temperature_k}});
    }
    FileReplacement file(path);
    file.write(nlohmann::ordered_json{{"lamps", list}}.dump(1) + "\n");
    file.commit();
}

}  // namespace skybake::io
