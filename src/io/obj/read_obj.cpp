// Based on: Wavefront "Object files (.obj)", appendix B1 of the Advanced Visualizer manual.
#include "io/obj/read_obj.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "base/error.h"
#include "city/finding_codes.h"
#include "city/polygon.h"
#include "io/assembly/city_terms.h"
#include "io/assembly/file_format.h"
#include "io/obj/obj_text.h"
#include "io/obj/read_mtl.h"

namespace skybake::io {
namespace {

/// Between two looks at whether the user wants to stop.
constexpr std::size_t kLinesPerLook = 4096;
/// A mesh states no LoD; it counts as a body.
constexpr int kMeshLod = 1;

/// What a material's name says of its object: CityGML's terms and 3dfier's ("ForestWall" is the wall below a forest).
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

class ObjReader {
  public:
    ObjReader(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
              Progress& progress)
        : path_(path),
          placement_(options.placement),
          findings_(findings),
          progress_(progress),
          assembly_(path, city, findings) {}

    ReadFile read() {
        ReadFile file;
        file.bytes = checked_file_size(path_);
        progress_.begin("read " + assembly_.name(), std::max<std::uint64_t>(file.bytes, 1));
        std::ifstream in(path_, std::ios::binary);
        if (!in) throw InputError(fmt::format("{}: cannot be opened for reading.", path_.string()));
        ContentHash hash;
        std::string line;
        std::string whole;  // a line continued by a backslash at its end
        std::uint64_t bytes = 0;
        while (std::getline(in, line)) {
            ++line_;
            hash.add(line);
            if (!in.eof()) hash.add("\n");
            bytes += line.size() + 1;
            while (!line.empty() && line.back() == '\r') line.pop_back();
            if (!line.empty() && line.back() == '\\') {
                line.back() = ' ';
                whole += line;
                continue;
            }
            whole += line;
            read_line(whole);
            whole.clear();
            if (line_ % kLinesPerLook == 0) {
                if (progress_.stop_requested()) throw Interrupted();
                progress_.advance(bytes);
                bytes = 0;
            }
        }
        progress_.advance(bytes);
        finish();
        file.content_hash = hash.value();
        return file;
    }

  private:
    struct Corner {
        std::size_t vertex = 0;
        std::optional<std::size_t> uv;
    };
    /// An object while it grows; `vertices` renumbers those of the file.
    struct Growing {
        ReadObject read;
        std::map<std::size_t, std::uint32_t> vertices;
    };

    std::string place() const { return fmt::format("{}: line {}", assembly_.name(), line_); }
    void tell(std::string_view code, std::string what) { findings_.add(make_finding(code, place(), std::move(what))); }

    void read_line(std::string_view text) {
        std::string_view rest = text;
        const std::string_view word = next_word(rest);
        if (word == "v") {
            read_vertex(rest);
        } else if (word == "vt") {
            const auto u = number_of(next_word(rest)), v = number_of(next_word(rest));
            uvs_.emplace_back(static_cast<float>(u.value_or(NAN)), static_cast<float>(v.value_or(u ? 0.0 : NAN)));
        } else if (word == "f") {
            read_face(rest);
        } else if (word == "o") {
            has_objects_ = true;
            name_ = trim(rest);
            growing_ = nullptr;
        } else if (word == "g") {
            if (!has_objects_) name_ = trim(rest);
            growing_ = nullptr;
        } else if (word == "usemtl") {
            use_material(trim(rest));
        } else if (word == "mtllib") {
            const std::string uri(trim(rest));
            read_mtl(uri, path_.parent_path(), place(), materials_, findings_);
        } else if (word == "l" || word == "p") {
            tell("SB102", "points and lines have no surface; left out.");
        } else if (word == "curv" || word == "surf") {
            tell("SB101", "free-form curves and surfaces are not read; left out. Export polygons.");
        }
    }

    void read_vertex(std::string_view rest) {
        const auto x = number_of(next_word(rest)), y = number_of(next_word(rest)), z = number_of(next_word(rest));
        if (!x || !y || !z) {
            // It keeps its number; what uses it is left out for its place (SB211).
            tell("SB101", "a vertex is not three numbers.");
            vertices_.emplace_back(std::numeric_limits<double>::quiet_NaN());
            return;
        }
        const Vec3d p = placement_.up == UpAxis::y ? Vec3d(*x, -*z, *y) : Vec3d(*x, *y, *z);
        vertices_.push_back(placement_.origin + p);
    }

    void use_material(std::string_view name) {
        const auto found = materials_.by_name.find(name);
        if (found == materials_.by_name.end() && !materials_.by_name.empty())
            tell("SB404", fmt::format("material '{}' is in no library; default albedos are used.", name));
        material_ = found == materials_.by_name.end() ? std::nullopt : std::optional(found->second);
        term_ = term_of_material(name);
        growing_ = nullptr;
    }

    /// A number as in the file, from 1 or from the end by negative ones; none when there is no such entry.
    static std::optional<std::size_t> index_of(std::string_view word, std::size_t count) {
        std::int64_t index = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), index);
        if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size()) return std::nullopt;
        const auto signed_count = static_cast<std::int64_t>(count);
        if (index < 0) index += signed_count + 1;
        return index >= 1 && index <= signed_count ? std::optional(static_cast<std::size_t>(index - 1)) : std::nullopt;
    }

    void read_face(std::string_view rest) {
        corners_.clear();
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            const std::size_t slash = std::min(word.find('/'), word.size());
            const std::optional<std::size_t> vertex = index_of(word.substr(0, slash), vertices_.size());
            if (!vertex) {
                return tell("SB103",
                            fmt::format("corner '{}' is none of the {} vertices before it; the face is left out.",
                                        word.substr(0, 40), vertices_.size()));
            }
            Corner corner{*vertex, std::nullopt};
            if (slash < word.size()) {
                std::string_view uv = word.substr(slash + 1);
                uv = uv.substr(0, uv.find('/'));
                if (!uv.empty()) corner.uv = index_of(uv, uvs_.size());
            }
            corners_.push_back(corner);
        }
        while (corners_.size() > 1 && corners_.back().vertex == corners_.front().vertex) corners_.pop_back();
        if (corners_.size() < 3) return tell("SB204", fmt::format("face has {} corners; left out.", corners_.size()));
        Growing& growing = current();
        Geometry& g = growing.read.object.geometry;
        Surface surface;
        surface.ring_begin = static_cast<std::uint32_t>(g.ring_first.size() - 1);
        surface.ring_end = surface.ring_begin + 1;
        surface.source_index = static_cast<std::uint32_t>(g.surfaces.size());
        if (material_) surface.material = material_->material;
        bool is_textured = material_ && material_->texture;
        for (const Corner& corner : corners_) {
            const auto [entry, is_new] =
                growing.vertices.try_emplace(corner.vertex, static_cast<std::uint32_t>(g.vertices.size()));
            if (is_new) g.vertices.push_back(vertices_[corner.vertex]);
            g.corners.push_back(entry->second);
            is_textured =
                is_textured && corner.uv && std::isfinite(uvs_[*corner.uv].x) && std::isfinite(uvs_[*corner.uv].y);
        }
        if (is_textured) {
            surface.texture = material_->texture;
            g.corner_uv.resize(g.corners.size() - corners_.size(), Vec2f(0.0f));
            for (const Corner& corner : corners_) g.corner_uv.push_back(uvs_[*corner.uv]);
        } else if (material_ && material_->texture) {
            tell("SB403", "a corner has no texture vertex; the face is taken without texture.");
        }
        g.ring_first.push_back(static_cast<std::uint32_t>(g.corners.size()));
        g.surfaces.push_back(surface);
    }

    /// The object that faces go to: one for each name and type.
    Growing& current() {
        if (growing_) return *growing_;
        const ObjectType type = term_ ? term_->type : ObjectType::generic;
        const auto [entry, is_new] = objects_.try_emplace({name_, type});
        growing_ = &entry->second;
        if (!is_new) return *growing_;
        CityObject& object = growing_->read.object;
        object.type = type;
        object.type_name = term_ ? std::string(term_->name) : "Mesh";
        object.id = name_.empty() ? path_.stem().string() : name_;
        if (term_ && ids_.count(object.id) > 0) object.id = fmt::format("{}/{}", object.id, object.type_name);
        ids_.insert(object.id);
        object.where = fmt::format("{}: line {}: {} '{}'", assembly_.name(), line_, object.type_name, object.id);
        object.lod = fmt::format("{}", kMeshLod);
        growing_->read.lods = {object.lod};
        return *growing_;
    }

    void finish() {
        const AppearanceMap map = assembly_.add_appearance(materials_.materials, materials_.textures);
        for (auto& [key, growing] : objects_) {
            CityObject& object = growing.read.object;
            Geometry& g = object.geometry;
            if (!g.corner_uv.empty()) g.corner_uv.resize(g.corners.size(), Vec2f(0.0f));
            Shell shell;
            shell.surface_end = static_cast<std::uint32_t>(g.surfaces.size());
            g.shells.push_back(shell);
            if (object.type == ObjectType::generic && object.type_name == "Mesh" && is_terrain(g))
                object.type = ObjectType::terrain;
            assembly_.add(std::move(growing.read), map);
        }
        assembly_.finish({});
    }

    std::filesystem::path path_;
    MeshPlacement placement_;
    FindingLog& findings_;
    Progress& progress_;
    CityAssembly assembly_;
    std::size_t line_ = 0;
    std::vector<Vec3d> vertices_;
    std::vector<Vec2f> uvs_;
    std::vector<Corner> corners_;
    ObjMaterials materials_;
    std::optional<ObjMaterial> material_;
    std::optional<ObjectTerm> term_;
    std::string name_;
    bool has_objects_ = false;
    std::map<std::pair<std::string, ObjectType>, Growing> objects_;
    std::set<std::string> ids_;
    Growing* growing_ = nullptr;
};

}  // namespace

ReadFile read_obj(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
                  Progress& progress) {
    return ObjReader(path, options, city, findings, progress).read();
}

}  // namespace skybake::io
