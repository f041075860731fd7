#include "city/families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <unordered_map>

#include "city/combine.h"
#include "city/finding_codes.h"
#include "city/polygon.h"

namespace skybake {
namespace {

double lod_value(const CityObject& object) {
    return std::strtod(object.lod.c_str(), nullptr);
}

std::uint64_t content_key(const CityObject& object) {
    std::uint64_t sum = object.geometry.surfaces.size();
    for (const Surface& surface : object.geometry.surfaces) sum += surface_key(object.geometry, surface);
    return sum;
}

/// What of a body can be compared quickly: its box and the area that it covers from above.
struct Outline {
    Box3d box;
    double covered_m2 = 0.0;

    void add(const Geometry& geometry) {
        for (const Surface& surface : geometry.surfaces) {
            covered_m2 += 0.5 * std::abs(surface_area_vector(geometry, surface).z);  // top and underside
            for (const std::uint32_t corner : ring_of(geometry, surface.ring_begin))
                box.extend(geometry.vertices[corner]);
        }
    }
};

/// Empirical: LoD 1.2 and 2.2 of one building in 3DBAG differ by decimetres in the box and by a few per cent in area.
bool is_same_body(const Outline& a, const Outline& b) {
    if (a.box.is_empty() || b.box.is_empty()) return false;
    const double tolerance = std::max(1.0, 0.05 * glm::length(Vec2d(a.box.size())));
    const Vec3d lo = glm::abs(a.box.lo - b.box.lo);
    const Vec3d hi = glm::abs(a.box.hi - b.box.hi);
    const bool is_same_box = std::max({lo.x, lo.y, hi.x, hi.y}) <= tolerance;
    return is_same_box && std::abs(a.covered_m2 - b.covered_m2) <= 0.25 * std::max(a.covered_m2, b.covered_m2);
}

bool is_part_of(const CityObject& part) {
    return part.type == ObjectType::building_part || part.type_name == "BridgePart" || part.type_name == "TunnelPart";
}

void show_body_once(CityObject& whole, const std::vector<CityObject*>& parts, FindingLog& findings) {
    if (whole.geometry.is_empty()) return;
    Outline of_parts;
    double part_lod = 0.0;
    std::size_t with_geometry = 0;
    for (const CityObject* part : parts) {
        if (part->geometry.is_empty()) continue;
        of_parts.add(part->geometry);
        part_lod = std::max(part_lod, lod_value(*part));
        ++with_geometry;
    }
    if (with_geometry == 0) return;
    Outline of_whole;
    of_whole.add(whole.geometry);
    if (!is_same_body(of_whole, of_parts)) return;
    if (lod_value(whole) > part_lod) {
        findings.add(make_finding(
            "SB114", whole.where,
            fmt::format("its {} parts show the same body at LoD {} as it does at LoD {}; the parts are left out.",
                        with_geometry, part_lod, whole.lod)));
        for (CityObject* part : parts) part->geometry = Geometry();
    } else {
        findings.add(
            make_finding("SB114", whole.where,
                         fmt::format("shows the same body at LoD {} as its {} parts at LoD {}; the parts are used.",
                                     whole.lod, with_geometry, part_lod)));
        whole.geometry = Geometry();
    }
}

}  // namespace

void make_ids_unique(CityModel& city, std::size_t first_object, FindingLog& findings) {
    std::unordered_map<std::string, std::size_t> seen;
    seen.reserve(city.objects.size());
    std::vector<char> is_copy(city.objects.size(), 0);
    for (std::size_t i = 0; i < city.objects.size(); ++i) {
        CityObject& object = city.objects[i];
        const auto [entry, is_new] = seen.emplace(object.id, i);
        if (is_new) continue;
        const CityObject& first = city.objects[entry->second];
        if (i >= first_object && object.geometry.surfaces.size() == first.geometry.surfaces.size() &&
            content_key(object) == content_key(first)) {
            findings.add(
                make_finding("SB104", object.where,
                             fmt::format("is there twice with the same surfaces (first in {}); the second is left out.",
                                         first.where)));
            is_copy[i] = 1;
            continue;
        }
        std::string id;
        for (std::size_t number = 2;; ++number) {
            id = fmt::format("{}#{}", object.id, number);
            if (seen.emplace(id, i).second) break;
        }
        findings.add(
            make_finding("SB104", object.where,
                         fmt::format("is there twice with different surfaces (first in {}); the second is called '{}'.",
                                     first.where, id)));
        object.id = id;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < city.objects.size(); ++i) {
        if (is_copy[i]) continue;
        if (kept != i) city.objects[kept] = std::move(city.objects[i]);
        ++kept;
    }
    city.objects.resize(kept);
}

void resolve_families(CityModel& city, std::size_t first_object, const std::vector<char>& has_only_flat,
                      FindingLog& findings) {
    const std::size_t count = city.objects.size() - first_object;
    std::unordered_map<std::string_view, std::size_t> by_id;
    by_id.reserve(count);
    for (std::size_t i = 0; i < count; ++i) by_id.emplace(city.objects[first_object + i].id, i);
    std::vector<std::vector<CityObject*>> parts(count);
    std::vector<char> has_body(count, 0);  // the object or one of its children shows more than a flat footprint
    for (std::size_t i = 0; i < count; ++i) {
        CityObject& object = city.objects[first_object + i];
        if (!object.geometry.is_empty()) has_body[i] = 1;
        if (object.parent_id.empty()) continue;
        const auto parent = by_id.find(object.parent_id);
        if (parent == by_id.end()) {
            findings.add(make_finding(
                "SB115", object.where,
                fmt::format("its parent '{}' is not in the file; taken as an object of its own.", object.parent_id)));
            object.parent_id.clear();
            continue;
        }
        if (city.objects[first_object + parent->second].type_name ==
            "CityObjectGroup") {  // a list of objects, no body of parts
            object.parent_id.clear();
            continue;
        }
        if (!object.geometry.is_empty()) has_body[parent->second] = 1;
        if (is_part_of(object)) parts[parent->second].push_back(&object);
    }
    for (std::size_t i = 0; i < count; ++i) {
        CityObject& object = city.objects[first_object + i];
        if (has_only_flat[i] && !has_body[i]) {
            const auto parent = by_id.find(object.parent_id);
            if (object.parent_id.empty() || !has_body[parent->second]) {
                findings.add(make_finding("SB108", object.where, "offers a flat LoD 0 only; left out."));
            }
        }
        if (!parts[i].empty()) show_body_once(object, parts[i], findings);
    }
}

}  // namespace skybake
