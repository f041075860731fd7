// Light at free points: the bake's own estimators, without an atlas.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "light/lamp.h"
#include "sky/daylight.h"
#include "sky/dome_sampling.h"
#include "trace/ray_scene.h"

namespace skybake {

/// A place that receives light: local metres, unit normal.
struct ReceiverPoint {
    Vec3f position{0.0f};
    Vec3f normal{0.0f, 0.0f, 1.0f};
};

/// Irradiance at one point, lx per channel.
struct PointLight {
    Rgb sun{0.0f};
    Rgb sky{0.0f};
    float sun_visible =
        0.0f;  // share of the sun that is not hidden, 0…1; 0 when the sun is behind the surface or below the horizon
    float sky_view_factor = 0.0f;  // cosine-weighted visible share of the sky: 1 on open ground, 0.5 on a free wall
};

struct PointLightOptions {
    int sky_samples = 1024;
    int disc_samples = 64;  // directions to the sun's disc under SunShape::disc
};

/// Light at each point from one instant (index `instant` of the sampler's). Points are lifted off their surface along
/// their normal. Parallel over points; the same bits for any number of threads.
std::vector<PointLight> light_points(std::span<const ReceiverPoint> points, const DomeSampler& sampler,
                                     std::size_t instant, const SunBeam& sun, const RayScene& rays,
                                     const PointLightOptions& options);

/// Irradiance by the lamps at each point, lx per channel: a ray to each lamp that shines on it. Parallel over points.
std::vector<Rgb> light_points_by_lamps(std::span<const ReceiverPoint> points, std::span<const Lamp> lamps,
                                       const RayScene& rays);

}  // namespace skybake
