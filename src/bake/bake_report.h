// The figures of one bake: what `bake --json` prints and the manifest keeps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace skybake {

struct RayCounts {
    std::uint64_t sun = 0;
    std::uint64_t sky = 0;
    std::uint64_t photon = 0;
    std::uint64_t feeler = 0;
    std::uint64_t lamp = 0;
};

/// Wall-clock seconds of each stage.
struct StageSeconds {
    double read = 0, build = 0, charts = 0, sun = 0, sky = 0, lamps = 0, photons = 0, gather = 0, finish = 0, write = 0,
           total = 0;
};

/// Where the photons' light went, all instants together, lm: emitted = absorbed + escaped + at_limit.
struct PhotonBalance {
    double emitted = 0, absorbed = 0, escaped = 0, at_limit = 0;
    std::uint64_t stored = 0;  // photons in the maps
};

/// lx; 0 where nothing was asked for.
struct IndirectNoise {
    double mean_lx = 0;   // of the reflected light over all texels
    double error_lx = 0;  // root mean square of its standard error
};

/// Texels that would be lit through walls, all instants together.
struct LeakReport {
    std::uint64_t texels = 0;
    double area_m2 = 0;
    double lumen = 0;             // the light kept out
    double picture_range_lx = 0;  // of the pictures' full colour: a tenth of the mean of all light
    struct Place {
        std::size_t instant = 0, page = 0, column = 0, row = 0;
        double leak_lx = 0;   // kept out
        double total_lx = 0;  // what is left there
    } worst;
};

struct BakeReport {
    std::uint64_t buildings = 0, triangles = 0, charts = 0, pages = 0, texels = 0;
    double texel_m = 0.5;
    RayCounts rays;
    StageSeconds seconds;
    double rays_per_second = 0.0;              // skylight rays over the seconds of the sky stage
    double evaluated_fraction = 1.0;           // (texel, direction) pairs really traced / all
    double predicted_rmse_over_mean = 0.0;     // of the hierarchy against full sampling, from the pilot directions
    double indirect_evaluated_fraction = 0.0;  // texels whose reflected light was computed / covered texels; 0 without
    IndirectNoise indirect;
    std::optional<LeakReport> leaks;
    PhotonBalance photons;
    std::uint64_t lamps = 0;
    double lamps_refined_fraction = 0.0;  // (texel, lamp) pairs sampled by 16 rays / all that a lamp can reach
    std::uint64_t peak_rss_bytes = 0;
};

}  // namespace skybake
