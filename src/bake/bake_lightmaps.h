// The bake: light of every texel of an atlas.
#pragma once

#include <optional>
#include <span>

#include "atlas/atlas.h"
#include "bake/bake_report.h"
#include "bake/lightmap.h"
#include "base/progress.h"
#include "trace/ray_scene.h"

namespace skybake {

struct BakeOptions {
    int sky_samples = 1024;                  // directions a texel
    std::optional<float> tolerance = 0.01f;  // of the hierarchy, relative (SkyTileOptions); none: full sampling
};

/// Sun and sky of all instants for all texels. The dome is traced once and weighed for each instant; the sun is traced
/// for each. Fills in the report's rays, seconds of the stages sun, sky and finish, rates and fractions. The same bits
/// for any number of threads. Throws Interrupted when the progress asks to stop.
Lightmaps bake_lightmaps(const Scene& scene, const Atlas& atlas, const RayScene& rays,
                         std::span<const Daylight> instants, const BakeOptions& options, Progress& progress,
                         BakeReport& report);

}  // namespace skybake
