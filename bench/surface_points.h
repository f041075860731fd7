// Points on a city's surfaces at which estimates are judged.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/hash_rng.h"
#include "light/point_light.h"
#include "scene/scene.h"

namespace skybake::bench {

struct SurfacePoints {
    std::vector<ReceiverPoint> points;
    std::vector<FaceId> faces;  // on which they lie
    std::vector<PointLight> direct;
};

/// `count` points by area on the surfaces within the buildings' extent (open land beyond has next to no reflected
/// light), less those that see under 2 % of the sky: inside houses, under floors. `height_m` above the surface, where
/// the outside is. With their direct light.
inline SurfacePoints surface_points(const Scene& scene, const RayScene& rays, const Daylight& daylight,
                                    std::size_t count, float height_m, int sky_samples) {
    Box3f built;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const Face& face = scene.faces[scene.triangle_face[t].index()];
        if (!is_building(scene.objects[face.object].type)) continue;
        for (const Vec3f& corner : scene.triangles[t]) built.extend(corner);
    }
    std::vector<double> area_end;
    double area = 0.0;
    for (const auto& t : scene.triangles) {
        const Vec3f center = (t[0] + t[1] + t[2]) / 3.0f;
        const bool is_inside =
            center.x >= built.lo.x && center.x <= built.hi.x && center.y >= built.lo.y && center.y <= built.hi.y;
        if (is_inside) area += 0.5 * static_cast<double>(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])));
        area_end.push_back(area);
    }
    SurfacePoints all;
    RandomSequence random(1, 0, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const double wanted =
            (static_cast<double>(i) + static_cast<double>(random.next())) / static_cast<double>(count);
        const std::size_t t = static_cast<std::size_t>(
            std::upper_bound(area_end.begin(), area_end.end() - 1, wanted * area) - area_end.begin());
        float u = random.next(), v = random.next();
        if (u + v > 1.0f) {
            u = 1.0f - u;
            v = 1.0f - v;
        }
        const auto& [a, b, c] = scene.triangles[t];
        const Vec3f normal(glm::normalize(glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
        all.points.push_back({a + u * (b - a) + v * (c - a) + height_m * normal, normal});
        all.faces.push_back(scene.triangle_face[t]);
    }
    const DomeSampler sampler(std::span(&daylight, 1));
    const std::vector<PointLight> light = light_points(all.points, sampler, 0, daylight.sun, rays, {sky_samples, 64});
    SurfacePoints kept;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (light[i].sky_view_factor <= 0.02f) continue;
        kept.points.push_back(all.points[i]);
        kept.faces.push_back(all.faces[i]);
        kept.direct.push_back(light[i]);
    }
    return kept;
}

}  // namespace skybake::bench
