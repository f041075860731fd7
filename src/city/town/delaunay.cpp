#include "city/town/delaunay.h"

#include <algorithm>

#include "city/town/plane_geometry.h"

namespace skybake::town {
namespace {

/// True when p lies within the circle through the counter-clockwise a, b, c.
bool is_in_circle(Vec2d a, Vec2d b, Vec2d c, Vec2d p) {
    a -= p;
    b -= p;
    c -= p;
    return glm::dot(a, a) * cross(b, c) + glm::dot(b, b) * cross(c, a) + glm::dot(c, c) * cross(a, b) > 0.0;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> delaunay(const std::vector<Vec2d>& points) {
    using Triangle = std::array<std::size_t, 3>;
    std::vector<Vec2d> all = points;
    const std::size_t n = points.size();
    const Vec2d centre = middle(points);
    constexpr double kFar = 1e5;  // three helpers so far out that the rim of the points is their hull to 0.1 mm
    all.push_back(centre + Vec2d(-kFar, -kFar));
    all.push_back(centre + Vec2d(kFar, -kFar));
    all.push_back(centre + Vec2d(0.0, kFar));
    std::vector<Triangle> triangles = {{n, n + 1, n + 2}};
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<std::array<std::size_t, 2>> rim;  // edges of the hole that the new point tears
        std::erase_if(triangles, [&](const Triangle& t) {
            if (!is_in_circle(all[t[0]], all[t[1]], all[t[2]], all[i])) return false;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::array<std::size_t, 2> back = {t[(k + 1) % 3], t[k]};
                const auto twin = std::find(rim.begin(), rim.end(), back);
                if (twin != rim.end()) {
                    rim.erase(twin);
                } else {
                    rim.push_back({t[k], t[(k + 1) % 3]});
                }
            }
            return true;
        });
        for (const auto& [a, b] : rim) triangles.push_back({a, b, i});
    }
    std::erase_if(triangles, [n](const Triangle& t) { return t[0] >= n || t[1] >= n || t[2] >= n; });
    return triangles;
}

}  // namespace skybake::town
