#include "io/cityjson/read_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "city/finding_codes.h"
#include "io/assembly/city_terms.h"
#include "io/assembly/surface_builder.h"

namespace skybake::io {
namespace {

using simdjson::dom::element;
using Optional = std::optional<element>;

Optional member(const Optional& object, std::string_view key) {
    element value;
    if (!object || !object->is_object() || object->at_key(key).get(value) != simdjson::SUCCESS || value.is_null())
        return std::nullopt;
    return value;
}

std::vector<element> elements_of(const Optional& e) {
    std::vector<element> result;
    simdjson::dom::array array;
    if (!e || e->get_array().get(array) != simdjson::SUCCESS) return result;
    for (const element item : array) result.push_back(item);
    return result;
}

/// The theme of `themes` that is named `preferred`, or the first one.
Optional choose_theme(const Optional& themes, const std::string& preferred, std::string_view what,
                      const std::string& where, FindingLog& findings) {
    simdjson::dom::object object;
    if (!themes || themes->get_object().get(object) != simdjson::SUCCESS) return std::nullopt;
    Optional chosen;
    std::string_view chosen_name;
    std::size_t count = 0;
    for (const auto& [name, theme] : object) {
        if (count++ == 0 || name == preferred) {
            chosen = theme;
            chosen_name = name;
        }
    }
    if (count > 1) {
        findings.add(
            make_finding("SB407", where, fmt::format("{} has {} themes; '{}' is used.", what, count, chosen_name)));
    }
    return chosen;
}

/// All numbers in a nest of arrays are null or below `count`.
bool are_indices_below(const Optional& e, std::size_t count) {
    if (!e || e->is_null()) return true;
    if (e->is_array()) {
        for (const element item : elements_of(e)) {
            if (!are_indices_below(item, count)) return false;
        }
        return true;
    }
    std::uint64_t index = 0;
    return e->get_uint64().get(index) == simdjson::SUCCESS && index < count;
}

/// Appends surfaces to a geometry, with the vertices still numbered as in the file.
class GeometryBuilder {
  public:
    GeometryBuilder(const GeometryContext& context, std::string where, FindingLog& findings)
        : context_(context), where_(std::move(where)), findings_(findings) {}

    /// What goes with a boundary at the same place of its own nest; null where there is nothing.
    struct Beside {
        Optional semantics, material, texture;
    };

    void read(element geometry, std::string_view type) {
        const Optional semantics = member(geometry, "semantics");
        if (semantics) {
            for (const element surface : elements_of(member(semantics, "surfaces"))) {
                std::string_view name;
                const bool has_name =
                    surface.is_object() && surface["type"].get_string().get(name) == simdjson::SUCCESS;
                semantic_types_.push_back(has_name ? surface_type_from(name) : SurfaceType::unknown);
            }
        }
        Beside beside;
        beside.semantics = member(semantics, "values");
        const CityJsonAppearance& appearance = *context_.appearance;
        const Optional materials = member(geometry, "material");
        const Optional material =
            choose_theme(materials, appearance.default_material_theme, "material", where_, findings_);
        check_materials(materials);
        beside.material = member(material, "values");
        if (const Optional value = member(material, "value")) whole_material_ = material_index(*value);
        beside.texture = member(
            choose_theme(member(geometry, "texture"), appearance.default_texture_theme, "texture", where_, findings_),
            "values");

        const Optional boundaries = member(geometry, "boundaries");
        if (!boundaries || !boundaries->is_array()) {
            fault("boundaries are missing or no array; the geometry is left out.");
            return;
        }
        if (type == "MultiSurface" || type == "CompositeSurface") {
            read_shell(*boundaries, beside, Shell::Kind::loose);
        } else if (type == "Solid") {
            read_solid(*boundaries, beside);
        } else {
            for_each(*boundaries, beside, [&](const element& solid, const Beside& inner) { read_solid(solid, inner); });
        }
    }

    ReadGeometry finish() {
        ReadGeometry result;
        result.has_semantics = has_semantics_;
        result.geometry = surfaces_.finish();
        Geometry& geometry = result.geometry;
        // Vertices in order of their number in the file: the same for every order of surfaces.
        std::vector<std::uint32_t> used(geometry.corners);
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        geometry.vertices.reserve(used.size());
        for (const std::uint32_t vertex : used) geometry.vertices.push_back(context_.vertices[vertex]);
        for (std::uint32_t& corner : geometry.corners) {
            corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
        }
        return result;
    }

  private:
    void fault(std::string what) { findings_.add(make_finding("SB101", where_, std::move(what))); }
    std::string place() const { return fmt::format("{}/boundaries (polygon {})", where_, source_index_); }

    /// Calls `f(boundary, what goes with it)` for each element; what does not have as many elements does not fit and is
    /// dropped.
    template <typename F>
    void for_each(const element& boundaries, const Beside& beside, F&& f) {
        const std::vector<element> items = elements_of(boundaries);
        const std::vector<element> semantics =
            matching(beside.semantics, items.size(), is_semantics_reported_, "SB112", "semantics.values");
        const std::vector<element> materials =
            matching(beside.material, items.size(), is_material_reported_, "SB404", "material.values");
        const std::vector<element> textures =
            matching(beside.texture, items.size(), is_texture_reported_, "SB403", "texture.values");
        for (std::size_t i = 0; i < items.size(); ++i) {
            Beside inner;
            if (!semantics.empty()) inner.semantics = semantics[i];
            if (!materials.empty()) inner.material = materials[i];
            if (!textures.empty()) inner.texture = textures[i];
            f(items[i], inner);
        }
    }

    std::vector<element> matching(const Optional& values, std::size_t count, bool& is_reported, std::string_view code,
                                  std::string_view name) {
        if (!values || values->is_null()) return {};
        std::vector<element> items = elements_of(values);
        if (items.size() == count && values->is_array()) return items;
        if (!is_reported) {
            is_reported = true;
            findings_.add(make_finding(code, where_,
                                       fmt::format("{} has {} entries where the boundaries have {}; ignored there.",
                                                   name, items.size(), count)));
        }
        return {};
    }

    void read_solid(const element& shells, const Beside& beside) {
        if (!shells.is_array()) return fault("boundaries of a solid are no array of shells; the solid is left out.");
        if (elements_of(shells).empty()) return fault("a solid has no shells; it is left out.");
        Shell::Kind kind = Shell::Kind::outer;
        for_each(shells, beside, [&](const element& shell, const Beside& inner) {
            read_shell(shell, inner, kind);
            kind = Shell::Kind::inner;
        });
    }

    void read_shell(const element& surfaces, const Beside& beside, Shell::Kind kind) {
        if (!surfaces.is_array()) return fault("a shell is no array of surfaces; it is left out.");
        surfaces_.begin_shell(kind);
        for_each(surfaces, beside, [&](const element& surface, const Beside& inner) {
            read_surface(surface, inner);
            ++source_index_;
        });
        surfaces_.end_shell();
    }

    void read_surface(const element& rings, const Beside& beside) {
        surfaces_.begin_surface();
        const std::vector<element> items = elements_of(rings);
        bool is_good = rings.is_array();
        if (!is_good) findings_.add(make_finding("SB101", place(), "a surface is no array of rings; it is left out."));
        for (std::size_t i = 0; is_good && i < items.size(); ++i) {
            is_good = read_ring(items[i]);
            if (!is_good) break;
            const std::size_t count = surfaces_.close_ring();
            if (count >= 3) continue;
            findings_.add(short_ring(place(), i == 0, count));
            is_good = i > 0;
        }
        if (is_good && surfaces_.ring_count() == 0) {
            findings_.add(make_finding("SB204", place(), "surface has no ring; left out."));
            is_good = false;
        }
        if (!is_good) {
            surfaces_.drop_surface();
            return;
        }
        Surface& surface = surfaces_.end_surface(source_index_);
        set_semantics(surface, beside.semantics);
        surface.material = beside.material ? material_index(*beside.material) : whole_material_;
        if (beside.texture && !beside.texture->is_null()) set_texture(surface, *beside.texture, items);
    }

    /// Appends the corners; false, with a finding, when they are unusable.
    bool read_ring(const element& ring) {
        simdjson::dom::array array;
        if (ring.get_array().get(array) != simdjson::SUCCESS) {
            findings_.add(
                make_finding("SB101", place(), "a ring is no array of vertex numbers; the surface is left out."));
            return false;
        }
        for (const element e : array) {
            std::int64_t index = -1;
            if (e.get_int64().get(index) != simdjson::SUCCESS) {
                findings_.add(make_finding(
                    "SB101", place(), "a ring holds something else than vertex numbers; the surface is left out."));
                return false;
            }
            if (index < 0 || static_cast<std::size_t>(index) >= context_.vertices.size()) {
                findings_.add(make_finding("SB103", place(),
                                           fmt::format("vertex {} of {} does not exist; the surface is left out.",
                                                       index, context_.vertices.size())));
                return false;
            }
            surfaces_.add_corner(static_cast<std::uint32_t>(index));
        }
        return true;
    }

    void set_semantics(Surface& surface, const Optional& value) {
        if (!value || value->is_null()) return;
        std::int64_t index = -1;
        if (value->get_int64().get(index) != simdjson::SUCCESS || index < 0 ||
            static_cast<std::size_t>(index) >= semantic_types_.size()) {
            if (!is_semantics_reported_) {
                is_semantics_reported_ = true;
                findings_.add(
                    make_finding("SB112", place(),
                                 fmt::format("semantic surface does not exist among {}; its type is inferred.",
                                             semantic_types_.size())));
            }
            return;
        }
        surface.type = semantic_types_[static_cast<std::size_t>(index)];
        has_semantics_ = has_semantics_ || surface.type != SurfaceType::unknown;
    }

    void check_materials(const Optional& themes) {
        simdjson::dom::object object;
        if (!themes || themes->get_object().get(object) != simdjson::SUCCESS) return;
        for (const auto& [name, theme] : object) {
            const std::size_t count = context_.appearance->materials.size();
            if (!are_indices_below(member(theme, "values"), count) ||
                !are_indices_below(member(theme, "value"), count)) {
                findings_.add(
                    make_finding("SB404", where_,
                                 fmt::format("theme '{}' names a material that does not exist among {}; ignored there.",
                                             name, count)));
            }
        }
    }

    std::optional<MaterialId> material_index(const element& value) const {
        std::uint64_t index = 0;
        if (value.get_uint64().get(index) != simdjson::SUCCESS || index >= context_.appearance->materials.size())
            return std::nullopt;
        return MaterialId(static_cast<std::size_t>(index));
    }

    /// Ring by ring: the image's number, then a texture vertex for each corner; [null] means no texture.
    void set_texture(const Surface& surface, const element& values, const std::vector<element>& rings) {
        const CityJsonAppearance& appearance = *context_.appearance;
        const std::vector<element> ring_values = elements_of(values);
        std::vector<Vec2f> uvs;
        std::optional<std::size_t> image;
        const auto misfit = [&](const std::string& what) {
            findings_.add(make_finding("SB403", place(), what + "; the surface is taken without texture."));
        };
        for (std::size_t r = 0; r < ring_values.size(); ++r) {
            const std::vector<element> items = elements_of(ring_values[r]);
            if (items.empty() || items[0].is_null()) {
                if (r == 0) return;
                break;
            }
            if (r >= rings.size())
                return misfit(fmt::format("texture has {} rings, the surface {}", ring_values.size(), rings.size()));
            const std::size_t corners = elements_of(rings[r]).size();
            if (items.size() != corners + 1) {
                return misfit(
                    fmt::format("ring {} has {} corners and {} texture vertices", r, corners, items.size() - 1));
            }
            std::uint64_t index = 0;
            if (items[0].get_uint64().get(index) != simdjson::SUCCESS || index >= appearance.textures.size()) {
                return misfit(fmt::format("image does not exist among {}", appearance.textures.size()));
            }
            if (!image) image = static_cast<std::size_t>(index);
            const std::size_t ring = surface.ring_begin + r;
            // A hole that was left out shifts the rings behind it; such a surface keeps no texture for certain.
            if (ring >= surface.ring_end) return misfit("a ring was left out");
            const std::vector<std::uint32_t>& ring_first = surfaces_.geometry.ring_first;
            const std::size_t kept = ring_first[ring + 1] - ring_first[ring];
            for (std::size_t i = 1; i < items.size(); ++i) {
                std::uint64_t uv = 0;
                if (items[i].get_uint64().get(uv) != simdjson::SUCCESS || uv >= appearance.uvs.size() ||
                    !std::isfinite(appearance.uvs[uv].x) || !std::isfinite(appearance.uvs[uv].y)) {
                    return misfit(fmt::format("texture vertex does not exist among {}", appearance.uvs.size()));
                }
                if (i <= kept) uvs.push_back(appearance.uvs[uv]);
            }
        }
        if (!image) return;
        const std::size_t count = surfaces_.corner_count();
        if (uvs.size() != count)
            return misfit(fmt::format("{} of {} corners have texture vertices", uvs.size(), count));
        surfaces_.set_texture(TextureId(*image), uvs);
    }

    const GeometryContext& context_;
    std::string where_;
    FindingLog& findings_;
    SurfaceBuilder surfaces_;
    std::vector<SurfaceType> semantic_types_;
    std::optional<MaterialId> whole_material_;
    std::uint32_t source_index_ = 0;
    bool has_semantics_ = false;
    bool is_semantics_reported_ = false;
    bool is_material_reported_ = false;
    bool is_texture_reported_ = false;
};

bool is_surface_type(std::string_view type) {
    return type == "MultiSurface" || type == "CompositeSurface" || type == "Solid" || type == "MultiSolid" ||
           type == "CompositeSolid";
}

ReadGeometry read_instance(element instance, const GeometryContext& context, const std::string& where,
                           FindingLog& findings) {
    const auto fault = [&](std::string what) {
        findings.add(make_finding("SB111", where, std::move(what)));
        return ReadGeometry{};
    };
    std::uint64_t index = 0;
    if (instance["template"].get_uint64().get(index) != simdjson::SUCCESS || !context.templates ||
        index >= context.templates->templates.size()) {
        return fault("names no existing template; left out.");
    }
    const std::vector<element> anchors = elements_of(member(instance, "boundaries"));
    std::uint64_t anchor = 0;
    if (anchors.size() != 1 || anchors[0].get_uint64().get(anchor) != simdjson::SUCCESS ||
        anchor >= context.vertices.size()) {
        return fault("its boundaries are not the number of one vertex; left out.");
    }
    std::array<double, 16> m{};  // row by row
    const std::vector<element> matrix = elements_of(member(instance, "transformationMatrix"));
    bool is_matrix = matrix.size() == 16;
    for (std::size_t i = 0; is_matrix && i < 16; ++i) is_matrix = matrix[i].get_double().get(m[i]) == simdjson::SUCCESS;
    if (!is_matrix || m[15] == 0.0) return fault("its transformationMatrix is not 16 numbers of a matrix; left out.");

    context.budget->take(0);  // where it is spent already, nothing more is read
    const GeometryContext inner{context.templates->vertices, context.templates->appearance, nullptr, nullptr};
    ReadGeometry result = read_geometry(context.templates->templates[index], inner, where, findings);
    result.is_from_template = true;
    context.budget->take(result.geometry.corners.size());
    for (Vec3d& p : result.geometry.vertices) {
        const auto row = [&](std::size_t r) {
            return m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
        };
        p = context.vertices[anchor] + Vec3d(row(0), row(1), row(2)) / row(3);
    }
    return result;
}

}  // namespace

std::optional<Lod> read_lod(element geometry) {
    const Optional lod = member(geometry, "lod");
    if (!lod) return std::nullopt;
    std::string_view text;
    if (lod->get_string().get(text) == simdjson::SUCCESS) return parse_lod(text);
    double value = 0.0;
    return lod->get_double().get(value) == simdjson::SUCCESS ? parse_lod(fmt::format("{}", value)) : std::nullopt;
}

ReadGeometry read_geometry(element geometry, const GeometryContext& context, const std::string& where,
                           FindingLog& findings) {
    std::string_view type;
    if (!geometry.is_object() || geometry["type"].get_string().get(type) != simdjson::SUCCESS) {
        findings.add(make_finding("SB101", where, "geometry has no type; left out."));
        return {};
    }
    if (type == "MultiPoint" || type == "MultiLineString") {
        findings.add(make_finding("SB102", where, fmt::format("{} has no surface; left out.", type)));
        return {};
    }
    if (type == "GeometryInstance" && context.templates) return read_instance(geometry, context, where, findings);
    if (!is_surface_type(type)) {
        findings.add(make_finding("SB101", where, fmt::format("geometry type '{}' is unknown here; left out.", type)));
        return {};
    }
    GeometryBuilder builder(context, where, findings);
    builder.read(geometry, type);
    return builder.finish();
}

}  // namespace skybake::io
