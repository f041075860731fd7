#include "city/select.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "city/combine.h"
#include "city/finding_codes.h"
#include "city/polygon.h"

namespace skybake {
namespace {

constexpr double kSamePlace =
    0.05;  // metres; writers round to millimetres, systems are brought together to centimetres
constexpr double kSameArea = 0.01;

struct Body {
    std::size_t object = 0;
    Box3d box;
    double area = 0.0;
};

Body body_of(const CityModel& city, std::size_t index) {
    Body body{index, {}, 0.0};
    const Geometry& g = city.objects[index].geometry;
    for (const std::uint32_t corner : g.corners) body.box.extend(g.vertices[corner]);
    for (const Surface& surface : g.surfaces) body.area += glm::length(surface_area_vector(g, surface));
    return body;
}

bool is_same(const Body& a, const Body& b) {
    const Vec3d lo = glm::abs(a.box.lo - b.box.lo), hi = glm::abs(a.box.hi - b.box.hi);
    return std::max({lo.x, lo.y, lo.z, hi.x, hi.y, hi.z}) <= kSamePlace &&
           std::abs(a.area - b.area) <= kSameArea * std::max(a.area, b.area);
}

/// For each object the topmost one above it; circles of strangers end at their first.
std::vector<std::size_t> roots_of(const CityModel& city) {
    std::unordered_map<std::string_view, std::size_t> by_id;
    for (std::size_t i = 0; i < city.objects.size(); ++i) by_id.emplace(city.objects[i].id, i);
    std::vector<std::size_t> roots(city.objects.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
        std::size_t at = i;
        for (std::size_t step = 0; step < city.objects.size(); ++step) {
            const auto parent = by_id.find(city.objects[at].parent_id);
            if (city.objects[at].parent_id.empty() || parent == by_id.end() || parent->second == i) break;
            at = parent->second;
        }
        roots[i] = at;
    }
    return roots;
}

/// Removes the objects that are not to be kept; returns how many went.
std::size_t keep_objects(CityModel& city, const std::vector<char>& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < city.objects.size(); ++i) {
        if (!keep[i]) continue;
        if (kept != i) city.objects[kept] = std::move(city.objects[i]);
        ++kept;
    }
    const std::size_t gone = city.objects.size() - kept;
    city.objects.resize(kept);
    return gone;
}

bool contains(const Box2d& box, const Vec2d& p) {
    return p.x >= box.lo.x && p.x <= box.hi.x && p.y >= box.lo.y && p.y <= box.hi.y;
}

}  // namespace

void drop_duplicates(CityModel& city, std::size_t first_object, FindingLog& findings) {
    std::vector<Body> earlier;
    for (std::size_t i = 0; i < first_object; ++i) {
        if (!city.objects[i].geometry.is_empty() && !is_ground(city.objects[i].type))
            earlier.push_back(body_of(city, i));
    }
    std::sort(earlier.begin(), earlier.end(), [](const Body& a, const Body& b) { return a.box.lo.x < b.box.lo.x; });
    for (std::size_t i = first_object; i < city.objects.size(); ++i) {
        CityObject& object = city.objects[i];
        if (object.geometry.is_empty() || is_ground(object.type)) continue;
        const Body body = body_of(city, i);
        auto other = std::lower_bound(earlier.begin(), earlier.end(), body.box.lo.x - kSamePlace,
                                      [](const Body& b, double x) { return b.box.lo.x < x; });
        for (; other != earlier.end() && other->box.lo.x <= body.box.lo.x + kSamePlace; ++other) {
            const CityObject& known = city.objects[other->object];
            if (known.type != object.type || !is_same(*other, body)) continue;
            findings.add(make_finding("SB217", object.where, fmt::format("is '{}' again; left out.", known.id)));
            object.geometry = Geometry();
            break;
        }
    }
}

void keep_within(CityModel& city, const Box2d& box, FindingLog& findings) {
    const std::vector<std::size_t> roots = roots_of(city);
    std::vector<Box3d> boxes(city.objects.size());
    for (std::size_t i = 0; i < roots.size(); ++i) boxes[roots[i]].extend(body_of(city, i).box);
    std::vector<char> keep(city.objects.size(), 0);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const Box3d& family = boxes[roots[i]];
        CityObject& object = city.objects[i];
        if (!is_ground(object.type)) {
            keep[i] = !family.is_empty() && contains(box, Vec2d(family.center()));
            continue;
        }
        const Geometry& g = object.geometry;
        std::vector<char> inside;
        for (const Surface& surface : g.surfaces) {
            Box3d extent;
            for (const std::uint32_t corner : ring_of(g, surface.ring_begin)) extent.extend(g.vertices[corner]);
            inside.push_back(contains(box, Vec2d(extent.center())));
        }
        keep[i] = std::count(inside.begin(), inside.end(), 1) > 0;
        if (keep[i]) keep_surfaces(object.geometry, inside);
        drop_unused_vertices(object.geometry);
    }
    if (const std::size_t gone = keep_objects(city, keep); gone > 0)
        findings.add(make_finding("SB121", "city", fmt::format("{} objects outside --bbox were left out.", gone)));
}

std::optional<std::string> exclude(CityModel& city, const std::vector<std::string>& ids, FindingLog& findings) {
    std::unordered_map<std::string_view, std::size_t> by_id;
    for (std::size_t i = 0; i < city.objects.size(); ++i) by_id.emplace(city.objects[i].id, i);
    std::vector<char> keep(city.objects.size(), 1);
    for (const std::string& id : ids) {
        const auto found = by_id.find(id);
        if (found == by_id.end()) return id;
        keep[found->second] = 0;
    }
    // What lies below an excluded object goes, too: as many rounds as families are deep.
    for (bool goes_on = true; goes_on;) {
        goes_on = false;
        for (std::size_t i = 0; i < city.objects.size(); ++i) {
            const auto parent = by_id.find(city.objects[i].parent_id);
            if (!keep[i] || city.objects[i].parent_id.empty() || parent == by_id.end() || keep[parent->second])
                continue;
            keep[i] = 0;
            goes_on = true;
        }
    }
    const std::size_t gone = keep_objects(city, keep);
    if (gone > 0) findings.add(make_finding("SB121", "city", fmt::format("{} objects were excluded.", gone)));
    return std::nullopt;
}

}  // namespace skybake
