// Based on: glTF 2.0 specification, section 3.7 (meshes).
#include "io/gltf/read_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <optional>
#include <set>

#include "base/box.h"
#include "base/error.h"
#include "city/finding_codes.h"
#include "io/assembly/corner_budget.h"
#include "io/assembly/file_format.h"
#include "io/assembly/mesh_objects.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_appearance.h"
#include "io/gltf/gltf_compression.h"
#include "io/gltf/gltf_document.h"
#include "io/gltf/gltf_scene.h"

namespace skybake::io {
namespace {

constexpr std::size_t kTriangles = 4, kStrip = 5, kFan = 6;

/// The least and greatest distance from the Earth's centre at which cities lie (WGS 84, with 10 km to spare), metres.
constexpr double kEarthInside = 6.346e6, kEarthOutside = 6.389e6;
/// No city lies as high: map coordinates whose length happens to be that of the Earth's radius stay map coordinates.
constexpr double kHighest = 1e4;

/// A primitive in numbers.
struct Primitive {
    GltfArray positions{3, {}};
    GltfArray uvs{2, {}};
    GltfArray colors{4, {}};
    GltfArray features{1, {}};
    std::vector<std::uint32_t> triangles;  // three vertices each
};

class GltfReader {
  public:
    GltfReader(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
               Progress& progress)
        : document_(path),
          placement_(options.placement),
          findings_(findings),
          progress_(progress),
          assembly_(path, city, findings),
          objects_(assembly_, path.stem().string()),
          budget_(path.string(), document_.file().size()) {}

    ReadFile read() {
        ReadFile file;
        file.bytes = document_.file().size();
        ContentHash hash;
        hash.add({reinterpret_cast<const char*>(document_.file().data()), document_.file().size()});
        file.content_hash = hash.value();
        appearance_ = read_appearance(document_, assembly_.name(), findings_);
        const std::vector<GltfInstance> instances = read_scene(document_, assembly_.name(), findings_);
        progress_.begin("read " + assembly_.name(), std::max<std::size_t>(instances.size(), 1));
        for (const GltfInstance& instance : instances) {
            if (progress_.stop_requested()) throw Interrupted();
            read_mesh(instance);
            progress_.advance(1);
        }
        if (const GltfJson& lights = member(member(document_.json(), "extensions"), "KHR_lights_punctual");
            !lights.is_null())
            findings_.add(make_finding("SB122", assembly_.name(), "lights of the file are left out; see --lamps."));
        objects_.finish(assembly_.add_appearance(appearance_.materials, appearance_.textures));
        FileFacts facts;
        if (is_about_earth()) facts.crs = "EPSG:4978";
        assembly_.finish(facts);
        return file;
    }

  private:
    std::string where(const std::string& place) const { return fmt::format("{}: {}", assembly_.name(), place); }

    void read_mesh(const GltfInstance& instance) {
        const std::string mesh_place = fmt::format("meshes[{}]", instance.mesh);
        try {
            const GltfJson& primitives = member(entry(document_.json(), "meshes", instance.mesh), "primitives");
            std::string name = instance.name;
            for (int copy = 2; !names_.insert(name).second; ++copy) name = fmt::format("{} {}", instance.name, copy);
            for (std::size_t i = 0; primitives.is_array() && i < primitives.size(); ++i) {
                place_ = fmt::format("{}.primitives[{}]", mesh_place, i);
                try {
                    add_primitive(primitives[i], name, instance.to_asset);
                } catch (const GltfFault& fault) {
                    findings_.add(make_finding("SB101", where(place_), fmt::format("{}; left out.", fault.what())));
                }
            }
        } catch (const GltfFault& fault) {
            findings_.add(make_finding("SB101", where(mesh_place), fmt::format("{}; left out.", fault.what())));
        }
    }

    Primitive read_primitive(const GltfJson& json, const GltfMaterial* material) const {
        const GltfJson& attributes = member(json, "attributes");
        const GltfJson& compressed = member(member(json, "extensions"), "KHR_draco_mesh_compression");
        std::optional<DracoMesh> draco;
        if (!compressed.is_null())
            draco = decode_draco(document_.view(index_or(compressed, "bufferView", ~std::size_t{0})));
        const auto array = [&](const std::string& key) {
            if (draco) {
                const auto id = index_at(member(compressed, "attributes"), key);
                const auto found =
                    id ? draco->attributes.find(static_cast<std::uint32_t>(*id)) : draco->attributes.end();
                if (found != draco->attributes.end() && found->second.components > 0)
                    return GltfArray{found->second.components, std::move(found->second.values)};
            }
            const auto accessor = index_at(attributes, key);
            return accessor ? read_accessor(document_, *accessor) : GltfArray{};
        };
        Primitive primitive;
        primitive.positions = array("POSITION");
        if (primitive.positions.components != 3) throw GltfFault("a mesh has no positions");
        const std::size_t count = primitive.positions.count();
        if (material && material->texture) primitive.uvs = array(fmt::format("TEXCOORD_{}", material->uv_set));
        primitive.colors = array("COLOR_0");
        for (const char* key : {"_BATCHID", "BATCHID", "_FEATURE_ID_0"}) {
            if (primitive.features.values.empty()) primitive.features = array(key);
        }
        if (primitive.features.components != 1 || primitive.features.count() != count)
            primitive.features.values.clear();
        primitive.triangles = triangles_of(json, draco, count);
        return primitive;
    }

    std::vector<std::uint32_t> triangles_of(const GltfJson& json, const std::optional<DracoMesh>& draco,
                                            std::size_t vertices) const {
        if (draco) {
            for (const std::uint32_t index : draco->indices) {
                if (index >= vertices) throw GltfFault("a Draco triangle names a vertex that does not exist");
            }
            return draco->indices;
        }
        const std::size_t mode = index_or(json, "mode", kTriangles);
        if (mode < kTriangles) return {};
        if (mode > kFan) throw GltfFault(fmt::format("mode {} is unknown", mode));
        std::vector<std::uint32_t> list;
        if (const auto indices = index_at(json, "indices")) {
            list = read_indices(document_, *indices, vertices);
        } else {
            for (std::size_t i = 0; i < vertices; ++i) list.push_back(static_cast<std::uint32_t>(i));
        }
        if (mode == kTriangles) {
            list.resize(list.size() / 3 * 3);
            return list;
        }
        std::vector<std::uint32_t> triangles;
        for (std::size_t i = 0; i + 2 < list.size(); ++i) {
            const std::size_t odd = mode == kStrip ? i % 2 : 0;  // every second triangle of a strip runs the other way
            const std::array<std::uint32_t, 3> t = {list[mode == kFan ? 0 : i], list[i + 1 + odd], list[i + 2 - odd]};
            // Strips jump from piece to piece by triangles without area.
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.insert(triangles.end(), t.begin(), t.end());
        }
        return triangles;
    }

    void add_primitive(const GltfJson& json, const std::string& name, const glm::dmat4& to_asset) {
        const auto index = index_at(json, "material");
        if (index && *index >= appearance_.all.size())
            throw GltfFault(fmt::format("material {} of {} does not exist", *index, appearance_.all.size()));
        const GltfMaterial* material = index ? &appearance_.all[*index] : nullptr;
        const Primitive primitive = read_primitive(json, material);
        if (primitive.triangles.empty()) {
            findings_.add(make_finding("SB102", where(place_), "points and lines have no surface; left out."));
            return;
        }
        budget_.take(primitive.triangles.size());
        const std::optional<MaterialId> albedo = material_of(primitive, material);
        const bool is_textured = material && material->texture;
        const bool has_uvs =
            is_textured && primitive.uvs.components == 2 && primitive.uvs.count() == primitive.positions.count();
        if (is_textured && !has_uvs) {
            findings_.add(
                make_finding("SB403", where(place_),
                             fmt::format("has no TEXCOORD_{} for its texture; taken without.", material->uv_set)));
        }
        const bool is_mirrored = glm::determinant(glm::dmat3(to_asset)) < 0.0;
        const std::optional<ObjectTerm> term = material ? term_of_material(material->name) : std::nullopt;
        std::map<double, std::vector<std::uint32_t>> by_feature;  // triangles, by the feature of their first vertex
        for (std::size_t t = 0; t < primitive.triangles.size(); t += 3) {
            const std::uint32_t first = primitive.triangles[t];
            by_feature[primitive.features.values.empty() ? -1.0 : primitive.features.values[first]].push_back(
                static_cast<std::uint32_t>(t));
        }
        for (const auto& [feature, triangles] : by_feature) {
            const std::string id = feature < 0.0 ? name : fmt::format("{} {:.0f}", name, feature);
            add_triangles(primitive, triangles, objects_.at(id, term, place_), to_asset, is_mirrored, albedo,
                          has_uvs ? material : nullptr);
        }
    }

    void add_triangles(const Primitive& primitive, const std::vector<std::uint32_t>& triangles, MeshObject& mesh,
                       const glm::dmat4& to_asset, bool is_mirrored, std::optional<MaterialId> albedo,
                       const GltfMaterial* textured) {
        SurfaceBuilder& surfaces = mesh.surfaces;
        std::map<std::uint32_t, std::uint32_t> numbers;  // of the primitive's vertices in the object
        for (const std::uint32_t t : triangles) {
            std::array<std::uint32_t, 3> corners{primitive.triangles[t], primitive.triangles[t + 1],
                                                 primitive.triangles[t + 2]};
            if (is_mirrored) std::swap(corners[1], corners[2]);
            surfaces.begin_surface();
            for (const std::uint32_t vertex : corners) {
                std::vector<Vec3d>& vertices = surfaces.geometry.vertices;
                const auto [number, is_new] = numbers.try_emplace(vertex, static_cast<std::uint32_t>(vertices.size()));
                if (is_new) vertices.push_back(place_of(primitive, vertex, to_asset));
                surfaces.add_corner(number->second);
            }
            if (surfaces.close_ring() < 3) {  // a triangle on two vertices has nothing to show
                surfaces.drop_surface();
                continue;
            }
            Surface& surface = surfaces.end_surface(static_cast<std::uint32_t>(surfaces.geometry.surfaces.size()));
            surface.material = albedo;
            if (!textured) continue;
            std::array<Vec2f, 3> uvs{};
            bool is_finite = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const double u = primitive.uvs.values[2 * corners[k]], v = primitive.uvs.values[2 * corners[k] + 1];
                const std::array<double, 6>& m = textured->uv_transform;
                // glTF's images have their zero above, ours below.
                uvs[k] = Vec2f(m[0] * u + m[1] * v + m[2], 1.0 - (m[3] * u + m[4] * v + m[5]));
                is_finite = is_finite && std::isfinite(uvs[k].x) && std::isfinite(uvs[k].y);
            }
            if (is_finite) surfaces.set_texture(*textured->texture, uvs);
        }
    }

    Vec3d place_of(const Primitive& primitive, std::uint32_t vertex, const glm::dmat4& to_asset) {
        const double* v = &primitive.positions.values[3 * std::size_t{vertex}];
        const Vec3d p = Vec3d(to_asset * glm::dvec4(v[0], v[1], v[2], 1.0));
        const bool is_y_up = placement_.up.value_or(UpAxis::y) == UpAxis::y;
        const Vec3d place = (is_y_up ? Vec3d(p.x, -p.z, p.y) : p) + document_.center() + placement_.origin;
        if (std::isfinite(place.x + place.y + place.z)) extent_.extend(place);
        return place;
    }

    /// The base colour times the mean of the primitive's vertex colours.
    std::optional<MaterialId> material_of(const Primitive& primitive, const GltfMaterial* material) {
        const GltfArray& colors = primitive.colors;
        if (colors.components < 3 || colors.values.empty()) return material ? material->material : std::nullopt;
        Vec3d sum(0.0);
        for (std::size_t i = 0; i < colors.count(); ++i) {
            const double* c = &colors.values[i * colors.components];
            sum += Vec3d(c[0], c[1], c[2]);
        }
        Material mixed;
        if (material && material->material) mixed = appearance_.materials[material->material->index()];
        if (!material) mixed.albedo = Rgb(1.0f);
        mixed.albedo = glm::clamp(mixed.albedo * Rgb(sum / static_cast<double>(colors.count())), 0.0f, 1.0f);
        if (!(mixed.albedo.x + mixed.albedo.y + mixed.albedo.z >= 0.0f)) return std::nullopt;  // not a number
        appearance_.materials.push_back(std::move(mixed));
        return MaterialId(appearance_.materials.size() - 1);
    }

    bool is_about_earth() const {
        if (extent_.is_empty()) return false;
        const double distance = glm::length(extent_.center());
        return distance > kEarthInside && distance < kEarthOutside && std::abs(extent_.center().z) > kHighest;
    }

    GltfDocument document_;
    MeshPlacement placement_;
    FindingLog& findings_;
    Progress& progress_;
    CityAssembly assembly_;
    MeshObjects objects_;
    GltfAppearance appearance_;
    CornerBudget budget_;
    std::set<std::string> names_;
    std::string place_;  // of the primitive at hand, within the file
    Box3d extent_;
};

}  // namespace

ReadFile read_gltf(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
                   Progress& progress) {
    checked_file_size(path);
    return GltfReader(path, options, city, findings, progress).read();
}

}  // namespace skybake::io
