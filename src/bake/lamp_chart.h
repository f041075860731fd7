// Direct light of lamps on one chart (paper §3.3): a ray a texel, and more where neighbours disagree.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/chart_samples.h"
#include "base/rgb.h"
#include "light/lamp_tree.h"
#include "trace/ray_scene.h"

namespace skybake {

enum class LampSampling {
    adaptive,  // 16 rays where neighbours disagree
    single,    // a ray a texel
    full       // 16 rays a texel
};

struct LampChartOptions {
    LampSampling sampling = LampSampling::adaptive;
    /// Lamps whose light, all together, cannot exceed this at a tile of texels are left out there, lx (LampTree).
    float cutoff_lx = 0.05f;
};

/// Pairs of a texel and a lamp that would light it, were nothing in the way.
struct LampStatistics {
    std::uint64_t pairs = 0;
    std::uint64_t refined = 0;  // of them, with 16 rays
    std::uint64_t rays = 0;

    void add(const LampStatistics& other) {
        pairs += other.pairs;
        refined += other.refined;
        rays += other.rays;
    }
};

/// Irradiance of each texel of the chart, lx per channel; 0 where it is not covered.
///
/// For each lamp, a ray from each texel's point; 16 points spread over the part of the texel inside the polygon where
/// the lit of the 3 × 3 texels about it and the dark meet, or where the light bends so much from texel to texel that
/// its middle may be off the texel's mean by more than 0.4 %. Only where the lamp may give more than a hundredth of the
/// light that the texel's points see of all lamps. The same bits for any number of threads.
std::vector<Rgb> light_lamps(const Scene& scene, const Chart& chart, const ChartSamples& samples, const RayScene& rays,
                             const LampTree& lamps, const LampChartOptions& options, LampStatistics& statistics);

}  // namespace skybake
