// The bake: light of every texel of an atlas.
#pragma once

#include <optional>
#include <span>
#include <variant>
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

/// Reflected light by photons.
struct BouncePhotons {
    PhotonOptions photons;  // for each instant
    GatherOptions gather;
};

/// How reflected light is found: by photons, or by paths from the texels (slow, unbiased, with standard errors).
using BounceOptions = std::variant<BouncePhotons, PathOptions>;

struct BakeOptions {
    int sky_samples = 1024;  // directions a texel
    SkySampling sampling = SkySampling::projected;
    float tolerance = 0.01f;  // of the hierarchies, relative (SkyTileOptions, light_indirect)
    std::optional<BounceOptions> bounces = std::nullopt;
    bool keeps_leaks = false;      // fills LightmapLayer::leak; for photons only
    std::vector<Lamp> lamps = {};  // shine at all instants alike
    LampChartOptions lamp_sampling = {};
};

/// Sun, sky, lamps and, when asked for, reflected light of all instants for all texels. The dome is traced once and
/// weighed for each instant; sun, photons and paths are traced for each, one photon map being held at a time (24 bytes
/// a photon at rest). Fills in the report's rays, seconds of its stages, rates and fractions. The same bits for any
/// number of threads. Throws Interrupted when the progress asks to stop.
Lightmaps bake_lightmaps(const Scene& scene, const Atlas& atlas, const RayScene& rays,
                         std::span<const Daylight> instants, const BakeOptions& options, Progress& progress,
                         BakeReport& report);

}  // namespace skybake
