#include "api/default_views.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace skybake {

namespace {

constexpr float kEyeHeight = 1.7f;
// A street sees between three and eight tenths of the sky: less is a passage, more an open field.
constexpr float kStreetMin = 0.3f, kStreetMax = 0.8f;
// A road may be this much farther from the centre than other ground and is still preferred, metres.
constexpr float kRoadBonus = 150.0f;
// Places looked at, nearest to the centre first, and directions that each looks into.
constexpr std::size_t kCandidates = 2000;
constexpr int kGazes = 32;
// What makes a good place: a view of up to so many metres ahead, and so much room to all sides.
constexpr float kGoodView = 60.0f, kGoodRoom = 4.0f;

/// The ground under the city's buildings, which may fill a small part of a large terrain.
Box3f bounds_of_buildings(const Scene& scene) {
    Box3f box;
    for (const Face& face : scene.faces) {
        if (!is_building(scene.objects[face.object].type)) continue;
        for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
            for (const Vec3f& p : scene.triangles[face.first_triangle + t]) box.extend(p);
        }
    }
    return box.is_empty() ? scene.bounds : box;
}

/// Texels of open, level ground, the nearest to the centre first; every fourth is enough.
std::vector<Vec3f> street_candidates(const Scene& scene, const Atlas& atlas, const Lightmaps& light,
                                     const Vec3f& center) {
    std::vector<std::pair<float, Vec3f>> candidates;
    for (const Chart& chart : atlas.charts) {
        const Face& face = scene.faces[scene.triangle_face[chart.triangles.front()].index()];
        if (!is_ground(scene.objects[face.object].type) || chart.normal.z < 0.97f || face.type == SurfaceType::water)
            continue;
        const LightmapPage& page = light.pages[chart.page.index()];
        for (int row = 0; row < chart.size.y; row += 4) {
            for (int column = 0; column < chart.size.x; column += 4) {
                const std::size_t texel =
                    static_cast<std::size_t>(chart.position.y + row) * static_cast<std::size_t>(page.width) +
                    static_cast<std::size_t>(chart.position.x + column);
                const float open = page.sky_view_factor[texel];
                if (page.state[texel] != TexelState::chart || open < kStreetMin || open > kStreetMax) continue;
                const Vec3f p = chart.origin + (static_cast<float>(column) + 0.5f) * chart.u +
                                (static_cast<float>(row) + 0.5f) * chart.v;
                const float bonus = face.type == SurfaceType::road ? kRoadBonus : 0.0f;
                candidates.emplace_back(glm::length(Vec2f(p - center)) - bonus, p);
            }
        }
    }
    const std::size_t count = std::min(candidates.size(), kCandidates);
    std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count), candidates.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Vec3f> nearest;
    for (std::size_t i = 0; i < count; ++i) nearest.push_back(candidates[i].second);
    return nearest;
}

struct Stand {
    Vec3f eye, gaze;
    float score = 0.0f;
};

/// Down the street, with room to all sides, but not out of the town into nothing.
Stand look_around(const Vec3f& eye, const Vec3f& center, const RayScene& rays) {
    Stand stand{eye, Vec3f(0.0f, 1.0f, 0.0f)};
    float longest = 0.0f, room = kGoodRoom;
    for (int i = 0; i < kGazes; ++i) {
        const float azimuth = static_cast<float>(2.0 * kPi) * static_cast<float>(i) / kGazes;
        const Vec3f direction(std::sin(azimuth), std::cos(azimuth), 0.0f);
        const auto hit = rays.first_hit(eye, direction);
        if (!hit) continue;
        room = std::min(room, hit->distance);
        const float distance = std::min(hit->distance, kGoodView);
        if (distance > longest) {
            longest = distance;
            stand.gaze = direction;
        }
    }
    stand.score = longest + kGoodView / kGoodRoom * room - 0.1f * glm::length(Vec2f(eye - center));
    return stand;
}

}  // namespace

std::vector<io::BakeView> default_views(const Scene& scene, const Atlas& atlas, const Lightmaps& light,
                                        const RayScene& rays) {
    const Box3f box = bounds_of_buildings(scene);
    const Vec3f center(box.center().x, box.center().y, box.lo.z + 0.2f * box.size().z);
    const float reach = std::max({box.size().x, box.size().y, box.size().z, 10.0f});
    std::vector<io::BakeView> views{{"Bird's eye", center + reach * Vec3f(-0.45f, -0.75f, 0.55f), center}};

    std::optional<Stand> best;
    for (const Vec3f& foot : street_candidates(scene, atlas, light, center)) {
        // The chart's plane may lie above or below relief: stand on what is really there.
        const auto below = rays.first_hit(foot + Vec3f(0, 0, 2.0f), Vec3f(0, 0, -1));
        if (!below) continue;
        const Stand stand = look_around(foot + Vec3f(0, 0, 2.0f - below->distance + kEyeHeight), center, rays);
        if (!best || stand.score > best->score) best = stand;
    }
    if (!best) return views;
    const Vec3f eye = best->eye, gaze = best->gaze;
    views.push_back({"Street", eye, eye + 10.0f * gaze + Vec3f(0, 0, 0.5f)});
    return views;
}

}  // namespace skybake
