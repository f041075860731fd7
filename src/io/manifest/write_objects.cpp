#include "io/manifest/write_objects.h"

#include <nlohmann/json.hpp>

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;

Json object_json(const std::string& id, const AttributesOf& attributes) {
    Json json = {{"id", id}};
    const auto stated = attributes.find(id);
    if (stated == attributes.end()) return json;
    Json parsed = Json::parse(stated->second, nullptr, false);
    if (parsed.is_object() && !parsed.empty()) json["attributes"] = std::move(parsed);
    return json;
}

}  // namespace

AttributesOf attributes_of(const CityModel& city) {
    AttributesOf attributes;
    for (const CityObject& object : city.objects) {
        if (object.attributes_json != "{}") attributes.emplace(object.id, object.attributes_json);
    }
    return attributes;
}

std::string objects_json(const Scene& scene, const Atlas& atlas, const AttributesOf& attributes) {
    Json objects = Json::array();
    std::map<std::string, std::size_t> index;
    for (const SceneObject& object : scene.objects) {
        index.emplace(object.id, objects.size());
        Json json = object_json(object.id, attributes);
        json["type"] = name_of(object.type);
        objects.push_back(std::move(json));
    }
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        if (object.building_id == object.id) continue;
        const auto [building, is_new] = index.try_emplace(object.building_id, objects.size());
        if (is_new) objects.push_back(object_json(object.building_id, attributes));
        objects[i]["part_of"] = building->second;
    }
    Json surface_types = Json::array();
    for (int type = 0; type <= static_cast<int>(SurfaceType::other); ++type)
        surface_types.push_back(name_of(static_cast<SurfaceType>(type)));
    Json chart_objects = Json::array();
    Json chart_surfaces = Json::array();
    for (const Chart& chart : atlas.charts) {
        const Face& face = scene.faces[scene.triangle_face[chart.triangles.front()].index()];
        chart_objects.push_back(face.object);
        chart_surfaces.push_back(static_cast<int>(face.type));
    }
    const Json json = {{"format", "skybake-objects"},    {"version", 1},
                       {"objects", std::move(objects)},  {"surface_types", surface_types},
                       {"chart_objects", chart_objects}, {"chart_surfaces", chart_surfaces}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace skybake::io
