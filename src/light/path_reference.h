// The judge of all other estimates of reflected light: paths, without any approximation but the number of bounces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/hash_rng.h"
#include "base/progress.h"
#include "light/light_sources.h"
#include "light/point_light.h"
#include "light/sky_distribution.h"
#include "light/surfaces.h"
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
    float leak_lx = 0.0f;            // what photons beyond the feelers would add, luminance-weighted; 0 for paths
};

/// Unbiased: the mean over seeds is the irradiance by light of 1…bounces reflections. Each path starts with the
/// cosine's density about the point's normal; at each of its hits sun and one lamp are asked directly, the sky by its
/// own density and by the path's next ray, weighted by the balance heuristic (E. Veach, L. Guibas, "Optimally combining
/// sampling techniques for Monte Carlo rendering", 1995); Russian roulette after the third hit. Points are lifted off
/// their surface along their normal. A point's random numbers are hashes of the seed, its place and its normal: they do
/// not hang on the other points nor on threads. Sources, scene and rays must outlive it. Thread-safe.
class PathReference {
  public:
    PathReference(const LightSources& sources, const Scene& scene, const RayScene& rays, const PathOptions& options);

    IndirectLight light(const ReceiverPoint& point) const;
    /// The same light at many points; parallel. Throws Interrupted.
    std::vector<IndirectLight> light(std::span<const ReceiverPoint> points, Progress& progress) const;

  private:
    /// Sums over a run of paths.
    struct Sums {
        Vec3d rgb{0.0};
        double luminance = 0.0;
        double luminance2 = 0.0;
    };
    struct Step {
        Vec3f direction{0.0f};
        std::optional<SurfacePoint> end;
    };

    int run_count() const;
    Sums sum_of_run(const ReceiverPoint& point, int run) const;
    IndirectLight mean_of(std::span<const Sums> runs) const;
    Rgb sample(const ReceiverPoint& point, RandomSequence& random) const;
    bool has_sky() const { return sky_.total() > 0.0; }
    Vec3f lifted(const Vec3f& position, const Vec3f& normal) const;
    Step next_hit(const SurfacePoint& surface, RandomSequence& random) const;
    Rgb direct_irradiance(const SurfacePoint& surface, RandomSequence& random) const;
    Rgb escaped(const SurfacePoint& surface, const Vec3f& direction) const;
    Rgb lamp_irradiance(const SurfacePoint& surface, const Vec3f& origin, float choice) const;

    const LightSources& sources_;
    const Scene& scene_;
    const RayScene& rays_;
    PathOptions options_;
    SkyDistribution sky_;
};

}  // namespace skybake
