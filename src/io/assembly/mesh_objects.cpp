#include "io/assembly/mesh_objects.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "city/polygon.h"

namespace skybake::io {
namespace {

/// A mesh states no LoD; it counts as a body.
constexpr int kMeshLod = 1;

/// True for a surface of heights: nearly all of it faces up. Empirical, on meshes of Lyon: terrain has 5 % of steep
/// area and 3 % that faces down, buildings, open ones too, have 37 % of steep area and more.
bool is_terrain(const Geometry& geometry) {
    double up = 0.0, down = 0.0, steep = 0.0, all = 0.0;
    for (const Surface& surface : geometry.surfaces) {
        const Vec3d area = surface_area_vector(geometry, surface);
        const double length = glm::length(area);
        if (!std::isfinite(length)) continue;
        all += length;
        if (std::abs(area.z) < 0.2588 * length) steep += length;  // 75°, as for walls
        (area.z > 0.0 ? up : down) += std::abs(area.z);
    }
    return up > 0.0 && down <= 0.05 * up && steep <= 0.2 * all;
}

}  // namespace

std::optional<ObjectTerm> term_of_material(std::string_view name) {
    static constexpr std::array kMore{
        ObjectTerm{"Terrain", ObjectType::terrain},
        ObjectTerm{"Ground", ObjectType::terrain},
        ObjectTerm{"Water", ObjectType::water},
        ObjectTerm{"Forest", ObjectType::plant_cover},
        ObjectTerm{"Vegetation", ObjectType::plant_cover},
        ObjectTerm{"Separation", ObjectType::other},
    };
    constexpr std::string_view kWall = "Wall";
    if (name.size() > kWall.size() && name.ends_with(kWall)) name.remove_suffix(kWall.size());
    for (const ObjectTerm& term : kMore) {
        if (term.name == name) return term;
    }
    const std::optional<ObjectTerm> term = object_term(name);
    return term && !term->is_interior ? term : std::nullopt;
}

MeshObject& MeshObjects::at(const std::string& name, const std::optional<ObjectTerm>& term, const std::string& place) {
    const ObjectType type = term ? term->type : ObjectType::generic;
    const auto [entry, is_new] = objects_.try_emplace({name, type});
    if (!is_new) return entry->second;
    CityObject& object = entry->second.read.object;
    object.type = type;
    object.type_name = term ? std::string(term->name) : "Mesh";
    object.id = name.empty() ? default_id_ : name;
    if (term && ids_.count(object.id) > 0) object.id = fmt::format("{}/{}", object.id, object.type_name);
    ids_.insert(object.id);
    object.where = fmt::format("{}: {}: {} '{}'", assembly_.name(), place, object.type_name, object.id);
    object.lod = fmt::format("{}", kMeshLod);
    entry->second.read.lods = {object.lod};
    entry->second.surfaces.begin_shell(Shell::Kind::loose);
    return entry->second;
}

void MeshObjects::finish(const AppearanceMap& map) {
    for (auto& [key, mesh] : objects_) {
        CityObject& object = mesh.read.object;
        mesh.surfaces.end_shell();
        object.geometry = mesh.surfaces.finish();
        if (object.type == ObjectType::generic && object.type_name == "Mesh" && is_terrain(object.geometry))
            object.type = ObjectType::terrain;
        assembly_.add(std::move(mesh.read), map);
    }
    objects_.clear();
}

}  // namespace skybake::io
