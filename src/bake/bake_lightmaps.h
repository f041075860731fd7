// The bake: light of every texel of an atlas.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "atlas/atlas.h"
#include "bake/bake_report.h"
#include "bake/lamp_chart.h"
#include "bake/lightmap.h"
#include "bake/sky_sampling.h"
#include "base/progress.h"
#include "light/photon_gather.h"
#include "light/photon_tracer.h"
#include "trace/ray_scene.h"

namespace skybake {

/// How reflected light is found.
struct BouncePhotons {
    PhotonOptions photons;  // for each instant
    GatherOptions gather;
};

struct BakeOptions {
    int sky_samples = 1024;  // directions a texel
    SkySampling sampling = SkySampling::projected;
    float tolerance = 0.01f;  // of the hierarchies, relative (SkyTileOptions, light_indirect)
    std::optional<BouncePhotons> bounces = std::nullopt;
    std::vector<Lamp> lamps = {};  // shine at all instants alike
    LampChartOptions lamp_sampling = {};
};

/// Sun, sky, lamps and, when asked for, reflected light of all instants for all texels. The dome is traced once and
/// weighed for each instant; sun and photons are traced for each, all photon maps being held at once (24 bytes a photon
/// at rest). Fills in the report's rays, seconds of its stages, rates and fractions. The same bits for any number of
/// threads. Throws Interrupted when the progress asks to stop.
Lightmaps bake_lightmaps(const Scene& scene, const Atlas& atlas, const RayScene& rays,
                         std::span<const Daylight> instants, const BakeOptions& options, Progress& progress,
                         BakeReport& report);

}  // namespace skybake
