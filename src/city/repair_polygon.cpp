#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "city/finding_codes.h"
#include "city/geos.h"
#include "city/polygon.h"
#include "city/repair_steps.h"
#include "city/triangulate.h"

namespace skybake::repair_steps {
namespace {

/// A corner further than this from its polygon's plane is told of. Empirical: rounding to millimetres and survey noise
/// stay below.
constexpr double kFlatness = 0.05;

struct ValidPolygons {
    std::vector<std::vector<std::vector<Vec2d>>> polygons;  // rings of each
    Vec2d place{0.0};                                       // where the first fault is
    std::string reason;
};

std::vector<Vec2d> points_of(const GEOSGeometry* ring) {
    const GEOSContextHandle_t context = geos::context();
    std::vector<Vec2d> points;
    const GEOSCoordSequence* sequence = ring ? GEOSGeom_getCoordSeq_r(context, ring) : nullptr;
    unsigned size = 0;
    if (!sequence || !GEOSCoordSeq_getSize_r(context, sequence, &size)) return points;
    for (unsigned i = 0; i + 1 < size; ++i) {
        Vec2d p;
        GEOSCoordSeq_getXY_r(context, sequence, i, &p.x, &p.y);
        points.push_back(p);
    }
    return points;
}

void collect_polygons(const GEOSGeometry* geometry, ValidPolygons& into) {
    const GEOSContextHandle_t context = geos::context();
    const int type = GEOSGeomTypeId_r(context, geometry);
    if (type == GEOS_POLYGON) {
        std::vector<std::vector<Vec2d>> rings{points_of(GEOSGetExteriorRing_r(context, geometry))};
        const int holes = GEOSGetNumInteriorRings_r(context, geometry);
        for (int i = 0; i < holes; ++i) rings.push_back(points_of(GEOSGetInteriorRingN_r(context, geometry, i)));
        if (rings[0].size() >= 3) into.polygons.push_back(std::move(rings));
    } else if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
        const int parts = GEOSGetNumGeometries_r(context, geometry);
        for (int i = 0; i < parts; ++i) collect_polygons(GEOSGetGeometryN_r(context, geometry, i), into);
    }
}

/// The valid polygons that cover what the rings enclose.
ValidPolygons make_valid(const std::vector<std::vector<Vec2d>>& rings) {
    const GEOSContextHandle_t context = geos::context();
    ValidPolygons result;
    geos::GeometryPtr shell = geos::make_ring(rings[0]);
    if (!shell) return result;
    std::vector<GEOSGeometry*> holes;
    for (std::size_t i = 1; i < rings.size(); ++i) {
        if (geos::GeometryPtr hole = geos::make_ring(rings[i])) holes.push_back(hole.release());
    }
    const geos::GeometryPtr polygon(
        GEOSGeom_createPolygon_r(context, shell.release(), holes.data(), static_cast<unsigned>(holes.size())));
    if (!polygon) return result;
    char* reason = nullptr;
    GEOSGeometry* place = nullptr;
    if (GEOSisValidDetail_r(context, polygon.get(), 0, &reason, &place) == 0) {
        if (reason) result.reason = reason;
        if (place) {
            GEOSGeomGetX_r(context, place, &result.place.x);
            GEOSGeomGetY_r(context, place, &result.place.y);
        }
    }
    if (reason) GEOSFree_r(context, reason);
    if (place) GEOSGeom_destroy_r(context, place);
    const geos::GeometryPtr valid(GEOSMakeValid_r(context, polygon.get()));
    if (valid) collect_polygons(valid.get(), result);
    return result;
}

/// Appends `polygons` of the plane `frame` as surfaces like `from`. Corners of the old surface keep vertex and texture
/// coordinate; new ones, where edges cross, lie in the plane, and a polygon with such a corner loses its texture.
void append_polygons(Geometry& clean, const Geometry& g, const Surface& from, const PlaneFrame& frame,
                     const ValidPolygons& valid) {
    const std::uint32_t first = g.ring_first[from.ring_begin];
    const std::uint32_t last = g.ring_first[from.ring_end];
    std::vector<std::pair<std::pair<double, double>, std::uint32_t>> corners;
    for (std::uint32_t c = first; c < last; ++c) {
        const Vec2d p = frame.project(g.vertices[g.corners[c]]);
        corners.push_back({{p.x, p.y}, c});
    }
    std::sort(corners.begin(), corners.end());
    for (const auto& rings : valid.polygons) {
        Surface surface = from;
        surface.ring_begin = static_cast<std::uint32_t>(clean.ring_first.size() - 1);
        for (std::size_t r = 0; r < rings.size(); ++r) {
            std::vector<Vec2d> ring = rings[r];
            double area = 0.0;
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec2d& a = ring[i];
                const Vec2d& b = ring[(i + 1) % ring.size()];
                area += a.x * b.y - a.y * b.x;
            }
            if ((area > 0.0) != (r == 0)) std::reverse(ring.begin(), ring.end());
            for (const Vec2d& p : ring) {
                const std::pair<double, double> key{p.x, p.y};
                const auto found = std::lower_bound(corners.begin(), corners.end(), key,
                                                    [](const auto& a, const auto& k) { return a.first < k; });
                if (found != corners.end() && found->first == key) {
                    clean.corners.push_back(g.corners[found->second]);
                    if (!g.corner_uv.empty()) clean.corner_uv.push_back(g.corner_uv[found->second]);
                } else {
                    clean.corners.push_back(static_cast<std::uint32_t>(clean.vertices.size()));
                    clean.vertices.push_back(frame.lift(p));
                    if (!g.corner_uv.empty()) clean.corner_uv.emplace_back(0.0f);
                    surface.texture.reset();
                }
            }
            clean.ring_first.push_back(static_cast<std::uint32_t>(clean.corners.size()));
        }
        surface.ring_end = static_cast<std::uint32_t>(clean.ring_first.size() - 1);
        clean.surfaces.push_back(surface);
    }
}

void append_surface(Geometry& clean, const Geometry& g, Surface surface) {
    const std::uint32_t ring_begin = static_cast<std::uint32_t>(clean.ring_first.size() - 1);
    for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
        for (std::uint32_t c = g.ring_first[r]; c < g.ring_first[r + 1]; ++c) {
            clean.corners.push_back(g.corners[c]);
            if (!g.corner_uv.empty()) clean.corner_uv.push_back(g.corner_uv[c]);
        }
        clean.ring_first.push_back(static_cast<std::uint32_t>(clean.corners.size()));
    }
    surface.ring_begin = ring_begin;
    surface.ring_end = static_cast<std::uint32_t>(clean.ring_first.size() - 1);
    clean.surfaces.push_back(surface);
}

/// Largest distance of an outer corner from the surface's plane.
double unevenness(const Geometry& g, const Surface& surface) {
    const auto ring = ring_of(g, surface.ring_begin);
    if (ring.size() == 3) return 0.0;
    const PlaneFrame frame = plane_of(g, surface, ring_area_vector(g, surface.ring_begin));
    double largest = 0.0;
    for (const std::uint32_t corner : ring) largest = std::max(largest, std::abs(frame.height(g.vertices[corner])));
    return largest;
}

}  // namespace

std::uint64_t split_crossing_rings(CityObject& object, FindingLog& findings) {
    Geometry& g = object.geometry;
    std::uint64_t triangles = 0;
    std::vector<std::uint32_t> broken;
    std::size_t uneven = 0;
    double most_uneven = 0.0;
    for (std::uint32_t s = 0; s < g.surfaces.size(); ++s) {
        const std::size_t count = triangulate(g, g.surfaces[s]).size();
        if (count == 0) broken.push_back(s);
        triangles += count;
        const double distance = unevenness(g, g.surfaces[s]);
        if (distance > kFlatness) ++uneven;
        most_uneven = std::max(most_uneven, distance);
    }
    if (uneven > 0) {
        findings.add(
            make_finding("SB206", object.where,
                         fmt::format("{} surfaces are not flat, by up to {:.2f} m; folded along their triangles.",
                                     uneven, most_uneven)));
    }
    if (broken.empty()) return triangles;

    Geometry clean;
    clean.vertices = g.vertices;
    auto next_broken = broken.begin();
    for (const Shell& from : g.shells) {
        Shell shell = from;
        shell.surface_begin = static_cast<std::uint32_t>(clean.surfaces.size());
        for (std::uint32_t s = from.surface_begin; s < from.surface_end; ++s) {
            const Surface& surface = g.surfaces[s];
            if (next_broken == broken.end() || *next_broken != s) {
                append_surface(clean, g, surface);
                continue;
            }
            ++next_broken;
            // A bow tie's two halves may cancel, so the plane is that of the largest corner, not of the whole ring.
            Vec3d area = ring_area_vector(g, surface.ring_begin);
            const auto outer = ring_of(g, surface.ring_begin);
            double longest = 0.0;
            for (std::size_t i = 1; i < outer.size(); ++i)
                longest = std::max(longest, glm::distance(g.vertices[outer[i]], g.vertices[outer[0]]));
            if (glm::length(area) < 1e-3 * longest * longest) {
                for (std::size_t i = 1; i + 1 < outer.size(); ++i) {
                    const Vec3d corner = 0.5 * glm::cross(g.vertices[outer[i]] - g.vertices[outer[0]],
                                                          g.vertices[outer[i + 1]] - g.vertices[outer[0]]);
                    if (glm::length(corner) > glm::length(area)) area = corner;
                }
            }
            const PlaneFrame frame = plane_of(g, surface, area);
            std::vector<std::vector<Vec2d>> rings;
            for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
                rings.emplace_back();
                for (const std::uint32_t corner : ring_of(g, r))
                    rings.back().push_back(frame.project(g.vertices[corner]));
            }
            const ValidPolygons valid = make_valid(rings);
            const std::size_t before = clean.surfaces.size();
            append_polygons(clean, g, surface, frame, valid);
            std::vector<Surface> tried(clean.surfaces.begin() + static_cast<std::ptrdiff_t>(before),
                                       clean.surfaces.end());
            clean.surfaces.resize(before);
            std::size_t good = 0;
            for (const Surface& part : tried) {
                const std::size_t count = triangulate(clean, part).size();
                if (count == 0) continue;
                triangles += count;
                clean.surfaces.push_back(part);
                ++good;
            }
            const Vec3d place = frame.lift(valid.place);
            findings.add(make_finding(
                "SB203", object.where,
                fmt::format(
                    "polygon {}: ring crosses or touches itself or another near ({:.3f}, {:.3f}, {:.3f}){}; {}.",
                    surface.source_index, place.x, place.y, place.z,
                    valid.reason.empty() ? "" : " (" + valid.reason + ")",
                    good == 0 ? std::string("left out") : fmt::format("replaced by {} without crossing", good))));
        }
        shell.surface_end = static_cast<std::uint32_t>(clean.surfaces.size());
        if (shell.surface_end > shell.surface_begin) clean.shells.push_back(shell);
    }
    g = std::move(clean);
    return triangles;
}

}  // namespace skybake::repair_steps
