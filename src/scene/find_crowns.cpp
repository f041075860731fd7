#include "scene/find_crowns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "base/check.h"
#include "base/finding.h"
#include "city/finding_codes.h"

namespace skybake {

namespace {

using Triangles = std::span<const std::array<Vec3f, 3>>;
using Corner = std::array<std::uint32_t, 3>;

Corner bits_of(const Vec3f& p) {
    // + 0: no negative zero.
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

/// True when every edge is walked as often in one direction as in the other.
bool is_closed(Triangles triangles) {
    std::map<std::pair<Corner, Corner>, int> net;
    for (const std::array<Vec3f, 3>& triangle : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Corner a = bits_of(triangle[k]), b = bits_of(triangle[(k + 1) % 3]);
            if (a < b) {
                ++net[{a, b}];
            } else {
                --net[{b, a}];
            }
        }
    }
    return std::all_of(net.begin(), net.end(), [](const auto& edge) { return edge.second == 0; });
}

double area_of(Triangles triangles) {
    double area = 0.0;
    for (const auto& t : triangles)
        area += 0.5 * glm::length(glm::cross(Vec3d(t[1]) - Vec3d(t[0]), Vec3d(t[2]) - Vec3d(t[0])));
    return area;
}

/// Of a closed surface whose triangles face outwards; negative when they face inwards.
double volume_of(Triangles triangles) {
    const Vec3d base(triangles[0][0]);
    double six_volumes = 0.0;
    for (const auto& t : triangles)
        six_volumes += glm::dot(Vec3d(t[0]) - base, glm::cross(Vec3d(t[1]) - base, Vec3d(t[2]) - base));
    return six_volumes / 6.0;
}

bool is_plant(ObjectType type) {
    return type == ObjectType::solitary_vegetation || type == ObjectType::plant_cover;
}

}  // namespace

std::vector<Crown> find_crowns(const Scene& scene, float transmissivity, FindingLog& findings) {
    SKYBAKE_CHECK(transmissivity > 0.0f && transmissivity < 1.0f);
    const float depth = -std::log(transmissivity);
    std::vector<Crown> crowns;
    for (std::size_t f = 0; f < scene.faces.size();) {
        const std::uint32_t object = scene.faces[f].object;
        Crown crown;
        crown.object = object;
        crown.first_triangle = scene.faces[f].first_triangle;
        for (; f < scene.faces.size() && scene.faces[f].object == object; ++f)
            crown.triangle_count += scene.faces[f].triangle_count;
        const ObjectType type = scene.objects[object].type;
        if (!is_plant(type)) continue;
        const Triangles triangles = Triangles(scene.triangles).subspan(crown.first_triangle, crown.triangle_count);
        const double volume = is_closed(triangles) ? volume_of(triangles) : 0.0;
        // A body thinner than its surface can tell, such as a board with two sides, is none.
        const double mean_chord = 4.0 * volume / area_of(triangles);
        constexpr double kThinnest = 0.01;  // metres
        if (mean_chord > kThinnest) {
            crown.extinction = depth / static_cast<float>(mean_chord);
        } else if (type == ObjectType::solitary_vegetation) {
            crown.depth_per_crossing = 0.5f * depth;
            findings.add(
                make_finding("SB218", scene.objects[object].id, "each of its surfaces dims light as half a crown."));
        } else {
            continue;  // a lawn, a bed: ground
        }
        Box3f box;
        for (const auto& triangle : triangles) {
            for (const Vec3f& corner : triangle) box.extend(corner);
        }
        crown.center = box.center();
        for (const auto& triangle : triangles) {
            for (const Vec3f& corner : triangle)
                crown.radius = std::max(crown.radius, glm::length(corner - crown.center));
        }
        crowns.push_back(crown);
    }
    return crowns;
}

std::vector<std::uint32_t> crown_of_triangles(const Scene& scene) {
    std::vector<std::uint32_t> crown(scene.triangles.size(), kNoCrown);
    for (std::size_t c = 0; c < scene.crowns.size(); ++c)
        std::fill_n(crown.begin() + scene.crowns[c].first_triangle, scene.crowns[c].triangle_count,
                    static_cast<std::uint32_t>(c));
    return crown;
}

}  // namespace skybake
