// Based on: ISO 19136 (GML 3.1.1 and 3.2), clause 10 (geometric primitives) and 11 (aggregates); CityGML 2.0, OGC
// 12-019, clause 8.3 (implicit geometries).
#include "io/citygml/gml_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/hash_rng.h"
#include "city/combine.h"
#include "city/finding_codes.h"
#include "io/assembly/surface_builder.h"
#include "io/citygml/gml_numbers.h"

namespace skybake::io {
namespace {

/// References that lead to references: real files have two or three.
constexpr int kMostHops = 32;
/// References to curves within one ring.
constexpr int kMostCurves = 1000;

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_polygon(std::string_view name) {
    return is_one_of(name, {"Polygon", "PolygonPatch", "Triangle", "Rectangle"});
}

bool is_surface_set(std::string_view name) {
    return is_one_of(name, {"MultiSurface", "CompositeSurface", "Shell", "Surface", "PolyhedralSurface",
                            "TriangulatedSurface", "Tin", "MultiGeometry", "GeometricComplex"});
}

bool is_solid(std::string_view name) {
    return is_one_of(name, {"Solid", "CompositeSolid", "MultiSolid"});
}

bool is_surface_member(std::string_view name) {
    return is_one_of(name, {"surfaceMember", "surfaceMembers", "patches", "polygonPatches", "trianglePatches",
                            "geometryMember", "geometryMembers", "element"});
}

bool is_without_surface(std::string_view name) {
    return is_one_of(name, {"Point", "MultiPoint", "LineString", "MultiCurve", "MultiLineString", "Curve",
                            "CompositeCurve", "OrientableCurve", "LinearRing", "Ring"});
}

struct NodeKey {
    const XmlTree* tree = nullptr;
    std::uint32_t node = 0;
    const void* placement = nullptr;
    friend bool operator==(const NodeKey&, const NodeKey&) = default;
};
struct NodeHash {
    std::size_t operator()(const NodeKey& key) const {
        const auto tree = static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(key.tree));
        const auto placement = static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(key.placement));
        return static_cast<std::size_t>(hash_combine(hash_combine(tree, key.node), placement));
    }
};

struct PositionHash {
    std::size_t operator()(const Vec3d& p) const {
        const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
        return static_cast<std::size_t>(hash_combine(hash_combine(bits(p.x), bits(p.y)), bits(p.z)));
    }
};
struct SamePosition {
    bool operator()(const Vec3d& a, const Vec3d& b) const {
        return std::bit_cast<std::array<std::uint64_t, 3>>(a) == std::bit_cast<std::array<std::uint64_t, 3>>(b);
    }
};

/// Where an implicit geometry's own coordinates go: row by row, then the reference point.
struct Placement {
    std::array<double, 16> m{};
    Vec3d reference{0.0};

    Vec3d operator()(const Vec3d& p) const {
        const auto row = [&](std::size_t r) {
            return m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
        };
        return reference + Vec3d(row(0), row(1), row(2)) / row(3);
    }
};

/// What holds for an element and all below it.
struct State {
    SurfaceType type = SurfaceType::unknown;
    int dimension = 3;
    bool is_reversed = false;
    int hops = 0;
    const Placement* placement = nullptr;
    std::optional<MaterialId> material;
    std::optional<std::uint32_t> projected;
};

/// The types that thematic surfaces give to polygons, which solids may refer to.
using PolygonTypes = std::unordered_map<NodeKey, SurfaceType, NodeHash>;
using PolygonSet = std::unordered_set<NodeKey, NodeHash>;

/// Appends surfaces to a geometry.
class GeometryBuilder {
  public:
    GeometryBuilder(const GmlContext& context, const PolygonTypes& types, FindingLog& findings)
        : context_(context), types_(types), findings_(findings) {}

    void begin_shell(Shell::Kind kind) {
        surfaces_.begin_shell(kind);
        in_shell_.clear();
    }
    void end_shell() { surfaces_.end_shell(); }

    /// Solids, and nothing else.
    void read_solids(XmlElement e, State state) {
        inherit(e, state);
        if (e.name() == "Solid") {
            if (!solids_.insert(key_of(e, state)).second) return;
            e.for_each_child([&](XmlElement p) {
                if (p.name() != "exterior" && p.name() != "interior") return;
                begin_shell(p.name() == "exterior" ? Shell::Kind::outer : Shell::Kind::inner);
                read_value(p, state, [&](XmlElement value, const State& s) { read_surfaces(value, s, nullptr); });
                end_shell();
            });
            return;
        }
        if (!holds_solids(e) || !solids_.insert(key_of(e, state)).second) return;
        e.for_each_child([&](XmlElement p) {
            if (!is_one_of(p.name(), {"solidMember", "solidMembers", "geometryMember", "geometryMembers"})) return;
            read_value(p, state, [&](XmlElement value, const State& s) { read_solids(value, s); });
        });
    }

    /// Surfaces outside solids; those of `known` are left out.
    void read_surfaces(XmlElement e, State state, const PolygonSet* known) {
        inherit(e, state);
        const std::string_view name = e.name();
        if (is_polygon(name)) {
            read_polygon(e, state, known);
            return;
        }
        // A set of surfaces once a shell, however often it is named: names of names could grow without bound.
        if (!in_shell_.insert(key_of(e, state)).second) return;
        if (is_surface_set(name)) {
            e.for_each_child([&](XmlElement p) {
                if (!is_surface_member(p.name())) return;
                read_value(p, state, [&](XmlElement value, const State& s) { read_surfaces(value, s, known); });
            });
            if (name == "Tin" && !e.child("trianglePatches") && !e.child("patches")) {
                findings_.add(make_finding("SB101", context_.place(e),
                                           "a Tin of control points without triangles; left out. Export triangles."));
            }
        } else if (name == "OrientableSurface" || name == "TexturedSurface") {
            if (e.attribute("orientation") == "-") state.is_reversed = !state.is_reversed;
            if (const XmlElement base = e.child("baseSurface"))
                read_value(base, state, [&](XmlElement value, const State& s) { read_surfaces(value, s, known); });
        } else if (is_without_surface(name)) {
            findings_.add(make_finding("SB102", context_.place(e), fmt::format("{} has no surface; left out.", name)));
        } else if (!holds_solids(e)) {
            findings_.add(make_finding("SB101", context_.place(e),
                                       fmt::format("geometry '{}' is unknown here; left out.", name)));
        }
    }

    Geometry finish() { return surfaces_.finish(); }
    const PolygonSet& used() const { return used_; }
    void number_from(std::uint32_t source_index) { source_index_ = source_index; }
    std::uint32_t next_number() const { return source_index_; }

  private:
    static NodeKey key_of(XmlElement e, const State& state) { return {e.tree(), e.node(), state.placement}; }

    void inherit(XmlElement e, State& state) const {
        if (const std::string_view text = e.attribute("srsDimension"); text == "2" || text == "3")
            state.dimension = text[0] - '0';
        if (const std::string_view id = e.attribute("id"); !id.empty()) {
            if (const SurfaceWear* wear = context_.appearance->surface(id)) {
                if (wear->material) state.material = wear->material;
                if (wear->projected) state.projected = wear->projected;
            }
        }
    }

    /// Calls `f` for each element that the property holds, or for the one that it refers to.
    template <typename F>
    void read_value(XmlElement property, const State& state, F&& f) {
        if (property.first_child()) {
            property.for_each_child([&](XmlElement e) { f(e, state); });
            return;
        }
        const std::string_view reference = property.attribute("href");
        if (reference.empty()) return;
        const XmlElement target = context_.resolve(reference, property, findings_);
        if (!target) return;
        State inner = state;
        if (++inner.hops > kMostHops) {
            findings_.add(make_finding("SB120", context_.place(property),
                                       fmt::format("the reference '{}' goes round in a circle; left out.", reference)));
            return;
        }
        f(target, inner);
    }

    void read_polygon(XmlElement e, const State& state, const PolygonSet* known) {
        const NodeKey key = key_of(e, state);
        if (known && (known->count(key) > 0 || used_.count(key) > 0)) return;
        used_.insert(key);
        const std::uint32_t number = source_index_++;
        surfaces_.begin_surface();
        bool is_good = true;
        std::vector<RingPlace> rings;
        e.for_each_child([&](XmlElement p) {
            const bool is_outer = p.name() == "exterior" || p.name() == "outerBoundaryIs";
            if (!is_good || (!is_outer && p.name() != "interior" && p.name() != "innerBoundaryIs")) return;
            if (is_outer != rings.empty()) {
                findings_.add(make_finding("SB101", context_.place(e),
                                           is_outer ? "polygon has two outer rings; left out."
                                                    : "a hole comes before the outer ring; left out."));
                is_good = false;
                return;
            }
            XmlElement ring = p.first_child();
            if (!ring && !p.attribute("href").empty()) ring = context_.resolve(p.attribute("href"), p, findings_);
            const std::size_t first = surfaces_.geometry.corners.size();
            is_good = !ring || read_ring(ring, state);
            if (!is_good) return;
            const std::size_t count = surfaces_.close_ring();
            if (count >= 3) {
                rings.push_back({ring.attribute("id"), first, count, stated_});
                return;
            }
            findings_.add(short_ring(context_.place(e), is_outer, count));
            is_good = !is_outer;
        });
        if (is_good && rings.empty()) {
            findings_.add(make_finding("SB204", context_.place(e), "surface has no ring; left out."));
            is_good = false;
        }
        if (!is_good) {
            surfaces_.drop_surface();
            return;
        }
        Surface& surface = surfaces_.end_surface(number);
        surface.type = state.type;
        if (const auto found = types_.find(key); surface.type == SurfaceType::unknown && found != types_.end())
            surface.type = found->second;
        surface.material = state.material;
        set_texture(e, state, rings);
        if (state.is_reversed) surfaces_.reverse_surface();
    }

    struct RingPlace {
        std::string_view id;
        std::size_t first = 0;
        std::size_t count = 0;   // of corners
        std::size_t stated = 0;  // of positions in the file: the first one comes again at the end, in some files twice
    };

    /// Appends the ring's positions as corners; false, with a finding, when it holds something else.
    bool read_ring(XmlElement ring, const State& state) {
        numbers_.clear();
        State inner = state;
        if (!read_positions(ring, inner, numbers_)) {
            findings_.add(make_finding("SB101", context_.place(ring),
                                       "its positions are no list of numbers; the surface is left out."));
            return false;
        }
        const auto dimension = static_cast<std::size_t>(inner.dimension);
        if (numbers_.size() % dimension != 0) {
            findings_.add(make_finding("SB101", context_.place(ring),
                                       fmt::format("{} numbers are no whole positions of {}; the surface is left out.",
                                                   numbers_.size(), dimension)));
            return false;
        }
        stated_ = numbers_.size() / dimension;
        context_.budget->take(stated_);
        std::vector<Vec3d>& vertices = surfaces_.geometry.vertices;
        for (std::size_t i = 0; i + dimension <= numbers_.size(); i += dimension) {
            Vec3d p(numbers_[i], numbers_[i + 1], dimension == 3 ? numbers_[i + 2] : 0.0);
            if (state.placement) p = (*state.placement)(p);
            const auto [entry, is_new] = vertices_.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(p);
            surfaces_.add_corner(entry->second);
        }
        return true;
    }

    /// The numbers of all positions below `e`, in order. `state` takes the dimension that is stated there.
    bool read_positions(XmlElement e, State& state, std::vector<double>& into) {
        if (const std::string_view text = e.attribute("srsDimension"); text == "2" || text == "3") {
            state.dimension = text[0] - '0';
        } else if (const std::string_view old = e.attribute("dimension"); old == "2" || old == "3") {
            state.dimension = old[0] - '0';
        }
        const std::string_view name = e.name();
        if (name == "posList" || name == "pos") return read_numbers(e.text(), into);
        if (name == "coordinates") return read_numbers(e.text(), into, ',');
        bool is_good = true;
        if (name == "OrientableCurve" && e.attribute("orientation") == "-") {
            std::vector<double> part;
            e.for_each_child([&](XmlElement c) { is_good = is_good && read_positions(c, state, part); });
            const auto dimension = static_cast<std::size_t>(state.dimension);
            for (std::size_t i = part.size() / dimension; i-- > 0;)
                into.insert(into.end(), part.begin() + static_cast<std::ptrdiff_t>(i * dimension),
                            part.begin() + static_cast<std::ptrdiff_t>((i + 1) * dimension));
            return is_good;
        }
        if (!e.first_child() && !e.attribute("href").empty()) {
            const XmlElement target =
                ++state.hops > kMostCurves ? XmlElement() : context_.resolve(e.attribute("href"), e, findings_);
            return target && read_positions(target, state, into);
        }
        e.for_each_child([&](XmlElement c) { is_good = is_good && read_positions(c, state, into); });
        return is_good;
    }

    void set_texture(XmlElement e, const State& state, const std::vector<RingPlace>& rings) {
        const auto misfit = [&](const std::string& what) {
            findings_.add(make_finding("SB403", context_.place(e), what + "; the surface is taken without texture."));
        };
        std::vector<Vec2f> uvs;
        const RingTexture* outer = rings[0].id.empty() ? nullptr : context_.appearance->ring(rings[0].id);
        if (outer) {
            for (const RingPlace& ring : rings) {
                const RingTexture* texture = ring.id.empty() ? nullptr : context_.appearance->ring(ring.id);
                if (!texture) return misfit("a hole has no texture coordinates");
                // Some writers leave out the coordinates of the repeated corner.
                if (texture->uv_count != ring.stated && texture->uv_count != ring.count) {
                    return misfit(fmt::format("a ring has {} positions and {} texture coordinates", ring.stated,
                                              texture->uv_count));
                }
                const std::span<const Vec2f> of_ring = context_.appearance->uvs(*texture);
                uvs.insert(uvs.end(), of_ring.begin(), of_ring.begin() + static_cast<std::ptrdiff_t>(ring.count));
            }
            surfaces_.set_texture(outer->texture, uvs);
        } else if (state.projected) {
            const ProjectedTexture& texture = context_.appearance->projected(*state.projected);
            const Geometry& geometry = surfaces_.geometry;
            const std::array<double, 12>& m = texture.m;
            for (std::size_t i = rings[0].first; i < geometry.corners.size(); ++i) {
                const Vec3d& p = geometry.vertices[geometry.corners[i]];
                const auto row = [&](std::size_t r) {
                    return m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
                };
                const Vec2d uv = Vec2d(row(0), row(1)) / row(2);
                if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return misfit("its projection has no finite place");
                uvs.emplace_back(static_cast<float>(uv.x), static_cast<float>(uv.y));
            }
            surfaces_.set_texture(texture.texture, uvs);
        }
    }

    const GmlContext& context_;
    const PolygonTypes& types_;
    FindingLog& findings_;
    SurfaceBuilder surfaces_;
    std::vector<double> numbers_;
    std::unordered_map<Vec3d, std::uint32_t, PositionHash, SamePosition> vertices_;
    PolygonSet used_;
    PolygonSet solids_;       // solids and sets of them that were read
    PolygonSet in_shell_;     // sets of surfaces that were read in this shell
    std::size_t stated_ = 0;  // positions of the ring read last
    std::uint32_t source_index_ = 0;
};

/// Notes the type of each polygon that a thematic surface holds or names.
class TypeNotes {
  public:
    TypeNotes(const GmlContext& context, PolygonTypes& types) : context_(context), types_(types) {}

    void note(XmlElement e, SurfaceType type, int hops = 0) {
        if (is_polygon(e.name())) {
            types_.emplace(NodeKey{e.tree(), e.node(), nullptr}, type);
            return;
        }
        if (hops > 0 && !seen_.insert({e.tree(), e.node(), nullptr}).second) return;
        e.for_each_child([&](XmlElement c) {
            if (!c.first_child() && !c.attribute("href").empty()) {
                FindingLog unsaid;  // it is told when the surfaces are read
                const XmlElement target = context_.resolve(c.attribute("href"), c, unsaid);
                if (target && hops < kMostHops) note(target, type, hops + 1);
            } else {
                note(c, type, hops);
            }
        });
    }

  private:
    const GmlContext& context_;
    PolygonTypes& types_;
    PolygonSet seen_;
};

/// The relative geometry of an ImplicitGeometry with its placement; none, with finding SB111, when it has none.
XmlElement implicit_geometry(XmlElement implicit, const GmlContext& context, Placement& placement,
                             FindingLog& findings) {
    const auto fault = [&](std::string what) {
        findings.add(make_finding("SB111", context.place(implicit), std::move(what)));
        return XmlElement();
    };
    if (context.is_geographic)
        return fault("an implicit geometry in metres stands in a file in degrees, which is not supported; left out.");
    placement.m = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (const XmlElement matrix = implicit.child("transformationMatrix")) {
        std::vector<double> numbers;
        if (!read_numbers(matrix.text(), numbers) || numbers.size() != 16 || numbers[15] == 0.0)
            return fault("its transformationMatrix is not 16 numbers of a matrix; left out.");
        std::copy(numbers.begin(), numbers.end(), placement.m.begin());
    }
    XmlElement point = implicit.child("referencePoint");
    if (point) point = context.value_of(point, findings);
    std::vector<double> numbers;
    XmlElement position = point ? point.child("pos") : XmlElement();
    if (point && !position) position = point.child("coordinates");
    if (!position || !read_numbers(position.text(), numbers, ',') || numbers.size() < 2 || numbers.size() > 3)
        return fault("its referencePoint is not a point of three numbers; left out.");
    placement.reference = {numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 0.0};
    XmlElement holder = implicit.child("relativeGMLGeometry");
    if (!holder) holder = implicit.child("relativeGeometry");
    if (!holder) {
        const XmlElement library = implicit.child("libraryObject");
        return fault(fmt::format("its shape '{}' is a file of its own, which is not read; left out.",
                                 library ? library.text() : ""));
    }
    return context.value_of(holder, findings);
}

}  // namespace

XmlElement GmlContext::resolve(std::string_view reference, XmlElement from, FindingLog& findings) const {
    const std::string_view id = local_id(reference);
    if (!id.empty()) {
        if (const auto found = ids.find(id); found != ids.end()) return found->second;
        if (const auto found = library->find(std::string(id)); found != library->end()) return found->second;
    }
    findings.add(make_finding("SB120", place(from),
                              id.empty() ? fmt::format("refers to '{}' in another file; left out.", reference)
                                         : fmt::format("refers to '{}', which is not in the file; left out.", id)));
    return {};
}

XmlElement GmlContext::value_of(XmlElement property, FindingLog& findings) const {
    if (const XmlElement value = property.first_child()) return value;
    const std::string_view reference = property.attribute("href");
    return reference.empty() ? XmlElement() : resolve(reference, property, findings);
}

std::string GmlContext::place(XmlElement e) const {
    const std::string_view id = e.attribute("id");
    return id.empty() ? fmt::format("{}: line {}: {}", file, e.line(), e.name())
                      : fmt::format("{}: line {}: {} '{}'", file, e.line(), e.name(), id);
}

bool is_geometry_property(std::string_view name) {
    return name.substr(0, 3) == "lod" || name == "tin" || is_surface_member(name) ||
           is_one_of(name, {"solidMember", "solidMembers", "exterior", "interior", "baseSurface", "curveMember",
                            "baseCurve", "relativeGMLGeometry", "relativeGeometry", "referencePoint", "pointProperty"});
}

bool holds_solids(XmlElement e) {
    return is_solid(e.name()) || is_one_of(e.name(), {"MultiGeometry", "GeometricComplex"});
}

Geometry read_gml_geometry(const std::vector<GmlPart>& parts, const GmlContext& context, const std::string& where,
                           FindingLog& findings) {
    PolygonTypes types;
    TypeNotes notes(context, types);
    std::vector<Placement> placements(parts.size());  // outlive the builders, and never move
    std::vector<std::pair<XmlElement, State>> geometries;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        State state;
        state.type = parts[i].type;
        XmlElement geometry = parts[i].geometry;
        if (geometry.name() == "ImplicitGeometry") {
            geometry = implicit_geometry(geometry, context, placements[i], findings);
            state.placement = &placements[i];
        } else if (state.type != SurfaceType::unknown) {
            notes.note(geometry, state.type);
        }
        if (geometry) geometries.emplace_back(geometry, state);
    }
    GeometryBuilder solids(context, types, findings);
    for (const auto& [geometry, state] : geometries) solids.read_solids(geometry, state);
    GeometryBuilder loose(context, types, findings);
    loose.number_from(solids.next_number());
    loose.begin_shell(Shell::Kind::loose);
    // Thematic surfaces first: what the object's own set names again is known by then, with its type.
    for (const bool is_thematic : {true, false}) {
        for (const auto& [geometry, state] : geometries) {
            if ((state.type != SurfaceType::unknown) == is_thematic)
                loose.read_surfaces(geometry, state, &solids.used());
        }
    }
    loose.end_shell();
    Geometry geometry = solids.finish();
    const Geometry others = loose.finish();
    if (geometry.is_empty()) return others;
    if (others.is_empty()) return geometry;
    const std::uint32_t twice = combine(geometry, others);
    if (twice > 0) {
        findings.add(make_finding(
            "SB202", where,
            fmt::format("{} surfaces are there already; they are used once, with what is known of both.", twice)));
    }
    return geometry;
}

}  // namespace skybake::io
