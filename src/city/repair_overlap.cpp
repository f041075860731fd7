#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/box.h"
#include "city/finding_codes.h"
#include "city/polygon.h"
#include "city/repair_steps.h"
#include "city/triangulate.h"

namespace skybake::repair_steps {
namespace {

/// Beyond this many solids in one family, or triangles in one solid, only boxes would be cheap enough; such families
/// are not looked at.
constexpr std::size_t kMostSolids = 200;
constexpr std::size_t kMostTriangles = 2000;
/// Bodies that share less than this along an axis touch; they do not overlap. Metres.
constexpr double kLeastOverlap = 0.005;

struct Body {
    const CityObject* object = nullptr;
    Box3d box;
    std::vector<std::array<Vec3d, 3>> triangles;

    /// Odd number of crossings of the line upward from p (Jordan).
    bool encloses(const Vec3d& p) const {
        bool is_inside = false;
        for (const auto& t : triangles) {
            const auto side = [&](const Vec3d& a, const Vec3d& b) {
                return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
            };
            const double s0 = side(t[0], t[1]), s1 = side(t[1], t[2]), s2 = side(t[2], t[0]);
            const bool is_under = (s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0);
            if (!is_under) continue;
            const double z = (s1 * t[0].z + s2 * t[1].z + s0 * t[2].z) / (s0 + s1 + s2);
            if (z > p.z) is_inside = !is_inside;
        }
        return is_inside;
    }
};

void add_bodies(const CityObject& object, std::vector<Body>& bodies) {
    const Geometry& g = object.geometry;
    for (const Shell& shell : g.shells) {
        if (shell.kind != Shell::Kind::outer) continue;
        Body body;
        body.object = &object;
        for (std::uint32_t s = shell.surface_begin; s < shell.surface_end; ++s) {
            if (body.triangles.size() > kMostTriangles) break;
            for (const auto& t : triangulate(g, g.surfaces[s])) {
                const auto corner = [&](std::size_t k) { return g.vertices[g.corners[t[k]]]; };
                body.triangles.push_back({corner(0), corner(1), corner(2)});
                for (std::size_t k = 0; k < 3; ++k) body.box.extend(corner(k));
            }
        }
        if (body.triangles.size() <= kMostTriangles && !body.box.is_empty()) bodies.push_back(std::move(body));
    }
}

/// True when one of a few points in the boxes' common part lies in both. The points have uneven coordinates, so that
/// they lie on no edge.
bool overlap(const Body& a, const Body& b) {
    const Vec3d lo = glm::max(a.box.lo, b.box.lo);
    const Vec3d hi = glm::min(a.box.hi, b.box.hi);
    const Vec3d size = hi - lo;
    if (std::min({size.x, size.y, size.z}) < kLeastOverlap) return false;
    for (const double x : {0.2137, 0.5071, 0.7919}) {
        for (const double y : {0.1931, 0.4877, 0.8123}) {
            for (const double z : {0.1, 0.5, 0.9}) {
                const Vec3d p = lo + size * Vec3d(x, y, z);
                if (a.encloses(p) && b.encloses(p)) return true;
            }
        }
    }
    return false;
}

}  // namespace

void note_overlaps(const std::vector<const CityObject*>& family, FindingLog& findings) {
    std::size_t shells = 0;
    for (const CityObject* object : family) {
        shells += static_cast<std::size_t>(std::count_if(object->geometry.shells.begin(), object->geometry.shells.end(),
                                                         [](const Shell& s) { return s.kind == Shell::Kind::outer; }));
    }
    if (shells < 2 || shells > kMostSolids) return;
    std::vector<Body> bodies;
    for (const CityObject* object : family) add_bodies(*object, bodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (std::size_t j = i + 1; j < bodies.size(); ++j) {
            if (!overlap(bodies[i], bodies[j])) continue;
            const bool is_same = bodies[i].object == bodies[j].object;
            findings.add(make_finding("SB214", bodies[i].object->where,
                                      is_same ? std::string("two of its solids overlap; both are kept.")
                                              : fmt::format("overlaps '{}'; both are kept.", bodies[j].object->id)));
        }
    }
}

}  // namespace skybake::repair_steps
