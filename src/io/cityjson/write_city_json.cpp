// Based on: CityJSON 2.0.1 specification, https://www.cityjson.org/specs/2.0.1/, sections 2 to 7 and "CityJSONSeq".
#include "io/cityjson/write_city_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "base/error.h"
#include "base/hash_rng.h"
#include "io/assembly/city_terms.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

constexpr double kUnit = 0.001;  // metres; finer than any survey

/// Collects text and hands it on in large pieces.
class Sink {
  public:
    explicit Sink(const std::filesystem::path& path) : file_(path) {}
    template <typename... Arguments>
    void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Arguments>(arguments)...);
        spill();
    }
    void text(std::string_view t) {
        buffer_.append(t);
        spill();
    }
    void number(std::int64_t value) {
        const fmt::format_int digits(value);
        buffer_.append(std::string_view(digits.data(), digits.size()));
    }
    void commit() {
        file_.write(std::string_view(buffer_.data(), buffer_.size()));
        file_.commit();
    }

  private:
    void spill() {
        if (buffer_.size() < (1u << 20)) return;
        file_.write(std::string_view(buffer_.data(), buffer_.size()));
        buffer_.clear();
    }
    FileReplacement file_;
    fmt::memory_buffer buffer_;
};

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

using Cell = std::array<std::int64_t, 3>;  // whole units above the origin

struct CellHash {
    std::size_t operator()(const Cell& c) const {
        return hash_combine(hash_combine(static_cast<std::uint64_t>(c[0]), static_cast<std::uint64_t>(c[1])),
                            static_cast<std::uint64_t>(c[2]));
    }
};

Cell cell_of(const Vec3d& p, const Vec3d& origin) {
    return {std::llround((p.x - origin.x) / kUnit), std::llround((p.y - origin.y) / kUnit),
            std::llround((p.z - origin.z) / kUnit)};
}

/// Numbers vertices in order of first use; equal places get one number.
class VertexTable {
  public:
    std::uint32_t number_of(const Cell& cell) {
        const auto [found, is_new] = numbers_.try_emplace(cell, static_cast<std::uint32_t>(cells_.size()));
        if (is_new) cells_.push_back(cell);
        return found->second;
    }
    const std::vector<Cell>& cells() const { return cells_; }

  private:
    std::unordered_map<Cell, std::uint32_t, CellHash> numbers_;
    std::vector<Cell> cells_;
};

/// Texture coordinates of the file; equal ones are shared within an object (over the whole file that would cost a table
/// of millions).
struct UvTable {
    std::vector<Vec2f> all;
    std::unordered_map<std::uint64_t, std::uint32_t> in_object;

    std::uint32_t number_of(Vec2f uv) {
        const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(uv.x * 1e4f)));
        const auto y = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(uv.y * 1e4f)));
        const auto [found, is_new] =
            in_object.try_emplace((std::uint64_t{x} << 32) | y, static_cast<std::uint32_t>(all.size()));
        if (is_new) all.push_back(uv);
        return found->second;
    }
};

/// Numbers that a feature of a sequence gives to the textures or materials that it uses; in one whole file they keep
/// their own.
struct Renumbering {
    bool keeps_all = true;
    std::map<std::uint32_t, std::uint32_t> local;

    std::uint32_t of(std::uint32_t global) {
        if (keeps_all) return global;
        return local.try_emplace(global, static_cast<std::uint32_t>(local.size())).first->second;
    }
};

struct Tables {
    VertexTable vertices;
    UvTable uvs;
    Renumbering textures;
    Renumbering materials;
};

enum class Semantics { none, building, transport, water };

Semantics semantics_of(ObjectType type) {
    switch (type) {
        case ObjectType::building:
        case ObjectType::building_part:
        case ObjectType::building_installation:
        case ObjectType::bridge:
        case ObjectType::tunnel:
            return Semantics::building;
        case ObjectType::road:
        case ObjectType::railway:
        case ObjectType::square:
            return Semantics::transport;
        case ObjectType::water:
            return Semantics::water;
        default:
            return Semantics::none;
    }
}

/// CityJSON's name for the surface on such an object; null where it has none.
const char* semantic_name(Semantics semantics, SurfaceType type) {
    if (semantics == Semantics::transport) return type == SurfaceType::road ? "TrafficArea" : nullptr;
    if (semantics == Semantics::water) return type == SurfaceType::water ? "WaterSurface" : nullptr;
    if (semantics == Semantics::none) return nullptr;
    switch (type) {
        case SurfaceType::ground:
            return "GroundSurface";
        case SurfaceType::wall:
            return "WallSurface";
        case SurfaceType::roof:
            return "RoofSurface";
        case SurfaceType::closure:
            return "ClosureSurface";
        case SurfaceType::floor:
            return "OuterFloorSurface";
        case SurfaceType::ceiling:
            return "OuterCeilingSurface";
        case SurfaceType::window:
            return "Window";
        case SurfaceType::door:
            return "Door";
        default:
            return nullptr;
    }
}

const char* type_name_of(const CityObject& object) {
    // Names of other formats and of extensions give way to CityJSON's own.
    if (const std::optional<ObjectTerm> term = object_term(object.type_name); term && term->type == object.type)
        return object.type_name.c_str();
    switch (object.type) {
        case ObjectType::building:
            return "Building";
        case ObjectType::building_part:
            return "BuildingPart";
        case ObjectType::building_installation:
            return "BuildingInstallation";
        case ObjectType::bridge:
            return "Bridge";
        case ObjectType::tunnel:
            return "Tunnel";
        case ObjectType::road:
            return "Road";
        case ObjectType::railway:
            return "Railway";
        case ObjectType::square:
            return "TransportSquare";
        case ObjectType::land_use:
            return "LandUse";
        case ObjectType::plant_cover:
            return "PlantCover";
        case ObjectType::solitary_vegetation:
            return "SolitaryVegetationObject";
        case ObjectType::water:
            return "WaterBody";
        case ObjectType::terrain:
            return "TINRelief";
        case ObjectType::furniture:
            return "CityFurniture";
        case ObjectType::generic:
        case ObjectType::other:
            return "GenericCityObject";
    }
    return "GenericCityObject";
}

/// Some surfaces of an object as one geometry: its solids (each a run of shells, the outer one first), or its loose
/// surfaces.
struct Part {
    std::vector<std::vector<Shell>> solids;  // of a Solid or a MultiSolid
    std::vector<Shell> loose;
    bool is_solid() const { return !solids.empty(); }
};

std::vector<Part> parts_of(const Geometry& geometry) {
    Part solid;
    Part loose;
    for (const Shell& shell : geometry.shells) {
        if (shell.kind == Shell::Kind::loose || (shell.kind == Shell::Kind::inner && solid.solids.empty())) {
            loose.loose.push_back(shell);
        } else if (shell.kind == Shell::Kind::outer) {
            solid.solids.push_back({shell});
        } else {
            solid.solids.back().push_back(shell);
        }
    }
    std::vector<Part> parts;
    if (solid.is_solid()) parts.push_back(std::move(solid));
    if (!loose.loose.empty()) parts.push_back(std::move(loose));
    return parts;
}

/// Writes one geometry: `write_surface` is called for the boundaries, semantics, textures and materials in the nesting
/// of its type.
class GeometryWriter {
  public:
    using Notes = SurfaceNotes::mapped_type;
    /// `notes` of the object's surfaces, or null.
    GeometryWriter(Sink& sink, const CityObject& object, const Vec3d& origin, Tables& tables, const Notes* notes)
        : sink_(sink), object_(object), geometry_(object.geometry), origin_(origin), tables_(tables), notes_(notes) {}

    void write(const Part& part) {
        const bool is_terrain = object_.type == ObjectType::terrain;
        const char* type = part.is_solid() ? (part.solids.size() > 1 ? "MultiSolid" : "Solid")
                                           : (is_terrain ? "CompositeSurface" : "MultiSurface");
        sink_.print(R"({{"type":"{}","lod":{},"boundaries":)", type, quoted(object_.lod.empty() ? "2" : object_.lod));
        nest(part, [&](const Surface& s) { write_boundary(s); });
        write_semantics(part);
        const auto has = [&](auto&& test) {
            bool found = false;
            each(part, [&](const Surface& s) { found = found || test(s); });
            return found;
        };
        if (has([](const Surface& s) { return s.material.has_value(); })) {
            sink_.text(R"(,"material":{"":{"values":)");
            nest(part, [&](const Surface& s) {
                if (s.material) {
                    sink_.number(tables_.materials.of(s.material->value));
                } else {
                    sink_.text("null");
                }
            });
            sink_.text("}}");
        }
        if (!geometry_.corner_uv.empty() && has([](const Surface& s) { return s.texture.has_value(); })) {
            sink_.text(R"(,"texture":{"":{"values":)");
            nest(part, [&](const Surface& s) { write_texture(s); });
            sink_.text("}}");
        }
        sink_.text("}");
    }

  private:
    template <typename Visit>
    void each_of(const Shell& shell, Visit&& visit) {
        for (std::uint32_t s = shell.surface_begin; s < shell.surface_end; ++s) visit(geometry_.surfaces[s]);
    }
    template <typename Visit>
    void each(const Part& part, Visit&& visit) {
        for (const std::vector<Shell>& solid : part.solids) {
            for (const Shell& shell : solid) each_of(shell, visit);
        }
        for (const Shell& shell : part.loose) each_of(shell, visit);
    }
    template <typename Range, typename Visit>
    void list(const Range& range, Visit&& visit) {
        sink_.text("[");
        bool is_first = true;
        for (const auto& item : range) {
            if (!is_first) sink_.text(",");
            is_first = false;
            visit(item);
        }
        sink_.text("]");
    }
    /// `visit` for each surface, in the arrays that CityJSON nests for this type of geometry.
    template <typename Visit>
    void nest(const Part& part, Visit&& visit) {
        const auto solid = [&](const std::vector<Shell>& shells) {
            list(shells, [&](const Shell& shell) { surfaces({shell}, visit); });
        };
        if (!part.is_solid()) {
            surfaces(part.loose, visit);
        } else if (part.solids.size() == 1) {
            solid(part.solids.front());
        } else {
            list(part.solids, solid);
        }
    }
    template <typename Visit>
    void surfaces(const std::vector<Shell>& shells, Visit&& visit) {
        sink_.text("[");
        bool is_first = true;
        for (const Shell& shell : shells) {
            each_of(shell, [&](const Surface& s) {
                if (!is_first) sink_.text(",");
                is_first = false;
                visit(s);
            });
        }
        sink_.text("]");
    }

    template <typename Visit>
    void write_rings(const Surface& s, Visit&& corner, std::string_view before = "") {
        sink_.text("[");
        for (std::uint32_t r = s.ring_begin; r < s.ring_end; ++r) {
            if (r > s.ring_begin) sink_.text(",");
            sink_.text("[");
            sink_.text(before);
            for (std::uint32_t c = geometry_.ring_first[r]; c < geometry_.ring_first[r + 1]; ++c) {
                if (c > geometry_.ring_first[r] || !before.empty()) sink_.text(",");
                corner(c);
            }
            sink_.text("]");
        }
        sink_.text("]");
    }
    void write_boundary(const Surface& s) {
        write_rings(s, [&](std::uint32_t c) {
            sink_.number(tables_.vertices.number_of(cell_of(geometry_.vertices[geometry_.corners[c]], origin_)));
        });
    }
    void write_texture(const Surface& s) {
        if (!s.texture) {
            sink_.text("[[null]]");
            return;
        }
        write_rings(
            s, [&](std::uint32_t c) { sink_.number(tables_.uvs.number_of(geometry_.corner_uv[c])); },
            std::to_string(tables_.textures.of(s.texture->value)));
    }
    /// The surface's semantic object; empty when it has none.
    std::string semantic_object(Semantics semantics, const Surface& s) const {
        const SurfaceNote* note = nullptr;
        if (notes_) {
            if (const auto found = notes_->find(s.source_index); found != notes_->end()) note = &found->second;
        }
        const char* name = semantic_name(semantics, s.type);
        if (!name && note) name = semantic_name(semantics, note->type);
        if (!name) return "";
        return note ? fmt::format(R"({{"type":"{}",{}}})", name, note->members_json)
                    : fmt::format(R"({{"type":"{}"}})", name);
    }
    void write_semantics(const Part& part) {
        const Semantics semantics = semantics_of(object_.type);
        std::vector<std::string> objects;
        std::unordered_map<std::string, std::size_t> index_of;
        each(part, [&](const Surface& s) {
            std::string object = semantic_object(semantics, s);
            if (object.empty() || !index_of.try_emplace(object, objects.size()).second) return;
            objects.push_back(std::move(object));
        });
        if (objects.empty()) return;
        sink_.text(R"(,"semantics":{"surfaces":)");
        list(objects, [&](const std::string& object) { sink_.text(object); });
        sink_.text(R"(,"values":)");
        nest(part, [&](const Surface& s) {
            const std::string object = semantic_object(semantics, s);
            if (object.empty()) {
                sink_.text("null");
            } else {
                sink_.number(static_cast<std::int64_t>(index_of.at(object)));
            }
        });
        sink_.text("}");
    }

    Sink& sink_;
    const CityObject& object_;
    const Geometry& geometry_;
    const Vec3d& origin_;
    Tables& tables_;
    const Notes* notes_;
};

using Children = std::unordered_map<std::string, std::vector<std::size_t>>;

void write_object(Sink& sink, const CityModel& city, std::size_t index, const Children& children, const Vec3d& origin,
                  Tables& tables, const SurfaceNotes& notes) {
    const CityObject& object = city.objects[index];
    sink.print(R"({}:{{"type":{})", quoted(object.id), quoted(type_name_of(object)));
    if (!object.parent_id.empty()) sink.print(R"(,"parents":[{}])", quoted(object.parent_id));
    if (const auto found = children.find(object.id); found != children.end()) {
        sink.text(R"(,"children":[)");
        for (std::size_t i = 0; i < found->second.size(); ++i) {
            sink.print("{}{}", i > 0 ? "," : "", quoted(city.objects[found->second[i]].id));
        }
        sink.text("]");
    }
    if (!object.attributes_json.empty() && object.attributes_json != "{}") {
        if (!nlohmann::json::accept(object.attributes_json) || object.attributes_json.front() != '{') {
            throw InputError(fmt::format("{}: its attributes are no JSON object; nothing written.", object.where));
        }
        sink.print(R"(,"attributes":{})", object.attributes_json);
    }
    tables.uvs.in_object.clear();
    if (!object.geometry.is_empty()) {
        sink.text(R"(,"geometry":[)");
        const auto found = notes.find(object.id);
        GeometryWriter writer(sink, object, origin, tables, found == notes.end() ? nullptr : &found->second);
        bool is_first = true;
        for (const Part& part : parts_of(object.geometry)) {
            if (!is_first) sink.text(",");
            is_first = false;
            writer.write(part);
        }
        sink.text("]");
    }
    sink.text("}");
}

const char* wrap_name(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::none:
            return "none";
        case TextureWrap::repeat:
            return "wrap";
        case TextureWrap::mirror:
            return "mirror";
        case TextureWrap::clamp:
            return "clamp";
        case TextureWrap::border:
            return "border";
    }
    return "none";
}

/// "PNG" or "JPG", the two kinds that CityJSON allows.
const char* picture_kind(const std::string& uri) {
    const std::string extension = std::filesystem::path(uri).extension().string();
    const bool is_jpeg = extension == ".jpg" || extension == ".jpeg" || extension == ".JPG" || extension == ".JPEG";
    return is_jpeg ? "JPG" : "PNG";
}

/// The originals in the order of a feature's numbers, or all.
std::vector<std::uint32_t> originals(const Renumbering& renumbering, std::size_t count) {
    std::vector<std::uint32_t> list(renumbering.keeps_all ? count : renumbering.local.size());
    for (std::uint32_t i = 0; renumbering.keeps_all && i < list.size(); ++i) list[i] = i;
    for (const auto& [global, local] : renumbering.local) list[local] = global;
    return list;
}

void write_appearance(Sink& sink, const CityModel& city, const Tables& tables) {
    const std::vector<std::uint32_t> materials = originals(tables.materials, city.materials.size());
    const std::vector<std::uint32_t> textures = originals(tables.textures, city.textures.size());
    if (materials.empty() && textures.empty()) return;
    sink.text(R"(,"appearance":{)");
    if (!materials.empty()) {
        sink.text(R"("materials":[)");
        for (std::size_t i = 0; i < materials.size(); ++i) {
            const Material& m = city.materials[materials[i]];
            sink.print(R"({}{{"name":{},"diffuseColor":[{:.4f},{:.4f},{:.4f}],"transparency":{:.4f}}})",
                       i > 0 ? "," : "", quoted(m.name), srgb_from_linear(m.albedo.x), srgb_from_linear(m.albedo.y),
                       srgb_from_linear(m.albedo.z), std::clamp(m.transparency, 0.0f, 1.0f));
        }
        sink.text("]");
    }
    if (!textures.empty()) {
        sink.text(materials.empty() ? R"("textures":[)" : R"(,"textures":[)");
        for (std::size_t i = 0; i < textures.size(); ++i) {
            const Texture& t = city.textures[textures[i]];
            sink.print(R"({}{{"type":"{}","image":{},"wrapMode":"{}")", i > 0 ? "," : "", picture_kind(t.uri),
                       quoted(t.uri), wrap_name(t.wrap));
            if (t.wrap == TextureWrap::border) {
                sink.print(R"(,"borderColor":[{:.4f},{:.4f},{:.4f},1.0])", srgb_from_linear(t.border_color.x),
                           srgb_from_linear(t.border_color.y), srgb_from_linear(t.border_color.z));
            }
            sink.text("}");
        }
        sink.text(R"(],"vertices-texture":[)");
        for (std::size_t i = 0; i < tables.uvs.all.size(); ++i) {
            // Shortest text to four decimals: a ten-thousandth of a picture is a twentieth of its pixel.
            const Vec2f uv = tables.uvs.all[i];
            sink.print("{}[{:.6g},{:.6g}]", i > 0 ? "," : "", std::round(uv.x * 1e4f) * 1e-4,
                       std::round(uv.y * 1e4f) * 1e-4);
        }
        sink.text("]");
    }
    sink.text("}");
}

void write_vertices(Sink& sink, const VertexTable& table) {
    sink.text(R"(,"vertices":[)");
    bool is_first = true;
    for (const Cell& c : table.cells()) {
        sink.print("{}[{},{},{}]", is_first ? "" : ",", c[0], c[1], c[2]);
        is_first = false;
    }
    sink.text("]");
}

/// Everything before the objects.
void write_head(Sink& sink, const CityModel& city, const Vec3d& origin, const Box3d& extent) {
    sink.print(
        R"({{"type":"CityJSON","version":"2.0","transform":{{"scale":[{0},{0},{0}],"translate":[{1:.3f},{2:.3f},{3:.3f}]}},"metadata":{{)",
        kUnit, origin.x, origin.y, origin.z);
    if (!extent.is_empty()) {
        sink.print(R"("geographicalExtent":[{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}])", extent.lo.x, extent.lo.y,
                   extent.lo.z, extent.hi.x, extent.hi.y, extent.hi.z);
    }
    if (!city.crs.empty()) sink.print(R"({}"referenceSystem":{})", extent.is_empty() ? "" : ",", quoted(city.crs));
    sink.text("}");
}

}  // namespace

void write_city_json(const CityModel& city, const std::filesystem::path& path, const SurfaceNotes& notes) {
    const Box3d extent = extent_of(city);
    const Vec3d lowest = extent.is_empty() ? Vec3d(0.0) : extent.lo;
    const Vec3d origin{std::floor(lowest.x), std::floor(lowest.y), std::floor(lowest.z)};
    Children children;
    for (std::size_t i = 0; i < city.objects.size(); ++i) {
        if (!city.objects[i].parent_id.empty()) children[city.objects[i].parent_id].push_back(i);
    }
    Sink sink(path);
    write_head(sink, city, origin, extent);
    if (path.extension() != ".jsonl") {
        sink.text(R"(,"CityObjects":{)");
        Tables tables;
        for (std::size_t i = 0; i < city.objects.size(); ++i) {
            sink.text(i > 0 ? ",\n" : "\n");
            write_object(sink, city, i, children, origin, tables, notes);
        }
        sink.text("}");
        write_appearance(sink, city, tables);
        write_vertices(sink, tables.vertices);
        sink.text("}\n");
        sink.commit();
        return;
    }
    sink.text(R"(,"CityObjects":{},"vertices":[]})"
              "\n");
    std::vector<std::size_t> below;
    for (std::size_t top = 0; top < city.objects.size(); ++top) {
        if (!city.objects[top].parent_id.empty()) continue;
        Tables tables;
        tables.textures.keeps_all = false;
        tables.materials.keeps_all = false;
        sink.print(R"({{"type":"CityJSONFeature","id":{},"CityObjects":{{)", quoted(city.objects[top].id));
        below.assign(1, top);
        for (std::size_t k = 0; k < below.size(); ++k) {
            if (k > 0) sink.text(",");
            write_object(sink, city, below[k], children, origin, tables, notes);
            if (const auto found = children.find(city.objects[below[k]].id); found != children.end()) {
                below.insert(below.end(), found->second.begin(), found->second.end());
            }
        }
        sink.text("}");
        write_appearance(sink, city, tables);
        write_vertices(sink, tables.vertices);
        sink.text("}\n");
    }
    sink.commit();
}

}  // namespace skybake::io
