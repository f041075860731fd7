#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "base/check.h"
#include "base/finding.h"
#include "city/triangulate.h"
#include "scene/find_crowns.h"
#include "scene/scene.h"

namespace skybake {

namespace {

/// A corner on its way into the scene: position and texture coordinate.
struct Corner {
    Vec3f position;
    Vec2f uv;
};

/// The point of edge ab on the plane coordinate[axis] = value, the same bits whichever way the edge is walked.
Corner cut_edge(const Corner& a, const Corner& b, int axis, float value) {
    const Corner& low = a.position[axis] < b.position[axis] ? a : b;
    const Corner& high = a.position[axis] < b.position[axis] ? b : a;
    const float t = (value - low.position[axis]) / (high.position[axis] - low.position[axis]);
    Corner cut{low.position + t * (high.position - low.position), low.uv + t * (high.uv - low.uv)};
    cut.position[axis] = value;
    return cut;
}

/// Cuts a convex polygon at coordinate[axis] = value.
void cut_polygon(const std::vector<Corner>& polygon, int axis, float value, std::vector<Corner>& below,
                 std::vector<Corner>& above) {
    below.clear();
    above.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& a = polygon[i];
        const Corner& b = polygon[(i + 1) % polygon.size()];
        if (a.position[axis] <= value) below.push_back(a);
        if (a.position[axis] >= value) above.push_back(a);
        if ((a.position[axis] < value && b.position[axis] > value) ||
            (a.position[axis] > value && b.position[axis] < value)) {
            const Corner cut = cut_edge(a, b, axis, value);
            below.push_back(cut);
            above.push_back(cut);
        }
    }
}

/// Cuts a triangle at all multiples of `step` along x, y and z that its box crosses; appends the pieces' corners three
/// by three.
void cut_triangle(const std::array<Corner, 3>& triangle, float step, std::vector<std::array<Corner, 3>>& out) {
    std::vector<std::vector<Corner>> pieces{{triangle.begin(), triangle.end()}};
    std::vector<Corner> below, above;
    for (int axis = 0; axis < 3; ++axis) {
        float lo = triangle[0].position[axis], hi = lo;
        for (const Corner& corner : triangle) {
            lo = std::min(lo, corner.position[axis]);
            hi = std::max(hi, corner.position[axis]);
        }
        if (hi - lo <= step) continue;
        for (float value = (std::floor(lo / step) + 1.0f) * step; value < hi; value += step) {
            std::vector<std::vector<Corner>> next;
            for (const std::vector<Corner>& piece : pieces) {
                cut_polygon(piece, axis, value, below, above);
                if (below.size() >= 3) next.push_back(below);
                if (above.size() >= 3) next.push_back(above);
            }
            pieces = std::move(next);
        }
    }
    for (const std::vector<Corner>& piece : pieces) {
        for (std::size_t i = 2; i < piece.size(); ++i) out.push_back({piece[0], piece[i - 1], piece[i]});
    }
}

/// Materials are few: find or add.
class MaterialTable {
  public:
    MaterialTable(const CityModel& city, const SceneOptions& options) : city_(city), options_(options) {}

    MaterialId of(const Surface& surface) {
        SceneMaterial material;
        if (surface.texture && !city_.textures[surface.texture->index()].is_missing) {
            const Texture& texture = city_.textures[surface.texture->index()];
            material = {texture.uri, Rgb(1.0f), surface.texture, texture.wrap};
        } else if (surface.material) {
            const Material& stated = city_.materials[surface.material->index()];
            material = {stated.name, stated.albedo, std::nullopt, TextureWrap::repeat};
        } else {
            material = {name_of(surface.type), albedo_of(surface.type), std::nullopt, TextureWrap::repeat};
        }
        const Key key{material.name, material.texture ? material.texture->value + 1 : 0, material.albedo.x,
                      material.albedo.y, material.albedo.z};
        const auto [entry, is_new] = index_.try_emplace(key, MaterialId(materials.size()));
        if (is_new) materials.push_back(std::move(material));
        return entry->second;
    }

    std::vector<SceneMaterial> materials;

  private:
    using Key = std::tuple<std::string, std::uint32_t, float, float, float>;

    Rgb albedo_of(SurfaceType type) const {
        for (const auto& [overridden, albedo] : options_.albedo_override) {
            if (overridden == type) return albedo;
        }
        return default_albedo(type);
    }

    const CityModel& city_;
    const SceneOptions& options_;
    std::map<Key, MaterialId> index_;
};

std::string topmost_parent(const CityModel& city, const std::unordered_map<std::string_view, std::size_t>& by_id,
                           std::size_t object) {
    // At most as many steps as there are objects: parents of strangers may go in circles.
    for (std::size_t step = 0; step < city.objects.size(); ++step) {
        const auto parent = by_id.find(city.objects[object].parent_id);
        if (city.objects[object].parent_id.empty() || parent == by_id.end()) break;
        object = parent->second;
    }
    return city.objects[object].id;
}

}  // namespace

Scene build_scene(const CityModel& city, const SceneOptions& options, FindingLog& findings) {
    Scene scene;
    scene.textures = city.textures;
    const Box3d extent = extent_of(city);
    if (extent.is_empty()) return scene;
    // Whole metres, so that the same city with one more house rarely gets another frame.
    scene.origin = Vec3d(std::floor(extent.center().x), std::floor(extent.center().y), std::floor(extent.lo.z));

    std::vector<std::size_t> order(city.objects.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(city.objects[a].id, a) < std::tie(city.objects[b].id, b);
    });
    std::unordered_map<std::string_view, std::size_t> by_id;
    for (std::size_t i = 0; i < city.objects.size(); ++i) by_id.emplace(city.objects[i].id, i);

    MaterialTable materials(city, options);
    std::vector<std::array<Corner, 3>> pieces;
    for (const std::size_t index : order) {
        const CityObject& object = city.objects[index];
        if (object.geometry.is_empty()) continue;
        const std::uint32_t object_index = static_cast<std::uint32_t>(scene.objects.size());
        scene.objects.push_back({object.id, topmost_parent(city, by_id, index), object.type});
        const Geometry& geometry = object.geometry;
        const bool has_uv = !geometry.corner_uv.empty();
        for (const Surface& surface : geometry.surfaces) {
            if (surface.type == SurfaceType::closure) continue;  // an opening: light passes
            const auto corner_triples = triangulate(geometry, surface);
            if (corner_triples.empty()) {
                findings.add({"SB212", Severity::warning,
                              fmt::format("{} surface {}", object.where, surface.source_index),
                              "polygon cannot be triangulated; left out.", "Repair the polygon."});
                continue;
            }
            Face face{object_index,
                      surface.type,
                      materials.of(surface),
                      static_cast<std::uint32_t>(scene.triangles.size()),
                      0,
                      surface.source_index};
            for (const auto& triple : corner_triples) {
                std::array<Corner, 3> triangle;
                for (int k = 0; k < 3; ++k) {
                    triangle[k].position = Vec3f(geometry.vertices[geometry.corners[triple[k]]] - scene.origin);
                    triangle[k].uv = has_uv ? geometry.corner_uv[triple[k]] : Vec2f(0.0f);
                }
                pieces.clear();
                cut_triangle(triangle, options.max_piece_m, pieces);
                for (const std::array<Corner, 3>& piece : pieces) {
                    const Vec3f cross =
                        glm::cross(piece[1].position - piece[0].position, piece[2].position - piece[0].position);
                    if (!(glm::dot(cross, cross) > 0.0f)) continue;  // no area left in float
                    scene.triangles.push_back({piece[0].position, piece[1].position, piece[2].position});
                    scene.triangle_uvs.push_back({piece[0].uv, piece[1].uv, piece[2].uv});
                    scene.triangle_face.push_back(FaceId(scene.faces.size()));
                    for (const Corner& corner : piece) scene.bounds.extend(corner.position);
                }
            }
            face.triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - face.first_triangle;
            if (face.triangle_count > 0) scene.faces.push_back(face);
        }
    }
    scene.materials = std::move(materials.materials);
    if (options.crowns == CrownTreatment::transparent)
        scene.crowns = find_crowns(scene, options.crown_transmissivity, findings);
    return scene;
}

}  // namespace skybake
