// Reflected light on one chart: on a coarse lattice, halved where it differs (paper §4.2).
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "atlas/chart_samples.h"
#include "light/path_reference.h"
#include "light/photon_gather.h"

namespace skybake {

/// What answers for the reflected light of one instant.
using IndirectEstimator = std::variant<PhotonGatherer, PathReference>;

struct IndirectStatistics {
    std::uint64_t evaluated = 0;  // texels that the estimator was asked for
    std::uint64_t texels = 0;     // covered
    std::uint64_t rays = 0;       // feelers
};

/// Reflected light of each texel of the chart; nothing where it is not covered.
///
/// Nodes lie every 16 texels. A cell is halved when its centre differs from its corners' mean by more than `tolerance`
/// of the light there (`other_light_lx`, by texel, and what is reflected), or its corners from each other by more than
/// four times that, and always where the chart's border crosses it. Tolerance 0 evaluates every texel. Standard errors
/// are interpolated too, which bounds them from above. The same bits for any number of threads. Throws Interrupted.
std::vector<IndirectLight> light_indirect(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                          const IndirectEstimator& estimator, std::span<const float> other_light_lx,
                                          float tolerance, const Progress& progress, IndirectStatistics& statistics);

}  // namespace skybake
