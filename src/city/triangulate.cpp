#include "city/triangulate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "city/geos.h"
#include "city/polygon.h"

namespace skybake {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Two edges whose angle has a smaller sine count as one line: below the millimetres of city models at any length of a
/// wall.
constexpr double kCollinearSine = 1e-7;
/// Largest relative difference between the polygon's area and its triangles'.
constexpr double kAreaTolerance = 1e-9;

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x * b.y - a.y * b.x;
}

double ring_area(std::span<const Vec2d> ring) {
    double sum = 0.0;
    for (std::size_t i = 2; i < ring.size(); ++i) sum += cross(ring[i - 1] - ring[0], ring[i] - ring[0]);
    return 0.5 * sum;
}

/// The corners of a surface in its plane; corner i of `points` is Geometry corner `first + i`.
struct PlanarPolygon {
    std::uint32_t first = 0;
    std::vector<Vec2d> points;
    std::vector<std::span<const Vec2d>> rings;
};

PlanarPolygon project(const Geometry& geometry, const Surface& surface, const PlaneFrame& frame) {
    PlanarPolygon polygon;
    polygon.first = geometry.ring_first[surface.ring_begin];
    const std::uint32_t last = geometry.ring_first[surface.ring_end];
    polygon.points.reserve(last - polygon.first);
    for (std::uint32_t i = polygon.first; i < last; ++i) {
        polygon.points.push_back(frame.project(geometry.vertices[geometry.corners[i]]));
    }
    for (std::uint32_t ring = surface.ring_begin; ring < surface.ring_end; ++ring) {
        const std::uint32_t begin = geometry.ring_first[ring];
        polygon.rings.push_back(
            std::span(polygon.points).subspan(begin - polygon.first, geometry.ring_first[ring + 1] - begin));
    }
    return polygon;
}

/// True when the ring is a fan about its corner `apex`: seen from there all other corners lie within less than half a
/// turn, in order, and no triangle of the fan is flat.
bool is_fan(std::span<const Vec2d> ring, std::size_t apex) {
    const std::size_t n = ring.size();
    const auto arm = [&](std::size_t i) { return ring[(apex + i) % n] - ring[apex]; };
    const auto turns_left = [](const Vec2d& a, const Vec2d& b) {
        return cross(a, b) > kCollinearSine * std::sqrt(glm::dot(a, a) * glm::dot(b, b));
    };
    const Vec2d first = arm(1);
    Vec2d previous = first;
    for (std::size_t i = 2; i < n; ++i) {
        const Vec2d next = arm(i);
        if (!turns_left(first, next) || !turns_left(previous, next)) return false;
        previous = next;
    }
    return true;
}

Triangles fan(std::uint32_t first, std::size_t n, std::size_t apex) {
    Triangles triangles;
    triangles.reserve(n - 2);
    const auto corner = [&](std::size_t i) { return first + static_cast<std::uint32_t>((apex + i) % n); };
    for (std::size_t i = 2; i < n; ++i) triangles.push_back({corner(0), corner(i - 1), corner(i)});
    return triangles;
}

/// The fast way for rings that are a fan about one of their first corners; of a quadrangle's two diagonals the shorter
/// one.
Triangles triangulate_fan(const PlanarPolygon& polygon) {
    const std::span<const Vec2d> ring = polygon.rings[0];
    const std::size_t n = ring.size();
    if (n == 3) return is_fan(ring, 0) ? fan(polygon.first, 3, 0) : Triangles{};
    std::array<std::size_t, 4> apexes{0, 1, 2, 3};
    if (n == 4 && glm::distance(ring[1], ring[3]) < glm::distance(ring[0], ring[2])) apexes = {1, 0, 3, 2};
    for (const std::size_t apex : apexes) {
        if (is_fan(ring, apex)) return fan(polygon.first, n, apex);
    }
    return {};
}

/// Finds the corner that lies at a point, bit for bit: GEOS hands back the coordinates that it was given.
class CornerLookup {
  public:
    explicit CornerLookup(std::span<const Vec2d> points) : points_(points), order_(points.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return key(points_[a]) != key(points_[b]) ? key(points_[a]) < key(points_[b]) : a < b;
        });
    }
    std::uint32_t find(const Vec2d& p) const {
        const auto found = std::lower_bound(order_.begin(), order_.end(), key(p),
                                            [&](std::uint32_t a, const Key& k) { return key(points_[a]) < k; });
        return found != order_.end() && key(points_[*found]) == key(p) ? *found : kNone;
    }
    static constexpr std::uint32_t kNone = 0xffffffffu;

  private:
    using Key = std::pair<double, double>;
    static Key key(const Vec2d& p) { return {p.x, p.y}; }
    std::span<const Vec2d> points_;
    std::vector<std::uint32_t> order_;
};

Triangles triangulate_with_geos(const PlanarPolygon& polygon, double area) {
    const GEOSContextHandle_t context = geos::context();
    geos::GeometryPtr shell = geos::make_ring(polygon.rings[0]);
    if (!shell) return {};
    std::vector<GEOSGeometry*> holes;
    for (std::size_t i = 1; i < polygon.rings.size(); ++i) {
        geos::GeometryPtr hole = geos::make_ring(polygon.rings[i]);
        if (hole) holes.push_back(hole.release());
    }
    const geos::GeometryPtr input(
        GEOSGeom_createPolygon_r(context, shell.release(), holes.data(), static_cast<unsigned>(holes.size())));
    // GEOS's ear clipping (3.11) runs for ever on some rings that meet themselves.
    if (!input || GEOSisValid_r(context, input.get()) != 1) return {};
    const geos::GeometryPtr output(GEOSConstrainedDelaunayTriangulation_r(context, input.get()));
    if (!output) return {};

    const CornerLookup corners(polygon.points);
    Triangles triangles;
    double sum = 0.0;
    const int count = GEOSGetNumGeometries_r(context, output.get());
    triangles.reserve(static_cast<std::size_t>(std::max(count, 0)));
    for (int i = 0; i < count; ++i) {
        const GEOSGeometry* part = GEOSGetGeometryN_r(context, output.get(), i);
        const GEOSGeometry* ring = part ? GEOSGetExteriorRing_r(context, part) : nullptr;
        const GEOSCoordSequence* sequence = ring ? GEOSGeom_getCoordSeq_r(context, ring) : nullptr;
        if (!sequence) return {};
        std::array<std::uint32_t, 3> triangle{};
        for (unsigned k = 0; k < 3; ++k) {
            Vec2d p;
            if (!GEOSCoordSeq_getXY_r(context, sequence, k, &p.x, &p.y)) return {};
            triangle[k] = corners.find(p);
            if (triangle[k] == CornerLookup::kNone) return {};
        }
        const Vec2d a = polygon.points[triangle[0]];
        const double twice_area = cross(polygon.points[triangle[1]] - a, polygon.points[triangle[2]] - a);
        if (twice_area == 0.0) continue;  // a flat one between collinear corners covers nothing
        if (twice_area < 0.0) std::swap(triangle[1], triangle[2]);
        sum += 0.5 * std::abs(twice_area);
        for (std::uint32_t& corner : triangle) corner += polygon.first;
        triangles.push_back(triangle);
    }
    // Triangles of crossing rings overlap or miss a part; the areas tell, since all triangles count positively.
    if (std::abs(sum - area) > kAreaTolerance * area) return {};
    return triangles;
}

}  // namespace

Triangles triangulate(const Geometry& geometry, const Surface& surface) {
    if (surface.ring_begin >= surface.ring_end) return {};
    const Vec3d area_vector = ring_area_vector(geometry, surface.ring_begin);
    if (!(glm::dot(area_vector, area_vector) > 0.0) || !std::isfinite(glm::dot(area_vector, area_vector))) return {};
    const PlanarPolygon polygon = project(geometry, surface, plane_of(geometry, surface, area_vector));
    if (polygon.rings.size() == 1) {
        Triangles triangles = triangulate_fan(polygon);
        if (!triangles.empty()) return triangles;
    }
    double area = ring_area(polygon.rings[0]);
    for (std::size_t i = 1; i < polygon.rings.size(); ++i) area -= std::abs(ring_area(polygon.rings[i]));
    if (!(area > 0.0)) return {};
    return triangulate_with_geos(polygon, area);
}

}  // namespace skybake
