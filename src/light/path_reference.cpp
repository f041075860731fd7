#include "light/path_reference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/hash_rng.h"
#include "light/sky_distribution.h"
#include "light/surfaces.h"

namespace skybake {

namespace {

// Paths that one task traces.
constexpr int kPathsPerTask = 256;
// Hits after which Russian roulette may end a path: the first three carry most of a city's light.
constexpr int kSafeBounces = 3;

class PathTracer {
  public:
    PathTracer(const LightSources& sources, const Scene& scene, const RayScene& rays, const PathOptions& options)
        : sources_(sources), scene_(scene), rays_(rays), options_(options), sky_(sources.daylight.sky) {}

    /// One sample of the indirect irradiance.
    Rgb sample(const ReceiverPoint& point, RandomSequence& random) const {
        Rgb sum(0.0f), throughput(1.0f);
        auto hit = next_hit(point.position, point.normal, random).hit;
        for (int bounce = 1; hit; ++bounce) {
            const SurfacePoint surface = surface_point(scene_, *hit);
            throughput *= surface.albedo;
            if (!(std::max({throughput.x, throughput.y, throughput.z}) > 0.0f)) break;
            sum += throughput * direct_irradiance(surface, random);
            if (bounce >= kSafeBounces) {
                const float survival = std::min(1.0f, std::max({throughput.x, throughput.y, throughput.z}));
                if (random.next() >= survival) break;
                throughput /= survival;
            }
            const Step step = next_hit(surface.position, surface.normal, random);
            if (!step.hit) {
                if (has_sky()) sum += throughput * escaped(step.direction, surface.normal);
                break;
            }
            if (bounce == options_.bounces) break;
            hit = step.hit;
        }
        return sum;
    }

  private:
    struct Step {
        Vec3f direction{0.0f};
        std::optional<Hit> hit;
    };

    bool has_sky() const { return sky_.total() > 0.0; }

    Vec3f lifted(const Vec3f& position, const Vec3f& normal) const {
        return position + rays_.surface_offset() * normal;
    }

    Step next_hit(const Vec3f& position, const Vec3f& normal, RandomSequence& random) const {
        const float u = random.next(), v = random.next();
        const Vec3f direction = square_to_cosine_hemisphere(normal, u, v);
        return {direction, rays_.first_hit(lifted(position, normal), direction)};
    }

    /// Irradiance by sun, lamps and sky; of the sky the share that the balance heuristic leaves to this density.
    Rgb direct_irradiance(const SurfacePoint& surface, RandomSequence& random) const {
        const Vec3f origin = lifted(surface.position, surface.normal);
        Rgb sum(0.0f);
        const SunBeam& sun = sources_.daylight.sun;
        if (has_beam(sun)) {
            const float u = random.next(), v = random.next();
            const Vec3f direction = sample_sun(sun, u, v);
            const float cosine = glm::dot(surface.normal, direction);
            if (cosine > 0.0f && !rays_.is_occluded(origin, direction)) sum += cosine * sun.normal_illuminance;
        }
        if (!sources_.lamps.empty()) sum += lamp_irradiance(surface, origin, random.next());
        if (has_sky()) {
            const float u = random.next(), v = random.next();
            const SkyDistribution::Sample sample = sky_.sample(u, v);
            const float cosine = glm::dot(surface.normal, sample.direction);
            if (cosine > 0.0f && !rays_.is_occluded(origin, sample.direction)) {
                const float density = sample.pdf_solid_angle + square_to_cosine_hemisphere_pdf(cosine);
                sum += sky_luminance(sources_.daylight.sky, sample.direction) * (cosine / density);
            }
        }
        return sum;
    }

    /// The other share of the sky: a ray of the cosine's density that left the scene. The estimate π L times the
    /// weight.
    Rgb escaped(const Vec3f& direction, const Vec3f& normal) const {
        const float cosine = glm::dot(normal, direction);
        if (cosine <= 0.0f || direction.z < 0.0f) return Rgb(0.0f);
        const float density = sky_.pdf(direction) + square_to_cosine_hemisphere_pdf(cosine);
        return sky_luminance(sources_.daylight.sky, direction) * (cosine / density);
    }

    /// One lamp, chosen by what it would give if nothing stood in the way.
    Rgb lamp_irradiance(const SurfacePoint& surface, const Vec3f& origin, float choice) const {
        double total = 0.0;
        for (const Lamp& lamp : sources_.lamps)
            total += static_cast<double>(luminance(unobstructed_irradiance(lamp, origin, surface.normal)));
        double wanted = static_cast<double>(choice) * total;
        for (const Lamp& lamp : sources_.lamps) {
            const Rgb irradiance = unobstructed_irradiance(lamp, origin, surface.normal);
            const double share = static_cast<double>(luminance(irradiance));
            wanted -= share;
            if (!(share > 0.0) || wanted >= 0.0) continue;
            const Vec3f to_lamp = lamp.position - origin;
            const float distance = glm::length(to_lamp);
            if (rays_.is_occluded(origin, to_lamp / distance, distance)) return Rgb(0.0f);
            return irradiance * static_cast<float>(total / share);
        }
        return Rgb(0.0f);
    }

    const LightSources& sources_;
    const Scene& scene_;
    const RayScene& rays_;
    const PathOptions& options_;
    SkyDistribution sky_;
};

std::uint64_t stable_id(const ReceiverPoint& point) {
    std::uint64_t id = 0;
    for (const Vec3f& v : {point.position, point.normal}) {
        for (int axis = 0; axis < 3; ++axis) id = hash_combine(id, std::bit_cast<std::uint32_t>(v[axis]));
    }
    return id;
}

/// Sums over the paths of one task.
struct PathSums {
    Vec3d rgb{0.0};
    double luminance = 0.0;
    double luminance2 = 0.0;
};

}  // namespace

std::vector<IndirectLight> trace_indirect(std::span<const ReceiverPoint> points, const LightSources& sources,
                                          const Scene& scene, const RayScene& rays, const PathOptions& options,
                                          Progress& progress) {
    const PathTracer tracer(sources, scene, rays, options);
    const std::size_t tasks = static_cast<std::size_t>((options.paths + kPathsPerTask - 1) / kPathsPerTask);
    std::vector<PathSums> sums(points.size() * tasks);
    progress.begin("paths", points.size() * static_cast<std::uint64_t>(options.paths));
    tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t t) {
        if (progress.stop_requested()) throw Interrupted();
        const ReceiverPoint& point = points[t / tasks];
        const int begin = static_cast<int>(t % tasks) * kPathsPerTask;
        const int end = std::min(begin + kPathsPerTask, options.paths);
        const std::uint64_t id = stable_id(point);
        for (int path = begin; path < end; ++path) {
            RandomSequence random(options.seed, id, static_cast<std::uint64_t>(path));
            const Vec3d value(tracer.sample(point, random));
            const double y = 0.2126 * value.x + 0.7152 * value.y + 0.0722 * value.z;
            sums[t].rgb += value;
            sums[t].luminance += y;
            sums[t].luminance2 += y * y;
        }
        progress.advance(static_cast<std::uint64_t>(end - begin));
    });

    std::vector<IndirectLight> light(points.size());
    const double n = options.paths;
    for (std::size_t i = 0; i < points.size(); ++i) {
        PathSums sum;
        for (std::size_t t = i * tasks; t < (i + 1) * tasks; ++t) {
            sum.rgb += sums[t].rgb;
            sum.luminance += sums[t].luminance;
            sum.luminance2 += sums[t].luminance2;
        }
        light[i].irradiance = Rgb(sum.rgb / n);
        if (options.paths > 1) {
            const double variance = std::max(0.0, sum.luminance2 - sum.luminance * sum.luminance / n) / (n - 1.0);
            light[i].standard_error_lx = static_cast<float>(std::sqrt(variance / n));
        }
    }
    return light;
}

}  // namespace skybake
