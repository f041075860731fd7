#include "io/study/study_city_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/cityjson/write_city_json.h"

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;

/// Six digits: what the tables have, too.
double rounded(double value) {
    return std::stod(fmt::format("{:.6g}", value));
}

void put_results(Json& attributes, const Rule& rule, const Study& study, const Group& group) {
    for (std::size_t c = 0; c < study.columns.size(); ++c) {
        const std::string name = fmt::format("skybake_{}", study.columns[c].name);
        attributes[name] = rounded(group.columns[c].mean);
        attributes[name + "_least"] = rounded(group.columns[c].least);
        attributes[name + "_greatest"] = rounded(group.columns[c].greatest);
    }
    for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
        if (group.criteria[c].verdict == Verdict::none) continue;
        const std::string name = fmt::format("skybake_{}", rule.criteria[c].id);
        attributes[name] = name_of(group.criteria[c].verdict);
        attributes[name + "_area_pass"] = rounded(group.criteria[c].area_pass);
    }
}

/// The group that tells of a receiver's surface: the façade's of all storeys, or the receiver's own.
std::string surface_group(ReceiverKind kind, const Receiver& receiver) {
    return kind == ReceiverKind::facade ? fmt::format("{}/{}", receiver.object_id, *receiver.surface) : receiver.id;
}

SurfaceType type_of(ReceiverKind kind) {
    return kind == ReceiverKind::roof     ? SurfaceType::roof
           : kind == ReceiverKind::window ? SurfaceType::window
                                          : SurfaceType::wall;
}

SurfaceNotes surface_notes(const Rule& rule, const Study& study, const std::vector<Group>& groups) {
    std::unordered_map<std::string, const Group*> by_id[3];  // roofs, façades, windows
    const auto place_of = [](ReceiverKind kind) {
        return static_cast<int>(kind) - static_cast<int>(ReceiverKind::roof);
    };
    const auto is_of_surfaces = [](ReceiverKind kind) {
        return kind == ReceiverKind::roof || kind == ReceiverKind::facade || kind == ReceiverKind::window;
    };
    for (const Group& group : groups) {
        const Level level = group.kind == ReceiverKind::facade ? Level::facade : Level::receiver;
        if (is_of_surfaces(group.kind) && group.level == level) by_id[place_of(group.kind)][group.id] = &group;
    }
    SurfaceNotes notes;
    for (const Receiver& receiver : study.receivers.receivers) {
        if (!is_of_surfaces(receiver.kind)) continue;
        const auto& known = by_id[place_of(receiver.kind)];
        const auto group = known.find(surface_group(receiver.kind, receiver));
        if (group == known.end() || notes[receiver.object_id].contains(receiver.polygons.front())) continue;
        Json attributes = {{"skybake_id", group->second->id}};
        put_results(attributes, rule, study, *group->second);
        std::string members = attributes.dump();
        members = members.substr(1, members.size() - 2);  // within the semantic object's own braces
        for (const std::uint32_t polygon : receiver.polygons)
            notes[receiver.object_id][polygon] = {type_of(receiver.kind), members};
    }
    return notes;
}

}  // namespace

void write_study_city(CityModel city, const std::filesystem::path& path, const Rule& rule, const Study& study,
                      const std::vector<Group>& groups) {
    std::unordered_map<std::string, const Group*> buildings;
    for (const Group& group : groups) {
        if (group.level == Level::building) buildings[group.id] = &group;
    }
    for (CityObject& object : city.objects) {
        for (Surface& surface : object.geometry.surfaces) surface.texture.reset();
        object.geometry.corner_uv.clear();
        const auto group = buildings.find(object.id);
        if (group == buildings.end()) continue;
        Json attributes = Json::parse(object.attributes_json, nullptr, false);
        if (!attributes.is_object()) attributes = Json::object();
        attributes["skybake_rule"] = fmt::format("{} {}", rule.id, rule.version);
        if (group->second->verdict != Verdict::none) attributes["skybake_verdict"] = name_of(group->second->verdict);
        put_results(attributes, rule, study, *group->second);
        object.attributes_json = attributes.dump();
    }
    city.textures.clear();
    write_city_json(city, path, surface_notes(rule, study, groups));
}

}  // namespace skybake::io
