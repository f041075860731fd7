#include "study/sun_intervals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace skybake {
namespace {

constexpr std::size_t kPacketsPerTask = 16;
/// Where something changes, short moments are near: those steps are cut into so many parts. Found by
/// bench_sun_intervals (docs/benchmarks.md).
constexpr int kBusyParts = 6;

/// Follows one packet through one day.
class PacketDay {
  public:
    PacketDay(std::span<const Sample> samples, PacketRange range, const SunDay& day, const Vec3d& scene_origin,
              const RayScene& rays, const SunIntervalOptions& options, DirectionPacket& packet)
        : day_(day),
          packet_(packet),
          origins_(packet_origins(samples, range, scene_origin, rays.surface_offset())),
          normal_(samples[range.begin].normal),
          least_cosine_(static_cast<float>(std::sin(radians_from_degrees(options.min_incidence_deg)))) {
        for (const DaySpan& span : day.spans()) {
            if (options.sampled) {
                sample(span, *options.sampled);
            } else {
                scan(span, static_cast<int>(std::lround(options.scan_s)));
            }
        }
    }

    std::array<std::vector<SunInterval>, RayScene::kPacketSize> lanes;
    std::uint64_t traced = 0;

  private:
    /// Bit i: sample i is in the sun.
    std::uint32_t sunny_at(double second) {
        const Vec3f direction = day_.direction(second);
        const float cosine = glm::dot(direction, normal_);
        if (!(cosine > 0.0f && cosine >= least_cosine_)) return 0;
        packet_.set_direction(direction);
        traced += static_cast<std::uint64_t>(origins_.count);
        return ~packet_.occluded(origins_.x, origins_.y, origins_.z, origins_.count) & origins_.all();
    }

    void change(double second, std::uint32_t changed, std::uint32_t now) {
        for (int i = 0; i < origins_.count; ++i) {
            if (!(changed >> i & 1u)) continue;
            if (now >> i & 1u) {
                lanes[i].push_back({static_cast<float>(second), static_cast<float>(second)});
            } else {
                lanes[i].back().end_s = static_cast<float>(second);
            }
        }
    }

    void refine(int a, int b, std::uint32_t at_a, std::uint32_t at_b) {
        if (at_a == at_b) return;
        if (b - a <= 1) return change(0.5 * (a + b), at_a ^ at_b, at_b);
        const int middle = a + (b - a) / 2;
        const std::uint32_t at_middle = sunny_at(middle);
        refine(a, middle, at_a, at_middle);
        refine(middle, b, at_middle, at_b);
    }

    void scan(const DaySpan& span, int step) {
        std::vector<int> times;
        std::vector<std::uint32_t> masks;
        for (int t = span.begin_s; t < span.end_s; t += step) times.push_back(t);
        times.push_back(span.end_s);
        for (const int t : times) masks.push_back(sunny_at(t));
        change(span.begin_s, masks.front(), masks.front());
        for (std::size_t i = 1; i < times.size(); ++i) {
            const bool is_busy = masks[i - 1] != masks[i] || (i > 1 && masks[i - 2] != masks[i - 1]) ||
                                 (i + 1 < times.size() && masks[i] != masks[i + 1]);
            int from = times[i - 1];
            std::uint32_t at_from = masks[i - 1];
            for (int part = 1; is_busy && part < kBusyParts; ++part) {
                const int to = times[i - 1] + (times[i] - times[i - 1]) * part / kBusyParts;
                if (to <= from) continue;
                const std::uint32_t at_to = sunny_at(to);
                refine(from, to, at_from, at_to);
                from = to;
                at_from = at_to;
            }
            refine(from, times[i], at_from, masks[i]);
        }
        change(span.end_s, masks.back(), 0);
    }

    void sample(const DaySpan& span, const SampledConstruction& sampled) {
        std::uint32_t before = sunny_at(span.begin_s);
        change(span.begin_s, before, before);
        double last = span.begin_s;
        for (int k = 1; span.begin_s + k * sampled.step_s <= span.end_s; ++k) {
            const double t = span.begin_s + k * sampled.step_s;
            const std::uint32_t now = sunny_at(t);
            const std::uint32_t rises = now & ~before, sets = before & ~now;
            switch (sampled.between) {
                case BetweenSamples::nearest:
                    change(0.5 * (last + t), rises | sets, now);
                    break;
                case BetweenSamples::shadow_needs_both:
                    change(last, rises, now);
                    change(t, sets, now);
                    break;
                case BetweenSamples::sun_needs_both:
                    change(t, rises, now);
                    change(last, sets, now);
                    break;
            }
            before = now;
            last = t;
        }
        change(span.end_s, before, 0);
    }

    const SunDay& day_;
    DirectionPacket& packet_;
    PacketOrigins origins_;
    Vec3f normal_;
    float least_cosine_;
};

}  // namespace

SunIntervals sun_intervals(std::span<const Sample> samples, const SunDay& day, const Vec3d& scene_origin,
                           const RayScene& rays, const SunIntervalOptions& options, Progress& progress) {
    const std::vector<PacketRange> packets = packet_ranges(samples);
    const std::size_t tasks = (packets.size() + kPacketsPerTask - 1) / kPacketsPerTask;
    struct TaskResult {
        std::vector<std::uint32_t> counts;
        std::vector<SunInterval> intervals;
        std::uint64_t rays = 0;
    };
    std::vector<TaskResult> results(tasks);
    progress.begin("sun", samples.size());
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
        if (progress.stop_requested()) return;
        DirectionPacket packet(rays);
        TaskResult& result = results[task];
        const std::size_t end = std::min(packets.size(), (task + 1) * kPacketsPerTask);
        for (std::size_t p = task * kPacketsPerTask; p < end; ++p) {
            const PacketDay followed(samples, packets[p], day, scene_origin, rays, options, packet);
            result.rays += followed.traced;
            for (std::uint32_t i = 0; i < packets[p].end - packets[p].begin; ++i) {
                result.counts.push_back(static_cast<std::uint32_t>(followed.lanes[i].size()));
                result.intervals.insert(result.intervals.end(), followed.lanes[i].begin(), followed.lanes[i].end());
            }
            progress.advance(packets[p].end - packets[p].begin);
        }
    });
    if (progress.stop_requested()) throw Interrupted();
    SunIntervals all;
    all.first.reserve(samples.size() + 1);
    for (TaskResult& result : results) {
        for (const std::uint32_t count : result.counts) all.first.push_back(all.first.back() + count);
        all.intervals.insert(all.intervals.end(), result.intervals.begin(), result.intervals.end());
        all.rays += result.rays;
        result = {};
    }
    return all;
}

SunDuration duration_of(std::span<const SunInterval> intervals, const SunDay& day, double min_run_s) {
    SunDuration duration;
    std::size_t next = 0;
    for (const DaySpan& span : day.spans()) {
        double shaded_since = span.begin_s;
        for (; next < intervals.size() && intervals[next].begin_s < static_cast<float>(span.end_s); ++next) {
            const double begin = static_cast<double>(intervals[next].begin_s);
            const double end = static_cast<double>(intervals[next].end_s);
            if (end <= begin || end - begin < min_run_s) continue;
            duration.sun_h += end - begin;
            duration.longest_sun_h = std::max(duration.longest_sun_h, end - begin);
            duration.longest_shadow_h = std::max(duration.longest_shadow_h, begin - shaded_since);
            shaded_since = end;
        }
        duration.longest_shadow_h = std::max(duration.longest_shadow_h, span.end_s - shaded_since);
    }
    for (double* value : {&duration.sun_h, &duration.longest_sun_h, &duration.longest_shadow_h}) *value /= 3600.0;
    duration.shadow_h = std::max(0.0, day.hours() - duration.sun_h);
    return duration;
}

}  // namespace skybake
