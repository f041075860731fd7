// Tiny cities whose sun and shadow are known by hand.
#pragma once

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace skybake {

inline constexpr double kX = -67000.0, kY = 215000.0;  // EPSG:31256, Graz's longitude 15.4, latitude 47.07

/// A city of boxes in EPSG:31256, on ground of ±60 m or on none.
inline nlohmann::json box_city(const std::vector<std::pair<std::string, std::array<double, 6>>>& boxes,
                               bool has_ground) {
    nlohmann::json objects = nlohmann::json::object(), vertices = nlohmann::json::array();
    const auto vertex = [&](double x, double y, double z) {
        vertices.push_back({std::llround(x * 1000), std::llround(y * 1000), std::llround(z * 1000)});
    };
    if (has_ground) {
        vertex(-60, -60, 0), vertex(60, -60, 0), vertex(60, 60, 0), vertex(-60, 60, 0);
        objects["ground"] = {
            {"type", "TINRelief"},
            {"geometry", {{{"type", "CompositeSurface"}, {"lod", "1"}, {"boundaries", {{{0, 1, 2}}, {{0, 2, 3}}}}}}}};
    }
    for (const auto& [id, b] : boxes) {
        const int v = static_cast<int>(vertices.size());
        for (const double z : {b[2], b[5]})
            vertex(b[0], b[1], z), vertex(b[3], b[1], z), vertex(b[3], b[4], z), vertex(b[0], b[4], z);
        nlohmann::json faces = nlohmann::json::array();
        for (const std::array<int, 4>& f : {std::array{3, 2, 1, 0}, std::array{4, 5, 6, 7}, std::array{0, 1, 5, 4},
                                            std::array{1, 2, 6, 5}, std::array{2, 3, 7, 6}, std::array{3, 0, 4, 7}})
            faces.push_back({{v + f[0], v + f[1], v + f[2], v + f[3]}});
        objects[id] = {
            {"type", "Building"},
            {"geometry", {{{"type", "Solid"}, {"lod", "1"}, {"boundaries", nlohmann::json::array({faces})}}}}};
    }
    return {{"type", "CityJSON"},
            {"version", "2.0"},
            {"metadata", {{"referenceSystem", "https://www.opengis.net/def/crs/EPSG/0/31256"}}},
            {"transform", {{"scale", {0.001, 0.001, 0.001}}, {"translate", {kX, kY, 0.0}}}},
            {"CityObjects", objects},
            {"vertices", vertices}};
}

}  // namespace skybake
