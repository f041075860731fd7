// Reflected light on one chart: on a coarse lattice, halved where it differs (paper §4.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/chart_samples.h"
#include "light/photon_gather.h"

namespace skybake {

struct IndirectStatistics {
    std::uint64_t evaluated = 0;  // gathers from the photon map
    std::uint64_t texels = 0;     // covered
    std::uint64_t rays = 0;       // feelers
};

/// Irradiance of each texel of the chart, lx per channel; 0 where it is not covered.
///
/// Nodes lie every 16 texels. A cell is halved when its centre differs from its corners' mean by more than `tolerance`
/// of the light there (`other_light_lx`, by texel, and what is reflected), or its corners from each other by more than
/// four times that, and always where the chart's border crosses it. Tolerance 0 evaluates every texel. The same bits
/// for any number of threads.
std::vector<Rgb> light_indirect(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                const PhotonGatherer& gatherer, std::span<const float> other_light_lx, float tolerance,
                                IndirectStatistics& statistics);

}  // namespace skybake
