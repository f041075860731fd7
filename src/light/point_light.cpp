#include "light/point_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "sky/sun_disc.h"

namespace skybake {

std::vector<PointLight> light_points(std::span<const ReceiverPoint> points, const DomeSampler& sampler,
                                     std::size_t instant, const SunBeam& sun, const RayScene& rays,
                                     const PointLightOptions& options) {
    // Points of one normal share their directions and their packets, as the texels of a chart do.
    const auto less = [](const Vec3f& a, const Vec3f& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::map<Vec3f, std::vector<std::size_t>, decltype(less)> by_normal(less);
    for (std::size_t i = 0; i < points.size(); ++i) by_normal[points[i].normal].push_back(i);
    std::vector<const std::pair<const Vec3f, std::vector<std::size_t>>*> groups;
    for (const auto& group : by_normal) groups.push_back(&group);

    const bool has_sun = sun.shape != SunShape::none && luminance(sun.normal_illuminance) > 0.0f;
    const std::vector<Vec3f> sun_directions =
        sun_disc_directions(sun, sun.shape == SunShape::disc ? options.disc_samples : 1);
    std::vector<PointLight> light(points.size());
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        // no structured binding: clang 14 lets no inner lambda use one
        const Vec3f& normal = groups[g]->first;
        const std::vector<std::size_t>& members = groups[g]->second;
        const DomeSamples dome = sampler.sample(normal, options.sky_samples);
        const float cosine = glm::dot(normal, sun.direction);
        constexpr std::size_t kPacket = RayScene::kPacketSize;
        tbb::parallel_for(std::size_t{0}, (members.size() + kPacket - 1) / kPacket, [&](std::size_t p) {
            const std::size_t begin = p * kPacket, end = std::min(begin + kPacket, members.size());
            const int count = static_cast<int>(end - begin);
            float x[kPacket], y[kPacket], z[kPacket], share[kPacket];
            for (std::size_t i = begin; i < end; ++i) {
                const Vec3f origin = points[members[i]].position + rays.surface_offset() * normal;
                x[i - begin] = origin.x;
                y[i - begin] = origin.y;
                z[i - begin] = origin.z;
            }
            DirectionPacket packet(rays);
            for (std::size_t j = 0; j < dome.size(); ++j) {
                packet.set_direction(dome.directions[j]);
                packet.visibility(x, y, z, count, share);
                for (std::size_t i = begin; i < end; ++i) {
                    light[members[i]].sky += share[i - begin] * dome.weights[instant][j];
                    light[members[i]].sky_view_factor += share[i - begin] * dome.view_factor_weight[j];
                }
            }
            if (!has_sun || cosine <= 0.0f) return;
            for (const Vec3f& direction : sun_directions) {
                packet.set_direction(direction);
                packet.visibility(x, y, z, count, share);
                for (std::size_t i = begin; i < end; ++i)
                    light[members[i]].sun_visible += share[i - begin] / static_cast<float>(sun_directions.size());
            }
            for (std::size_t i = begin; i < end; ++i)
                light[members[i]].sun = light[members[i]].sun_visible * cosine * sun.normal_illuminance;
        });
    });
    return light;
}

std::vector<Rgb> light_points_by_lamps(std::span<const ReceiverPoint> points, std::span<const Lamp> lamps,
                                       const RayScene& rays) {
    std::vector<Rgb> light(points.size(), Rgb(0.0f));
    if (lamps.empty()) return light;
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const Vec3f origin = points[i].position + rays.surface_offset() * points[i].normal;
        for (const Lamp& lamp : lamps) {
            const Rgb irradiance = unobstructed_irradiance(lamp, points[i].position, points[i].normal);
            if (!(luminance(irradiance) > 0.0f)) continue;
            const Vec3f to_lamp = lamp.position - origin;
            const float distance = glm::length(to_lamp);
            light[i] += rays.visibility(origin, to_lamp / distance, distance) * irradiance;
        }
    });
    return light;
}

}  // namespace skybake
