// How much of the sky samples see: view factor, vertical sky component, and the sky's energy over a period.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "study/receivers.h"
#include "study/year_light.h"
#include "trace/ray_scene.h"

namespace skybake {

struct SkyShares {
    std::vector<float> sky_view_factor;    // cosine-weighted: 1 on open ground, 0.5 on a free wall
    std::vector<float> sky_component_pct;  // of the CIE overcast sky: illuminance over that of open ground; 39.62 on a
                                           // free wall ("vertical sky component"), 100 on open ground
    std::vector<float> sky_irradiation_kwh_m2;  // empty without a cumulated sky
    std::uint64_t rays = 0;
};

/// One set of `directions` for each normal (sky/dome_sampling.h) serves all three: they are traced once and weighed
/// with the CIE 1994 overcast sky (Moon & Spencer), a uniform sky and, where `year` is given, the sky's energy summed
/// over its period. Reflections do not count. Error: tests/study/sky_shares_test.cpp. Parallel; the same for any number
/// of threads.
SkyShares sky_shares(std::span<const Sample> samples, const Vec3d& scene_origin, const RayScene& rays, int directions,
                     const YearLight* year, Progress& progress);

}  // namespace skybake
