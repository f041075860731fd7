#include "city/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "city/finding_codes.h"
#include "city/geos.h"
#include "city/polygon.h"

namespace skybake {
namespace {

constexpr double kFootBand = 0.3;    // vertices this far above an object's lowest one stand on the ground too. Metres
constexpr double kBelowFeet = 0.01;  // metres
constexpr double kFootStep = 2.0;    // along the foot of a wall. Metres
constexpr int kMostSteps = 64;       // for one wall
constexpr double kLevel = 2.0;       // feet that differ by less may stand on a plane. Metres

/// Vertices at the feet of all objects, thinned to the lowest in each square metre, in a fixed order; and, when asked
/// for, points along the edges between them, without which a long wall would stand over a triangle between its
/// neighbours' lower feet. How many those are hangs on how the polygons are cut into triangles.
std::vector<Vec3d> feet_of(const CityModel& city, bool with_edges) {
    std::map<std::pair<std::int64_t, std::int64_t>, Vec3d> cells;
    const auto add = [&](const Vec3d& p) {
        const auto [cell, is_new] = cells.emplace(std::pair(std::llround(p.x), std::llround(p.y)), p);
        if (!is_new && p.z < cell->second.z) cell->second = p;
    };
    for (const CityObject& object : city.objects) {
        if (object.geometry.is_empty()) continue;
        // An installation may hang in the air; its building tells where the ground is.
        if (object.type == ObjectType::building_installation) continue;
        double lowest = std::numeric_limits<double>::max();
        for (const std::uint32_t c : object.geometry.corners) lowest = std::min(lowest, object.geometry.vertices[c].z);
        for (std::uint32_t r = 0; r + 1 < object.geometry.ring_first.size(); ++r) {
            const std::span<const std::uint32_t> ring = ring_of(object.geometry, r);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec3d& p = object.geometry.vertices[ring[i]];
                const Vec3d& next = object.geometry.vertices[ring[(i + 1) % ring.size()]];
                if (p.z > lowest + kFootBand) continue;
                add(p);
                if (!with_edges || next.z > lowest + kFootBand) continue;
                const double length = glm::distance(Vec2d(p), Vec2d(next));
                const int steps = static_cast<int>(std::min(length / kFootStep, static_cast<double>(kMostSteps)));
                for (int k = 1; k < steps; ++k) add(p + (next - p) * (static_cast<double>(k) / steps));
            }
        }
    }
    std::vector<Vec3d> feet;
    feet.reserve(cells.size());
    for (const auto& [cell, p] : cells) feet.push_back(p);
    return feet;
}

void add_surface(Geometry& g, const std::vector<std::uint32_t>& corners) {
    Surface surface;
    surface.ring_begin = static_cast<std::uint32_t>(g.ring_first.size() - 1);
    surface.ring_end = surface.ring_begin + 1;
    surface.type = SurfaceType::terrain;
    surface.source_index = static_cast<std::uint32_t>(g.surfaces.size());
    g.corners.insert(g.corners.end(), corners.begin(), corners.end());
    g.ring_first.push_back(static_cast<std::uint32_t>(g.corners.size()));
    g.surfaces.push_back(surface);
}

/// Points around the feet, `margin` outside them and 16 a side, each as high as the foot next to it.
void add_margin(std::vector<Vec3d>& points, const Box3d& box, double margin) {
    const std::size_t feet = points.size();
    const Vec3d lo = box.lo - margin;
    const Vec3d hi = box.hi + margin;
    constexpr int kPerSide = 16;
    const auto add = [&](double x, double y) {
        double nearest = std::numeric_limits<double>::max();
        double z = box.lo.z;
        for (std::size_t i = 0; i < feet; ++i) {
            const double d = (points[i].x - x) * (points[i].x - x) + (points[i].y - y) * (points[i].y - y);
            if (d < nearest) {
                nearest = d;
                z = points[i].z;
            }
        }
        points.emplace_back(x, y, z);
    };
    for (int i = 0; i < kPerSide; ++i) {
        const double t = static_cast<double>(i) / kPerSide;
        add(lo.x + t * (hi.x - lo.x), lo.y);
        add(hi.x, lo.y + t * (hi.y - lo.y));
        add(hi.x - t * (hi.x - lo.x), hi.y);
        add(lo.x, hi.y - t * (hi.y - lo.y));
    }
}

/// Delaunay triangles of the points as seen from above; about an origin near them, for GEOS's sake.
Geometry drape(const std::vector<Vec3d>& points) {
    const GEOSContextHandle_t context = geos::context();
    Geometry g;
    g.vertices = points;
    const Vec2d origin(points.front());
    std::map<std::pair<double, double>, std::uint32_t> index;
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context, static_cast<unsigned>(points.size()), 2);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec2d p = Vec2d(points[i]) - origin;
        index.emplace(std::pair(p.x, p.y), static_cast<std::uint32_t>(i));
        GEOSCoordSeq_setXY_r(context, sequence, static_cast<unsigned>(i), p.x, p.y);
    }
    const geos::GeometryPtr line(GEOSGeom_createLineString_r(context, sequence));
    const geos::GeometryPtr triangles(line ? GEOSDelaunayTriangulation_r(context, line.get(), 0.0, 0) : nullptr);
    const int count = triangles ? GEOSGetNumGeometries_r(context, triangles.get()) : 0;
    for (int i = 0; i < count; ++i) {
        const GEOSGeometry* ring = GEOSGetExteriorRing_r(context, GEOSGetGeometryN_r(context, triangles.get(), i));
        const GEOSCoordSequence* corners = ring ? GEOSGeom_getCoordSeq_r(context, ring) : nullptr;
        std::vector<std::uint32_t> triangle;
        for (unsigned k = 0; corners && k < 3; ++k) {
            Vec2d p;
            GEOSCoordSeq_getXY_r(context, corners, k, &p.x, &p.y);
            const auto found = index.find({p.x, p.y});
            if (found != index.end()) triangle.push_back(found->second);
        }
        if (triangle.size() != 3) continue;
        const Vec3d normal =
            glm::cross(points[triangle[1]] - points[triangle[0]], points[triangle[2]] - points[triangle[0]]);
        if (normal.z == 0.0) continue;
        if (normal.z < 0.0) std::swap(triangle[1], triangle[2]);
        add_surface(g, triangle);
    }
    return g;
}

}  // namespace

const char* name_of(GroundChoice choice) {
    switch (choice) {
        case GroundChoice::none:
            return "none";
        case GroundChoice::plane:
            return "plane";
        case GroundChoice::draped:
            return "draped";
    }
    return "none";
}

bool has_ground(const CityModel& city) {
    return std::any_of(city.objects.begin(), city.objects.end(),
                       [](const CityObject& o) { return is_ground(o.type) && !o.geometry.is_empty(); });
}

void add_ground(CityModel& city, GroundChoice choice, double margin_m, FindingLog& findings) {
    const std::string where =
        city.files.empty() ? "city" : std::filesystem::path(city.files.front()).filename().string();
    if (has_ground(city)) {
        if (choice != GroundChoice::none)
            findings.add(make_finding("SB502", where, "the city has ground of its own; none was added."));
        return;
    }
    std::vector<Vec3d> feet = feet_of(city, choice == GroundChoice::draped);
    if (feet.empty()) return;
    Box3d foot_box;
    for (const Vec3d& p : feet) foot_box.extend(p);
    const double spread = foot_box.size().z;
    if (choice == GroundChoice::none) {
        findings.add(make_finding(
            "SB501", where,
            fmt::format("no object is ground: buildings stand in the void, and no light falls on streets. The feet of "
                        "the buildings differ by {:.1f} m: --ground {} fits.",
                        spread, spread > kLevel ? "draped" : "plane")));
        return;
    }
    // As wide as all that stands there, not only as its feet.
    Box3d box = extent_of(city);
    CityObject ground;
    ground.id = "skybake-ground";
    ground.type = ObjectType::terrain;
    ground.type_name = "TINRelief";
    ground.lod = std::string("1");
    ground.where = where + ": added ground";
    Geometry& g = ground.geometry;
    if (choice == GroundChoice::plane) {
        // At the middle foot: at the lowest one, one deep cellar would lift the whole city off its ground.
        const auto middle = feet.begin() + static_cast<std::ptrdiff_t>(feet.size() / 2);
        std::nth_element(feet.begin(), middle, feet.end(), [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
        const double z = middle->z - kBelowFeet;
        g.vertices = {{box.lo.x - margin_m, box.lo.y - margin_m, z},
                      {box.hi.x + margin_m, box.lo.y - margin_m, z},
                      {box.hi.x + margin_m, box.hi.y + margin_m, z},
                      {box.lo.x - margin_m, box.hi.y + margin_m, z}};
        add_surface(g, {0, 1, 2, 3});
        findings.add(make_finding(
            "SB502", where,
            fmt::format(
                "a level ground at {:.2f} m was added, {:.0f} m wider than the city; the feet of the buildings lie "
                "between {:.1f} m below and {:.1f} m above it{}.",
                z, margin_m, z - foot_box.lo.z, foot_box.hi.z - z,
                spread > kLevel ? ", so that --ground draped fits better" : "")));
    } else {
        box.lo.z = foot_box.lo.z;
        add_margin(feet, box, std::max(margin_m, 1.0));
        g = drape(feet);
        findings.add(make_finding(
            "SB502", where,
            fmt::format(
                "a ground of {} triangles through the feet of the buildings was added, {:.0f} m wider than the city.",
                g.surfaces.size(), margin_m)));
    }
    g.shells = {{0, static_cast<std::uint32_t>(g.surfaces.size()), Shell::Kind::loose}};
    city.objects.push_back(std::move(ground));
}

}  // namespace skybake
