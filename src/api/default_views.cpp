#include "api/default_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skybake {

namespace {

constexpr float kEyeHeight = 1.7f;
// A street sees between a third and nine tenths of the sky: less is a passage, more an open field.
constexpr float kStreetMin = 0.3f, kStreetMax = 0.8f;
// A road may be this much farther from the centre than other ground and is still preferred, metres.
constexpr float kRoadBonus = 150.0f;
constexpr int kGazes = 64;

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

}  // namespace

std::vector<io::BakeView> default_views(const Scene& scene, const Atlas& atlas, const Lightmaps& light,
                                        const RayScene& rays) {
    const Box3f box = bounds_of_buildings(scene);
    const Vec3f center(box.center().x, box.center().y, box.lo.z + 0.2f * box.size().z);
    const float reach = std::max({box.size().x, box.size().y, box.size().z, 10.0f});
    std::vector<io::BakeView> views{{"Bird's eye", center + reach * Vec3f(-0.45f, -0.75f, 0.55f), center}};

    // The texel of open, level ground that is nearest to the centre; every fourth is enough.
    float nearest = std::numeric_limits<float>::max();
    Vec3f eye(0.0f);
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
                const float distance =
                    glm::length(Vec2f(p - center)) - (face.type == SurfaceType::road ? kRoadBonus : 0.0f);
                if (distance < nearest) {
                    nearest = distance;
                    eye = p;
                }
            }
        }
    }
    if (nearest == std::numeric_limits<float>::max()) return views;
    // The chart's plane may lie above or below relief: stand on what is really there.
    if (const auto below = rays.first_hit(eye + Vec3f(0, 0, 30), Vec3f(0, 0, -1))) eye.z += 30.0f - below->distance;
    eye.z += kEyeHeight;
    float longest = 0.0f;
    Vec3f gaze(0.0f, 1.0f, 0.0f);
    for (int i = 0; i < kGazes; ++i) {
        const float azimuth = static_cast<float>(2.0 * kPi) * static_cast<float>(i) / kGazes;
        const Vec3f direction(std::sin(azimuth), std::cos(azimuth), 0.0f);
        const auto hit = rays.first_hit(eye, direction);
        // Down the street, but not out of the town into nothing.
        const float distance = hit ? hit->distance : 0.0f;
        if (distance > longest) {
            longest = distance;
            gaze = direction;
        }
    }
    views.push_back({"Street", eye, eye + 10.0f * gaze + Vec3f(0, 0, 0.5f)});
    return views;
}

}  // namespace skybake
