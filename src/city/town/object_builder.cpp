#include "city/town/object_builder.h"

#include <cmath>
#include <utility>

#include "base/hash_rng.h"

namespace skybake::town {

std::size_t ObjectBuilder::KeyHash::operator()(const Key& k) const {
    return hash_combine(hash_combine(static_cast<std::uint64_t>(k.x), static_cast<std::uint64_t>(k.y)),
                        static_cast<std::uint64_t>(k.z));
}

ObjectBuilder::ObjectBuilder(std::string id, ObjectType type, std::string type_name) {
    object.id = std::move(id);
    object.type = type;
    object.type_name = std::move(type_name);
    object.lod = "2.2";
    object.where = "town: " + object.id;
}

std::uint32_t ObjectBuilder::vertex(const Vec3d& p) {
    const Key key{std::llround(p.x * 1000.0), std::llround(p.y * 1000.0), std::llround(p.z * 1000.0)};
    std::vector<Vec3d>& vertices = object.geometry.vertices;
    const auto [found, is_new] = vertex_of_.try_emplace(key, static_cast<std::uint32_t>(vertices.size()));
    if (is_new) {
        const auto metres = [](std::int64_t local_mm, double origin) {
            return static_cast<double>(local_mm + std::llround(origin * 1000.0)) / 1000.0;
        };
        vertices.emplace_back(metres(key.x, kTownOrigin.x), metres(key.y, kTownOrigin.y), metres(key.z, kTownOrigin.z));
    }
    return found->second;
}

void ObjectBuilder::add_ring(std::span<const Vec3d> ring, const TextureFrame& frame) {
    Geometry& g = object.geometry;
    for (const Vec3d& p : ring) {
        g.corners.push_back(vertex(p));
        const Vec3d d = p - frame.origin;
        g.corner_uv.emplace_back(static_cast<float>(glm::dot(d, frame.u) + frame.offset.x),
                                 static_cast<float>(glm::dot(d, frame.v) + frame.offset.y));
    }
    g.ring_first.push_back(static_cast<std::uint32_t>(g.corners.size()));
}

void ObjectBuilder::add(std::span<const Vec3d> outer, std::span<const std::vector<Vec3d>> holes, const Finish& finish) {
    Geometry& g = object.geometry;
    Surface surface;
    surface.ring_begin = static_cast<std::uint32_t>(g.ring_first.size() - 1);
    add_ring(outer, finish.frame);
    for (const std::vector<Vec3d>& hole : holes) add_ring(hole, finish.frame);
    surface.ring_end = static_cast<std::uint32_t>(g.ring_first.size() - 1);
    surface.type = finish.type;
    surface.texture = finish.texture;
    surface.source_index = static_cast<std::uint32_t>(g.surfaces.size());
    g.surfaces.push_back(surface);
}

void ObjectBuilder::add(std::initializer_list<Vec3d> outer, const Finish& finish) {
    add(std::span<const Vec3d>(outer.begin(), outer.size()), {}, finish);
}

void ObjectBuilder::close_shell(Shell::Kind kind) {
    const auto end = static_cast<std::uint32_t>(object.geometry.surfaces.size());
    object.geometry.shells.push_back({shell_begin_, end, kind});
    shell_begin_ = end;
}

CityObject ObjectBuilder::take() {
    Geometry& g = object.geometry;
    g.vertices.shrink_to_fit();
    g.corners.shrink_to_fit();
    g.corner_uv.shrink_to_fit();
    g.ring_first.shrink_to_fit();
    g.surfaces.shrink_to_fit();
    return std::move(object);
}

TextureFrame ground_frame(double period_m) {
    return {Vec3d(0.0), Vec3d(1.0 / period_m, 0.0, 0.0), Vec3d(0.0, 1.0 / period_m, 0.0), Vec2d(0.0)};
}

}  // namespace skybake::town
