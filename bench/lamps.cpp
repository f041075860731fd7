// Lamps on a whole city: one ray, adaptive, and 16 rays a texel, and what the cutoff saves and costs.
//   bench_lamps CITY LAMPS TEXEL_M [CUTOFF_LX]
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <mutex>

#include "bake/lamp_chart.h"
#include "bench_city.h"
#include "io/lamps/read_lamps.h"

namespace {

using namespace skybake;

struct Run {
    std::vector<std::vector<Rgb>> light;  // [chart][texel]
    LampStatistics statistics;
    double seconds = 0.0;
};

struct Errors {
    double mean = 0.0, rmse = 0.0, edge_rmse = 0.0, worst = 0.0;
    std::uint64_t texels = 0, edges = 0;
};

/// Against the supersampled run, over texels that lie wholly in a polygon: of others one ray tells the light of a
/// point, and 16 the mean of the part inside, so that they differ where nothing is aliased. Edges are texels where one
/// ray is off by more than a hundredth of what 16 say.
Errors errors_of(const Run& run, const Run& single, const Run& full, const std::vector<ChartSamples>& samples) {
    Errors e;
    double squares = 0.0, edge_squares = 0.0, sum = 0.0;
    for (std::size_t c = 0; c < samples.size(); ++c) {
        for (std::size_t i = 0; i < samples[c].cover.size(); ++i) {
            if (samples[c].cover[i] != ChartSamples::Cover::whole) continue;
            const double truth = static_cast<double>(luminance(full.light[c][i]));
            const double off = static_cast<double>(luminance(run.light[c][i])) - truth;
            const double single_off = static_cast<double>(luminance(single.light[c][i])) - truth;
            sum += truth;
            squares += off * off;
            e.worst = std::max(e.worst, std::abs(off));
            ++e.texels;
            if (std::abs(single_off) <= 0.01 * truth) continue;
            ++e.edges;
            edge_squares += off * off;
        }
    }
    e.mean = sum / static_cast<double>(e.texels);
    e.rmse = std::sqrt(squares / static_cast<double>(e.texels));
    e.edge_rmse = std::sqrt(edge_squares / static_cast<double>(e.edges));
    return e;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        fmt::print(stderr, "usage: bench_lamps CITY LAMPS TEXEL_M [CUTOFF_LX]\n");
        return 2;
    }
    const float texel_m = std::strtof(argv[3], nullptr);
    const Scene scene = bench::load_scene(argv[1], 1e9, texel_m);
    FindingLog findings;
    const std::vector<Lamp> lamps = io::read_lamps(argv[2], scene.origin, std::nullopt, findings).lamps;
    const Atlas atlas = build_atlas(scene, {texel_m});
    const RayScene rays(scene);
    const LampTree tree(lamps);
    std::vector<ChartSamples> samples(atlas.charts.size());
    tbb::parallel_for(std::size_t{0}, samples.size(),
                      [&](std::size_t c) { samples[c] = sample_chart(scene, atlas.charts[c]); });
    const auto run = [&](const LampChartOptions& options) {
        Run result;
        result.light.resize(samples.size());
        std::mutex mutex;
        const auto begin = std::chrono::steady_clock::now();
        tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t c) {
            LampStatistics statistics;
            result.light[c] = light_lamps(scene, atlas.charts[c], samples[c], rays, tree, options, statistics);
            const std::lock_guard lock(mutex);
            result.statistics.add(statistics);
        });
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return result;
    };
    const float lowest = argc > 4 ? std::strtof(argv[4], nullptr) : 0.0f;
    const Run single = run({LampSampling::single, lowest}), full = run({LampSampling::full, lowest});
    fmt::print("{} triangles, {} lamps, {:.3f} million texels of {} m, mean of {:.2f} lx\n", scene.triangles.size(),
               lamps.size(), static_cast<double>(atlas.texel_count()) * 1e-6, texel_m,
               errors_of(full, single, full, samples).mean);
    fmt::print("{:>16} {:>9} {:>10} {:>9} {:>10} {:>8} {:>10} {:>14} {:>10}\n", "rays a texel", "cutoff lx", "Mpairs",
               "16 rays %", "Mrays", "s", "RMSE lx", "of edges, lx", "worst lx");
    const auto print = [&](const char* name, float cutoff, const Run& r) {
        const Errors e = errors_of(r, single, full, samples);
        const LampStatistics& s = r.statistics;
        fmt::print("{:>16} {:>9} {:>10.2f} {:>9.2f} {:>10.2f} {:>8.2f} {:>10.4f} {:>7.4f} ({:.1f} %) {:>8.2f}\n", name,
                   cutoff, static_cast<double>(s.pairs) * 1e-6,
                   100.0 * static_cast<double>(s.refined) / static_cast<double>(std::max<std::uint64_t>(s.pairs, 1)),
                   static_cast<double>(s.rays) * 1e-6, r.seconds, e.rmse, e.edge_rmse,
                   100.0 * static_cast<double>(e.edges) / static_cast<double>(e.texels), e.worst);
    };
    print("1", lowest, single);
    print("17", lowest, full);
    for (const float cutoff : {0.0f, 0.01f, 0.05f, 0.2f, 1.0f})
        if (cutoff >= lowest) print("adaptive", cutoff, run({LampSampling::adaptive, cutoff}));
}
