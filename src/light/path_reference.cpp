#include "light/path_reference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "light/flight.h"

namespace skybake {

namespace {

// Paths that one task traces, and whose sum is taken by itself.
constexpr int kPathsPerRun = 256;
// Hits after which Russian roulette may end a path: the first three carry most of a city's light.
constexpr int kSafeBounces = 3;

std::uint64_t stable_id(const ReceiverPoint& point) {
    std::uint64_t id = 0;
    for (const Vec3f& v : {point.position, point.normal}) {
        for (int axis = 0; axis < 3; ++axis) id = hash_combine(id, std::bit_cast<std::uint32_t>(v[axis]));
    }
    return id;
}

}  // namespace

PathReference::PathReference(const LightSources& sources, const Scene& scene, const RayScene& rays,
                             const PathOptions& options)
    : sources_(sources), scene_(scene), rays_(rays), options_(options), sky_(sources.daylight.sky) {}

/// One sample of the indirect irradiance.
Rgb PathReference::sample(const ReceiverPoint& point, RandomSequence& random) const {
    Rgb sum(0.0f), throughput(1.0f);
    std::optional<SurfacePoint> end = next_hit({point.position, point.normal, Rgb(0.0f), false}, random).end;
    for (int bounce = 1; end; ++bounce) {
        const SurfacePoint surface = *end;
        throughput *= surface.albedo;
        if (!(std::max({throughput.x, throughput.y, throughput.z}) > 0.0f)) break;
        sum += throughput * direct_irradiance(surface, random);
        if (bounce >= kSafeBounces) {
            const float survival = std::min(1.0f, std::max({throughput.x, throughput.y, throughput.z}));
            if (random.next() >= survival) break;
            throughput /= survival;
        }
        const Step step = next_hit(surface, random);
        if (!step.end) {
            if (has_sky()) sum += throughput * escaped(surface, step.direction);
            break;
        }
        if (bounce == options_.bounces) break;
        end = step.end;
    }
    return sum;
}

Vec3f PathReference::lifted(const Vec3f& position, const Vec3f& normal) const {
    return position + rays_.surface_offset() * normal;
}

PathReference::Step PathReference::next_hit(const SurfacePoint& surface, RandomSequence& random) const {
    const float u = random.next(), v = random.next();
    const Vec3f direction = surface.reflected_direction(u, v);
    return {direction, Flight(scene_, rays_).end(lifted(surface.position, surface.normal), direction, random)};
}

/// Irradiance by sun, lamps and sky; of the sky the share that the balance heuristic leaves to this density.
Rgb PathReference::direct_irradiance(const SurfacePoint& surface, RandomSequence& random) const {
    const Vec3f origin = lifted(surface.position, surface.normal);
    Rgb sum(0.0f);
    const SunBeam& sun = sources_.daylight.sun;
    if (has_beam(sun)) {
        const float u = random.next(), v = random.next();
        const Vec3f direction = sample_sun(sun, u, v);
        const float cosine = surface.cosine(direction);
        if (cosine > 0.0f) sum += cosine * rays_.visibility(origin, direction) * sun.normal_illuminance;
    }
    if (!sources_.lamps.empty()) sum += lamp_irradiance(surface, origin, random.next());
    if (has_sky()) {
        const float u = random.next(), v = random.next();
        const SkyDistribution::Sample sample = sky_.sample(u, v);
        const float cosine = surface.cosine(sample.direction);
        if (cosine > 0.0f) {
            const float density = sample.pdf_solid_angle + square_to_cosine_hemisphere_pdf(cosine);
            sum += sky_luminance(sources_.daylight.sky, sample.direction) *
                   (cosine * rays_.visibility(origin, sample.direction) / density);
        }
    }
    return sum;
}

/// The other share of the sky: a ray of the cosine's density that left the scene. The estimate π L times the
/// weight.
Rgb PathReference::escaped(const SurfacePoint& surface, const Vec3f& direction) const {
    const float cosine = surface.cosine(direction);
    if (cosine <= 0.0f || direction.z < 0.0f) return Rgb(0.0f);
    const float density = sky_.pdf(direction) + square_to_cosine_hemisphere_pdf(cosine);
    return sky_luminance(sources_.daylight.sky, direction) * (cosine / density);
}

/// One lamp, chosen by what it would give if nothing stood in the way.
Rgb PathReference::lamp_irradiance(const SurfacePoint& surface, const Vec3f& origin, float choice) const {
    const auto unobstructed = [&](const Lamp& lamp) {
        if (!surface.is_leaf) return unobstructed_irradiance(lamp, origin, surface.normal);
        const Vec3f to_lamp = glm::normalize(lamp.position - origin);
        return surface.cosine(to_lamp) * unobstructed_irradiance(lamp, origin, to_lamp);
    };
    double total = 0.0;
    for (const Lamp& lamp : sources_.lamps) total += static_cast<double>(luminance(unobstructed(lamp)));
    double wanted = static_cast<double>(choice) * total;
    for (const Lamp& lamp : sources_.lamps) {
        const Rgb irradiance = unobstructed(lamp);
        const double share = static_cast<double>(luminance(irradiance));
        wanted -= share;
        if (!(share > 0.0) || wanted >= 0.0) continue;
        const Vec3f to_lamp = lamp.position - origin;
        const float distance = glm::length(to_lamp);
        return irradiance *
               (rays_.visibility(origin, to_lamp / distance, distance) * static_cast<float>(total / share));
    }
    return Rgb(0.0f);
}

int PathReference::run_count() const {
    return (options_.paths + kPathsPerRun - 1) / kPathsPerRun;
}

PathReference::Sums PathReference::sum_of_run(const ReceiverPoint& point, int run) const {
    const std::uint64_t id = stable_id(point);
    Sums sums;
    for (int path = run * kPathsPerRun; path < std::min((run + 1) * kPathsPerRun, options_.paths); ++path) {
        RandomSequence random(options_.seed, id, static_cast<std::uint64_t>(path));
        const Vec3d value(sample(point, random));
        const double y = 0.2126 * value.x + 0.7152 * value.y + 0.0722 * value.z;
        sums.rgb += value;
        sums.luminance += y;
        sums.luminance2 += y * y;
    }
    return sums;
}

IndirectLight PathReference::mean_of(std::span<const Sums> runs) const {
    Sums sum;
    for (const Sums& run : runs) {
        sum.rgb += run.rgb;
        sum.luminance += run.luminance;
        sum.luminance2 += run.luminance2;
    }
    const double n = options_.paths;
    IndirectLight light;
    light.irradiance = Rgb(sum.rgb / n);
    if (options_.paths > 1) {
        const double variance = std::max(0.0, sum.luminance2 - sum.luminance * sum.luminance / n) / (n - 1.0);
        light.standard_error_lx = static_cast<float>(std::sqrt(variance / n));
    }
    return light;
}

IndirectLight PathReference::light(const ReceiverPoint& point) const {
    std::vector<Sums> runs;
    for (int run = 0; run < run_count(); ++run) runs.push_back(sum_of_run(point, run));
    return mean_of(runs);
}

std::vector<IndirectLight> PathReference::light(std::span<const ReceiverPoint> points, Progress& progress) const {
    const std::size_t runs = static_cast<std::size_t>(run_count());
    std::vector<Sums> sums(points.size() * runs);
    progress.begin("paths", sums.size());
    tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t t) {
        if (progress.stop_requested()) throw Interrupted();
        sums[t] = sum_of_run(points[t / runs], static_cast<int>(t % runs));
        progress.advance(1);
    });
    std::vector<IndirectLight> light(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) light[i] = mean_of(std::span(sums).subspan(i * runs, runs));
    return light;
}

}  // namespace skybake
