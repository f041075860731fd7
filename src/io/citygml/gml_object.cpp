// Based on: OGC City Geography Markup Language (CityGML) 2.0, OGC 12-019; 3.0: OGC 20-010 and 21-006r2.
#include "io/citygml/gml_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "city/finding_codes.h"
#include "io/assembly/city_terms.h"

namespace skybake::io {
namespace {

/// Terms that CityJSON has not, or names otherwise.
constexpr std::array kMoreTerms{
    ObjectTerm{"Room", ObjectType::other, true},
    ObjectTerm{"Storey", ObjectType::other, true},
    ObjectTerm{"HollowSpace", ObjectType::other, true},
    ObjectTerm{"IntBridgeInstallation", ObjectType::other, true},
    ObjectTerm{"IntTunnelInstallation", ObjectType::other, true},
    ObjectTerm{"TransportationComplex", ObjectType::road},
    ObjectTerm{"Track", ObjectType::road},
    ObjectTerm{"Square", ObjectType::square},
    ObjectTerm{"GenericOccupiedSpace", ObjectType::generic},
};

std::optional<ObjectTerm> gml_term(std::string_view name) {
    for (const ObjectTerm& term : kMoreTerms) {
        if (term.name == name) return term;
    }
    return object_term(name);
}

SurfaceType gml_surface_type(std::string_view name) {
    if (name == "WindowSurface") return SurfaceType::window;
    if (name == "DoorSurface") return SurfaceType::door;
    if (name == "Marking" || name == "HoleSurface") return SurfaceType::road;
    return surface_type_from(name);
}

bool is_any_of(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Elements between an object and its surfaces or parts, no objects themselves.
bool is_passage(std::string_view name) {
    return is_any_of(name, {"Section", "Intersection", "TrafficSpace", "AuxiliaryTrafficSpace", "Hole"});
}

bool is_gml_or_citygml(std::string_view space) {
    return space.find("opengis.net") != std::string_view::npos || space.find("citygml.org") != std::string_view::npos;
}

/// What of an object is seen while its properties are gone through.
struct Candidate {
    Lod lod;
    GmlPart part;
};

bool is_nameable(std::string_view name) {
    return is_any_of(name, {"consistsOfBuildingPart", "consistsOfBridgePart", "consistsOfTunnelPart", "buildingPart",
                            "bridgePart", "tunnelPart", "outerBuildingInstallation", "buildingInstallation",
                            "outerBridgeInstallation", "bridgeInstallation", "outerBridgeConstruction",
                            "bridgeConstructiveElement", "buildingConstructiveElement"});
}

/// Reads one object; the objects in it are left for later.
class ObjectReader {
  public:
    ObjectReader(XmlElement feature, const GmlContext& context, const LodChoice& choice, FindingLog& findings)
        : feature_(feature), context_(context), choice_(choice), findings_(findings) {}

    ReadObject read(std::string id, std::string parent_id) {
        ReadObject result;
        result_ = &result;
        CityObject& object = result.object;
        object.id = std::move(id);
        object.parent_id = std::move(parent_id);
        object.where = context_.place(feature_);
        object.type_name = feature_.name();
        const bool is_interior = read_type(object);
        if (const XmlElement lod = feature_.child("lod")) relief_lod_ = parse_lod(lod.text());
        visit(feature_, SurfaceType::unknown, Wants{true, true});
        if (!attributes_.empty())
            object.attributes_json = attributes_.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        for (const Candidate& candidate : candidates_) result.lods.push_back(candidate.lod.text);
        if (is_interior) {
            findings_.add(
                make_finding("SB110", object.where, fmt::format("{} lies indoors; left out.", object.type_name)));
            inner_.clear();
            return result;
        }
        choose(result);
        return result;
    }

    /// The objects that the properties hold.
    const std::vector<XmlElement>& inner() const { return inner_; }

  private:
    struct Wants {
        bool geometry = true;
        bool attributes = false;
    };

    /// Sets the type; true for interior objects.
    bool read_type(CityObject& object) {
        if (const std::optional<ObjectTerm> term = gml_term(object.type_name)) {
            object.type = term->type;
            return term->is_interior;
        }
        object.type = ObjectType::generic;
        if (is_any_of(object.type_name, {"MassPointRelief", "BreaklineRelief", "RasterRelief"})) {
            findings_.add(
                make_finding("SB102", object.where, fmt::format("{} has no surface; left out.", object.type_name)));
            candidates_.clear();
            is_without_surface_ = true;
        } else if (!is_gml_or_citygml(feature_.space())) {
            findings_.add(
                make_finding("SB105", object.where,
                             fmt::format("type '{}' is of an extension; read as a generic object.", object.type_name)));
        } else {
            findings_.add(
                make_finding("SB106", object.where,
                             fmt::format("type '{}' is unknown; read as a generic object.", object.type_name)));
        }
        return false;
    }

    void visit(XmlElement e, SurfaceType type, Wants wants) {
        e.for_each_child([&](XmlElement property) {
            const std::string_view name = property.name();
            if (is_any_of(name, {"appearance", "appearanceMember", "address", "externalReference", "lod",
                                 "metaDataProperty", "groupMember"})) {
                return;
            }
            if (name.size() > 4 && name.substr(0, 3) == "lod" && name[3] >= '0' && name[3] <= '9') {
                if (wants.geometry) add_candidate(property, type);
                return;
            }
            if (name == "tin") {
                if (wants.geometry) add_tin(property);
                return;
            }
            const XmlElement value = property.first_child();
            if (!value) {
                if (wants.attributes) read_leaf(property);
                return;
            }
            if (wants.attributes && read_generic_attribute(property, attributes_)) return;
            property.for_each_child([&](XmlElement inner) { visit_value(inner); });
        });
    }

    void visit_value(XmlElement value) {
        const std::string_view name = value.name();
        if (!is_gml_or_citygml(value.space())) return;  // what extensions add inside is no part of the body
        if (const SurfaceType surface = gml_surface_type(name); surface != SurfaceType::unknown) {
            visit(value, surface, Wants{true, false});
        } else if (is_passage(name)) {
            // The space above a lane is air; its surfaces are what one sees.
            const bool is_air = name.find("Space") != std::string_view::npos;
            visit(value, SurfaceType::unknown, Wants{!is_air, false});
        } else if (gml_term(name) || name.ends_with("Relief")) {
            inner_.push_back(value);
        }
    }

    void add_candidate(XmlElement property, SurfaceType type) {
        const std::string_view name = property.name();
        if (is_without_surface_ || name.find("TerrainIntersection") != std::string_view::npos) return;
        const bool is_flat =
            name.find("FootPrint") != std::string_view::npos || name.find("RoofEdge") != std::string_view::npos;
        if (is_flat && name[3] != '0') return;  // an outline that the surfaces show already
        const XmlElement value = context_.value_of(property, findings_);
        if (!value || !value.first_child()) return;
        if (name.find("Curve") != std::string_view::npos || name.find("Network") != std::string_view::npos ||
            name.find("Point") != std::string_view::npos) {
            findings_.add(
                make_finding("SB102", context_.place(property), fmt::format("{} has no surface; left out.", name)));
            return;
        }
        const std::string lod(1, name[3]);
        candidates_.push_back({*parse_lod(lod), {value, type}});
    }

    void add_tin(XmlElement property) {
        const XmlElement value = context_.value_of(property, findings_);
        if (!value || !value.first_child()) return;
        if (!relief_lod_) {
            findings_.add(
                make_finding("SB118", context_.place(feature_), "its LoD is missing or no number; taken as 1."));
            relief_lod_ = Lod{"1", 1.0};
        }
        candidates_.push_back({*relief_lod_, {value, SurfaceType::unknown}});
    }

    void choose(ReadObject& result) {
        CityObject& object = result.object;
        // A flat footprint is no body; for ground it is all there is to see.
        if (!is_ground(object.type) && !candidates_.empty()) {
            std::erase_if(candidates_, [](const Candidate& c) { return c.lod.value < 1.0; });
            result.has_only_flat = candidates_.empty();
        }
        if (candidates_.empty()) return;
        std::vector<Lod> offered;
        for (const Candidate& candidate : candidates_) offered.push_back(candidate.lod);
        const Lod lod = choose_lod(offered, choice_);
        object.lod = lod.text;
        if (choice_.asked && !fits(lod, *choice_.asked)) {
            findings_.add(make_finding("SB109", object.where,
                                       fmt::format("has no LoD {}; LoD {} is used.", choice_.asked->text, lod.text)));
        }
        std::vector<GmlPart> parts;
        for (const Candidate& candidate : candidates_) {
            if (candidate.lod.value == lod.value) parts.push_back(candidate.part);
        }
        object.geometry = read_gml_geometry(parts, context_, object.where, findings_);
    }

    // --- attributes ---------------------------------------------------------------------------------------------

    static void put(nlohmann::json& into, std::string_view key, nlohmann::json value) {
        nlohmann::json& slot = into[std::string(key)];
        if (slot.is_null()) {
            slot = std::move(value);
        } else if (slot.is_array()) {
            slot.push_back(std::move(value));
        } else {
            slot = nlohmann::json::array({std::move(slot), std::move(value)});
        }
    }

    static nlohmann::json number_or_text(std::string_view text) {
        double value = 0.0;
        const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
        if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size() || !std::isfinite(value))
            return std::string(text);
        std::int64_t whole = 0;
        const auto integer = std::from_chars(text.data(), text.data() + text.size(), whole);
        if (integer.ec == std::errc() && integer.ptr == text.data() + text.size()) return whole;
        return value;
    }

    /// A property with text alone; parts by reference become children.
    void read_leaf(XmlElement property) {
        const std::string_view name = property.name();
        if (const std::string_view reference = property.attribute("href"); !reference.empty()) {
            if (is_nameable(name)) result_->children.emplace_back(local_id(reference));
            return;
        }
        if (property.text().empty()) return;
        const bool is_number = !property.attribute("uom").empty() || name.substr(0, 7) == "storeys" ||
                               name.substr(0, 6) == "yearOf" || name == "measuredHeight";
        put(attributes_, name,
            is_number ? number_or_text(property.text()) : nlohmann::json(std::string(property.text())));
    }

    /// True when the property is one of the generic attributes of 1.0 and 2.0, or holds one of 3.0.
    static bool read_generic_attribute(XmlElement e, nlohmann::json& into) {
        if (e.name() == "genericAttribute") {
            bool is_any = false;
            e.for_each_child([&](XmlElement inner) { is_any = read_generic_attribute(inner, into) || is_any; });
            return is_any;
        }
        const std::string_view kind = e.name();
        if (!is_any_of(kind,
                       {"stringAttribute", "intAttribute", "doubleAttribute", "dateAttribute", "uriAttribute",
                        "measureAttribute", "genericAttributeSet", "StringAttribute", "IntAttribute", "DoubleAttribute",
                        "DateAttribute", "UriAttribute", "MeasureAttribute", "CodeAttribute", "GenericAttributeSet"})) {
            return false;
        }
        std::string_view name = e.attribute("name");
        if (const XmlElement named = e.child("name"); name.empty() && named) name = named.text();
        if (kind.ends_with("AttributeSet")) {
            nlohmann::json set = nlohmann::json::object();
            e.for_each_child([&](XmlElement inner) { read_generic_attribute(inner, set); });
            put(into, name, std::move(set));
            return true;
        }
        const XmlElement value = e.child("value");
        const std::string_view text = value ? value.text() : std::string_view();
        const bool is_number = is_any_of(kind, {"intAttribute", "doubleAttribute", "measureAttribute", "IntAttribute",
                                                "DoubleAttribute", "MeasureAttribute"});
        put(into, name, is_number ? number_or_text(text) : nlohmann::json(std::string(text)));
        return true;
    }

    XmlElement feature_;
    const GmlContext& context_;
    const LodChoice& choice_;
    FindingLog& findings_;
    ReadObject* result_ = nullptr;
    nlohmann::json attributes_ = nlohmann::json::object();
    std::vector<Candidate> candidates_;
    std::vector<XmlElement> inner_;
    std::optional<Lod> relief_lod_;
    bool is_without_surface_ = false;
};

class FeatureReader {
  public:
    FeatureReader(const GmlContext& context, const LodChoice& choice, const std::string& nameless,
                  std::vector<ReadObject>& into, FindingLog& findings)
        : context_(context), choice_(choice), nameless_(nameless), into_(into), findings_(findings) {}

    void read(XmlElement feature, const std::string& parent_id) {
        if (feature.name() == "ReliefFeature") {  // a list of terrain objects
            feature.for_each_child([&](XmlElement property) {
                if (property.name() != "reliefComponent") return;
                property.for_each_child([&](XmlElement inner) { read(inner, parent_id); });
            });
            return;
        }
        std::string id(feature.attribute("id"));
        if (id.empty()) id = count_++ == 0 ? nameless_ : fmt::format("{}.{}", nameless_, count_);
        ObjectReader reader(feature, context_, choice_, findings_);
        into_.push_back(reader.read(id, parent_id));
        for (const XmlElement inner : reader.inner()) read(inner, id);
        if (feature.name() == "CityObjectGroup") {
            feature.for_each_child([&](XmlElement member) {
                if (member.name() != "groupMember") return;
                member.for_each_child([&](XmlElement e) {
                    const XmlElement inner = e.name() == "Role" ? member_of_role(e) : e;
                    if (inner) read(inner, parent_id);
                });
            });
        }
    }

  private:
    static XmlElement member_of_role(XmlElement role) {  // 3.0
        const XmlElement member = role.child("groupMember");
        return member ? member.first_child() : XmlElement();
    }

    const GmlContext& context_;
    const LodChoice& choice_;
    const std::string& nameless_;
    std::vector<ReadObject>& into_;
    FindingLog& findings_;
    std::size_t count_ = 0;
};

}  // namespace

void read_gml_object(XmlElement feature, const GmlContext& context, const LodChoice& choice,
                     const std::string& nameless, std::vector<ReadObject>& into, FindingLog& findings) {
    FeatureReader(context, choice, nameless, into, findings).read(feature, "");
}

}  // namespace skybake::io
