// The bake: light of every texel of an atlas.
#pragma once

#include <span>

#include "atlas/atlas.h"
#include "bake/bake_report.h"
#include "bake/lightmap.h"
#include "bake/sky_sampling.h"
#include "base/progress.h"
#include "trace/ray_scene.h"

namespace skybake {

struct BakeOptions {
    int sky_samples = 1024;  // directions a texel
    SkySampling sampling = SkySampling::projected;
    float tolerance = 0.01f;  // of the hierarchy, relative (SkyTileOptions)
};

/// Sun and sky of all instants for all texels. The dome is traced once and weighed for each instant; the sun is traced
/// for each. Fills in the report's rays, seconds of the stages sun, sky and finish, rates and fractions. The same bits
/// for any number of threads. Throws Interrupted when the progress asks to stop.
Lightmaps bake_lightmaps(const Scene& scene, const Atlas& atlas, const RayScene& rays,
                         std::span<const Daylight> instants, const BakeOptions& options, Progress& progress,
                         BakeReport& report);

}  // namespace skybake
