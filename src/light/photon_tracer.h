// Photons on their way from sun, sky and lamps through the city (paper §3.1).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "light/light_sources.h"
#include "light/photon.h"
#include "scene/scene.h"
#include "trace/ray_scene.h"

namespace skybake {

struct PhotonOptions {
    /// Emitted; a few more where faint sources would be left out. Without, default_photon_count.
    std::optional<std::uint64_t> count = std::nullopt;
    int bounces = 8;  // reflections at most
    std::uint64_t seed = 0;
};

/// Where the light went, lm. emitted = absorbed + escaped + at_limit.
struct PhotonLedger {
    double emitted = 0.0;
    double absorbed = 0.0;
    double escaped = 0.0;   // to the sky, on the first flight or after a reflection
    double at_limit = 0.0;  // still under way after the last reflection that was asked for; stored where it arrived
    std::uint64_t photons = 0;
    std::uint64_t rays = 0;
};

struct PhotonRun {
    std::vector<Photon> photons;  // from the second hit on: direct light is never stored
    PhotonLedger ledger;
};

/// Twenty a square metre of surface, between one million and two hundred: the error goes with the photons' density, not
/// with their number (docs/benchmarks.md, "Photons against the reference").
std::uint64_t default_photon_count(const Scene& scene);

/// Sun and sky shine through the faces of the scene's box, so that no photon starts where it could not meet the city. A
/// pilot run of a twentieth finds from where on the faces light comes to rest after a reflection: most photons start
/// there, and few above open land; what they carry is weighed accordingly. Each source gets photons by its flux and
/// their worth. Within a source, places and directions of departure are a low-discrepancy sequence. At its first
/// reflection a photon loses what is absorbed; it survives each later one with the share of its luminous flux that is
/// reflected, and keeps its flux when it does: the ledger closes for each photon. Photon i depends on the seed, the
/// sources and i alone. Parallel; photons come in the order of i. Throws Interrupted.
PhotonRun trace_photons(const LightSources& sources, const Scene& scene, const RayScene& rays,
                        const PhotonOptions& options, Progress& progress);

}  // namespace skybake
