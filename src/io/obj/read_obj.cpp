// Based on: Wavefront "Object files (.obj)", appendix B1 of the Advanced Visualizer manual.
#include "io/obj/read_obj.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

#include "base/error.h"
#include "city/finding_codes.h"
#include "io/assembly/file_format.h"
#include "io/assembly/mesh_objects.h"
#include "io/obj/obj_text.h"
#include "io/obj/read_mtl.h"

namespace skybake::io {
namespace {

/// Between two looks at whether the user wants to stop.
constexpr std::size_t kLinesPerLook = 4096;
class ObjReader {
  public:
    ObjReader(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
              Progress& progress)
        : path_(path),
          placement_(options.placement),
          findings_(findings),
          progress_(progress),
          assembly_(path, city, findings),
          objects_(assembly_, path.stem().string()) {}

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
            if (libraries_.insert(uri).second) read_mtl(uri, path_.parent_path(), place(), materials_, findings_);
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
        const Vec3d p = placement_.up.value_or(UpAxis::z) == UpAxis::y ? Vec3d(*x, -*z, *y) : Vec3d(*x, *y, *z);
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
        if (!growing_) growing_ = &objects_.at(name_, term_, fmt::format("line {}", line_));
        SurfaceBuilder& surfaces = growing_->surfaces;
        surfaces.begin_surface();
        for (const Corner& corner : corners_) {
            std::vector<Vec3d>& vertices = surfaces.geometry.vertices;
            const auto [entry, is_new] =
                growing_->vertices.try_emplace(corner.vertex, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(vertices_[corner.vertex]);
            surfaces.add_corner(entry->second);
        }
        const std::size_t count = surfaces.close_ring();
        if (count < 3) {
            surfaces.drop_surface();
            findings_.add(short_ring(place(), true, count));
            return;
        }
        Surface& surface = surfaces.end_surface(static_cast<std::uint32_t>(surfaces.geometry.surfaces.size()));
        if (!material_) return;
        surface.material = material_->material;
        if (material_->texture) set_texture(count);
    }

    /// Of the face read last, which has its first `count` corners.
    void set_texture(std::size_t count) {
        std::vector<Vec2f> uvs;
        for (std::size_t i = 0; i < count; ++i) {
            const std::optional<std::size_t> uv = corners_[i].uv;
            if (!uv || !std::isfinite(uvs_[*uv].x) || !std::isfinite(uvs_[*uv].y))
                return tell("SB403", "a corner has no texture vertex; the face is taken without texture.");
            uvs.push_back(uvs_[*uv]);
        }
        growing_->surfaces.set_texture(*material_->texture, uvs);
    }

    void finish() {
        objects_.finish(assembly_.add_appearance(materials_.materials, materials_.textures));
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
    std::set<std::string> libraries_;  // that were read
    std::optional<ObjMaterial> material_;
    std::optional<ObjectTerm> term_;
    std::string name_;
    bool has_objects_ = false;
    MeshObjects objects_;
    MeshObject* growing_ = nullptr;
};

}  // namespace

ReadFile read_obj(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
                  Progress& progress) {
    return ObjReader(path, options, city, findings, progress).read();
}

}  // namespace skybake::io
