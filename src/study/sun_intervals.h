// When each sample has direct sun, to the second.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "study/packets.h"
#include "study/receivers.h"
#include "study/sun_day.h"
#include "trace/ray_scene.h"

namespace skybake {

/// Seconds after SunDay::begin.
struct SunInterval {
    float begin_s = 0.0f;
    float end_s = 0.0f;
    friend bool operator==(const SunInterval&, const SunInterval&) = default;
};

/// The sunny intervals of many samples, in flat arrays; those of sample i in ascending order, apart from each other.
struct SunIntervals {
    std::vector<std::uint64_t> first{0};  // one more than there are samples
    std::vector<SunInterval> intervals;
    std::uint64_t rays = 0;  // traced to find them

    std::span<const SunInterval> of(std::size_t sample) const {
        return std::span(intervals).subspan(first[sample], first[sample + 1] - first[sample]);
    }
};

/// What holds between two instants of a sampled construction when the first and the second differ.
enum class BetweenSamples {
    nearest,            // each instant stands for half a step before and after it
    shadow_needs_both,  // shadow lasts from the first shaded to the last shaded instant
    sun_needs_both      // sun lasts from the first sunny to the last sunny instant
};

struct SampledConstruction {
    double step_s = 3600.0;
    BetweenSamples between = BetweenSamples::nearest;
};

struct SunIntervalOptions {
    /// Step of the scan in which crossings are looked for, seconds. A sunny or shaded moment that is shorter may be
    /// missed: docs/validation.md says how many are.
    double scan_s = 60.0;
    /// The sun counts at this angle above the surface's plane, degrees.
    double min_incidence_deg = 0.0;
    /// Instead of the exact crossings: only the instants begin, begin + step, … of each span of the day.
    std::optional<SampledConstruction> sampled = std::nullopt;
};

/// The intervals of direct sun. Each packet is traced at the steps of the scan; a step in which its mask of sunny
/// samples changes, or changes in a neighbouring step, is cut into six parts, and parts whose masks differ are halved
/// on to 1 s: ends are right to 0.5 s for the sun's middle. Each trace of a halving asks all samples of the packet, so
/// that moments shorter than the scan are found near any crossing of a neighbour. Parallel; the same for any number of
/// threads. Throws Interrupted when `progress` wants to stop.
SunIntervals sun_intervals(std::span<const Sample> samples, const SunDay& day, const Vec3d& scene_origin,
                           const RayScene& rays, const SunIntervalOptions& options, Progress& progress);

/// What intervals add up to; hours.
struct SunDuration {
    double sun_h = 0.0;
    double longest_sun_h = 0.0;
    double shadow_h = 0.0;
    double longest_shadow_h = 0.0;
};

/// Sun in intervals of at least `min_run_s`, and the shadow that is left of the day's spans. A run does not reach over
/// a gap between spans.
SunDuration duration_of(std::span<const SunInterval> intervals, const SunDay& day, double min_run_s = 0.0);

}  // namespace skybake
