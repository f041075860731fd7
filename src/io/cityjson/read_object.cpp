#include "io/cityjson/read_object.h"

#include <fmt/format.h>

#include <algorithm>

#include "city/combine.h"
#include "city/finding_codes.h"
#include "io/assembly/city_terms.h"

namespace skybake::io {
namespace {

using simdjson::dom::element;

struct Candidate {
    element geometry;
    std::size_t index = 0;  // in the object's list
    Lod lod;
    bool is_solid = false;
};

std::vector<Candidate> candidates_of(element object, const GeometryContext& context, const std::string& where,
                                     FindingLog& findings) {
    std::vector<Candidate> candidates;
    element list;
    if (object["geometry"].get(list) != simdjson::SUCCESS || list.is_null()) return candidates;
    simdjson::dom::array array;
    if (list.get_array().get(array) != simdjson::SUCCESS) {
        findings.add(make_finding("SB101", where, "geometry is no array; left out."));
        return candidates;
    }
    std::size_t index = 0;
    for (const element geometry : array) {
        Candidate candidate{geometry, index++, {}, false};
        const std::string place = fmt::format("{}/geometry/{}", where, candidate.index);
        std::string_view type;
        if (!geometry.is_object() || geometry["type"].get_string().get(type) != simdjson::SUCCESS) {
            findings.add(make_finding("SB101", place, "geometry has no type; left out."));
            continue;
        }
        if (type == "MultiPoint" || type == "MultiLineString") {
            findings.add(make_finding("SB102", place, fmt::format("{} has no surface; left out.", type)));
            continue;
        }
        element holder = geometry;
        std::uint64_t number = 0;
        if (type == "GeometryInstance" && context.templates &&
            geometry["template"].get_uint64().get(number) == simdjson::SUCCESS &&
            number < context.templates->templates.size()) {
            holder = context.templates->templates[number];
        }
        candidate.is_solid = type.find("Solid") != std::string_view::npos;
        if (const auto lod = holder.is_object() ? read_lod(holder) : std::nullopt) {
            candidate.lod = *lod;
        } else {
            findings.add(make_finding("SB118", place, "its LoD is missing or no number; taken as 1."));
            candidate.lod = {"1", 1.0};
        }
        candidates.push_back(candidate);
    }
    return candidates;
}

void read_strings(element object, std::string_view key, std::vector<std::string>& into) {
    simdjson::dom::array array;
    if (object[key].get_array().get(array) != simdjson::SUCCESS) return;
    for (const element e : array) {
        std::string_view text;
        if (e.get_string().get(text) == simdjson::SUCCESS) into.emplace_back(text);
    }
}

/// Sets the type; true for interior objects.
bool read_type(element e, CityObject& object, FindingLog& findings) {
    std::string_view name;
    if (e["type"].get_string().get(name) != simdjson::SUCCESS) {
        findings.add(make_finding("SB101", object.where, "object has no type; read as a generic object."));
        object.type = ObjectType::generic;
        return false;
    }
    const bool is_extension = name.substr(0, 1) == "+";
    object.type_name = name.substr(is_extension ? 1 : 0);
    const std::optional<ObjectTerm> term = object_term(object.type_name);
    if (is_extension) {
        findings.add(make_finding("SB105", object.where,
                                  fmt::format("type '{}' is of an extension; read as a generic object.", name)));
        object.type = ObjectType::generic;
        return false;
    }
    if (!term) {
        findings.add(
            make_finding("SB106", object.where, fmt::format("type '{}' is unknown; read as a generic object.", name)));
        object.type = ObjectType::generic;
        return false;
    }
    object.type = term->type;
    return term->is_interior;
}

}  // namespace

ReadObject read_object(std::string_view id, element e, const GeometryContext& context, const LodChoice& choice,
                       const std::string& where, FindingLog& findings) {
    ReadObject result;
    CityObject& object = result.object;
    object.id = id;
    object.where = where;
    if (!e.is_object()) {
        findings.add(make_finding("SB101", where, "city object is no JSON object; left out."));
        return result;
    }
    const bool is_interior = read_type(e, object, findings);
    read_strings(e, "children", result.children);
    std::vector<std::string> parents;
    read_strings(e, "parents", parents);
    if (!parents.empty()) object.parent_id = parents.front();
    element attributes;
    if (e["attributes"].get(attributes) == simdjson::SUCCESS && attributes.is_object())
        object.attributes_json = simdjson::minify(attributes);

    std::vector<Candidate> candidates = candidates_of(e, context, where, findings);
    for (const Candidate& candidate : candidates) result.lods.push_back(candidate.lod.text);
    if (is_interior) {
        if (!candidates.empty())
            findings.add(make_finding("SB110", where, fmt::format("{} lies indoors; left out.", object.type_name)));
        return result;
    }
    // A flat footprint is no body; for ground it is all there is to see.
    if (!is_ground(object.type) && !candidates.empty()) {
        std::erase_if(candidates, [](const Candidate& c) { return c.lod.value < 1.0; });
        result.has_only_flat = candidates.empty();
    }
    if (candidates.empty()) return result;

    std::vector<Lod> offered;
    for (const Candidate& candidate : candidates) offered.push_back(candidate.lod);
    const Lod lod = choose_lod(offered, choice);
    object.lod = lod.text;
    if (choice.asked && !fits(lod, *choice.asked)) {
        findings.add(
            make_finding("SB109", where, fmt::format("has no LoD {}; LoD {} is used.", choice.asked->text, lod.text)));
    }
    std::erase_if(candidates, [&](const Candidate& c) { return c.lod.value != lod.value; });
    // Solids first: a shell that also comes as loose surfaces stays a shell, and only takes over their semantics.
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.is_solid > b.is_solid; });
    bool is_first = true;
    for (const Candidate& candidate : candidates) {
        const std::string place = fmt::format("{}/geometry/{}", where, candidate.index);
        ReadGeometry read = read_geometry(candidate.geometry, context, place, findings);
        if (read.geometry.is_empty()) continue;
        if (is_first) {
            result.is_appearance_of_templates = read.is_from_template;
            object.geometry = std::move(read.geometry);
            is_first = false;
            continue;
        }
        if (read.is_from_template != result.is_appearance_of_templates) {
            for (Surface& surface : read.geometry.surfaces) {
                surface.material.reset();
                surface.texture.reset();
            }
        }
        const std::uint32_t twice = combine(object.geometry, read.geometry);
        if (twice > 0) {
            findings.add(make_finding(
                "SB202", place,
                fmt::format("{} surfaces are there already at LoD {}; they are used once, with what is known of both.",
                            twice, lod.text)));
        }
    }
    return result;
}

}  // namespace skybake::io
