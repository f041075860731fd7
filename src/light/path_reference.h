// The judge of all other estimates of reflected light: paths, without any approximation but the number of bounces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "light/light_sources.h"
#include "light/point_light.h"
#include "scene/scene.h"
#include "trace/ray_scene.h"

namespace skybake {

struct PathOptions {
    int paths = 1024;  // per point
    int bounces = 8;   // reflections at most; the light that was reflected more often is missing
    std::uint64_t seed = 0;
};

/// Light that arrives after one or more reflections.
struct IndirectLight {
    Rgb irradiance{0.0f};            // lx per channel
    float standard_error_lx = 0.0f;  // of the luminance-weighted irradiance; 0 where it is not known
};

/// Unbiased: the mean over seeds is the irradiance by light of 1…bounces reflections. Each path starts with the
/// cosine's density about the point's normal; at each of its hits sun and one lamp are asked directly, the sky by its
/// own density and by the path's next ray, weighted by the balance heuristic (E. Veach, L. Guibas, "Optimally combining
/// sampling techniques for Monte Carlo rendering", 1995); Russian roulette after the third hit. Points are lifted off
/// their surface along their normal. A point's random numbers are hashes of the seed, its place and its normal: they do
/// not hang on the other points nor on threads. Throws Interrupted.
std::vector<IndirectLight> trace_indirect(std::span<const ReceiverPoint> points, const LightSources& sources,
                                          const Scene& scene, const RayScene& rays, const PathOptions& options,
                                          Progress& progress);

}  // namespace skybake
