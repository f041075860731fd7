// The sun on one chart (paper §3.3, §4.2): a light at infinity, a ray a texel, and more where neighbours disagree.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/chart_samples.h"
#include "sky/daylight.h"
#include "trace/ray_scene.h"

namespace skybake {

/// Sunlit share of each texel times the cosine of incidence, 0…1; one entry a texel of the chart, 0 where it is not
/// covered.
///
/// `SunShape::point`: a ray from each texel's point; where the texels about it do not all agree, 16 points spread over
/// the part of the texel inside the polygon, so that a shadow's edge is antialiased by area. `SunShape::disc`: rays to
/// 5 points of the sun's disc, and where they or the neighbours disagree, 64 pairs of a point in the texel and a point
/// of the disc. Adds the number of rays to `ray_count`.
std::vector<float> light_sun(const Scene& scene, const Chart& chart, const ChartSamples& samples, const RayScene& rays,
                             const SunBeam& sun, std::uint64_t& ray_count);

}  // namespace skybake
