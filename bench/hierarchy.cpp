// Rays against error: full sampling with fewer directions, projected shadows, and the hierarchy with several
// tolerances, all against a converged full bake, and the latter two against full sampling of their own directions.
//   bench_hierarchy CITY TEXEL_M [RADIUS_M] [REFERENCE_DIRECTIONS]
#include <cmath>

#include "bench_city.h"

namespace {

using namespace skybake;

struct Error {
    double rmse_over_mean = 0.0;
    double max_over_mean = 0.0;
    double bias_over_mean = 0.0;
    double mean = 0.0;
    std::uint64_t off = 0;  // texels off by more than a tenth of the mean
    std::uint64_t texels = 0;
};

/// Of the skylight's illuminance, over texels that belong to a chart and are not buried.
Error error_of(const Lightmaps& a, const Lightmaps& reference) {
    double squares = 0.0, sum = 0.0, bias = 0.0, worst = 0.0;
    Error error;
    const auto for_texels = [&](const auto& body) {
        for (std::size_t p = 0; p < reference.pages.size(); ++p) {
            for (std::size_t i = 0; i < reference.pages[p].state.size(); ++i) {
                if (reference.pages[p].state[i] != TexelState::chart || a.pages[p].state[i] != TexelState::chart)
                    continue;
                body(static_cast<double>(luminance(a.instants[0].pages[p].sky[i])),
                     static_cast<double>(luminance(reference.instants[0].pages[p].sky[i])));
            }
        }
    };
    for_texels([&](double x, double y) {
        squares += (x - y) * (x - y);
        bias += x - y;
        worst = std::max(worst, std::abs(x - y));
        sum += y;
        ++error.texels;
    });
    const double n = static_cast<double>(error.texels), mean = sum / n;
    for_texels([&](double x, double y) { error.off += std::abs(x - y) > 0.1 * mean; });
    error.mean = mean;
    error.rmse_over_mean = std::sqrt(squares / n) / mean;
    error.bias_over_mean = bias / n / mean;
    error.max_over_mean = worst / mean;
    return error;
}

/// Where a bake is off by more than a tenth of the mean: point, normal and signed error, the worst first.
void list_off_texels(const Atlas& atlas, const Lightmaps& fast, const Lightmaps& full, double mean) {
    struct Off {
        double error;
        const Chart* chart;
        Vec3f point;
    };
    std::vector<Off> off;
    for (const Chart& chart : atlas.charts) {
        const std::size_t p = chart.page.index();
        for (int row = 0; row < chart.size.y; ++row) {
            for (int column = 0; column < chart.size.x; ++column) {
                const std::size_t i =
                    static_cast<std::size_t>(chart.position.y + row) * static_cast<std::size_t>(full.pages[p].width) +
                    static_cast<std::size_t>(chart.position.x + column);
                if (full.pages[p].state[i] != TexelState::chart || fast.pages[p].state[i] != TexelState::chart)
                    continue;
                const double error = static_cast<double>(luminance(fast.instants[0].pages[p].sky[i]) -
                                                         luminance(full.instants[0].pages[p].sky[i]));
                if (std::abs(error) <= 0.1 * mean) continue;
                off.push_back({error / mean, &chart,
                               chart.origin + (static_cast<float>(column) + 0.5f) * chart.u +
                                   (static_cast<float>(row) + 0.5f) * chart.v});
            }
        }
    }
    std::sort(off.begin(), off.end(), [](const Off& a, const Off& b) { return std::abs(a.error) > std::abs(b.error); });
    for (const Off& texel : off) {
        const Vec3f& n = texel.chart->normal;
        const Vec3f& p = texel.point;
        fmt::print(
            "    off by {:+.1f} % at {:.2f} {:.2f} {:.2f}, normal {:.2f} {:.2f} {:.2f}, chart of {} x {} texels\n",
            100.0 * texel.error, p.x, p.y, p.z, n.x, n.y, n.z, texel.chart->size.x, texel.chart->size.y);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: bench_hierarchy CITY TEXEL_M [RADIUS_M] [REFERENCE_DIRECTIONS]\n");
        return 2;
    }
    const float texel_m = std::strtof(argv[2], nullptr);
    const Scene scene = bench::load_scene(argv[1], argc > 3 ? std::atof(argv[3]) : 1e9, texel_m);
    const int reference_directions = argc > 4 ? std::atoi(argv[4]) : 8192;
    const Atlas atlas = build_atlas(scene, {texel_m});
    const RayScene rays(scene);
    const std::vector<Daylight> instants = bench::midsummer_noon();
    SilentProgress silent;
    const auto bake = [&](const BakeOptions& options, BakeReport& report) {
        return bake_lightmaps(scene, atlas, rays, instants, options, silent, report);
    };
    BakeReport report;
    const Lightmaps reference = bake({reference_directions, SkySampling::full}, report);
    fmt::print("{} triangles, {:.3f} million texels of {} m; reference: full sampling, {} directions, {:.0f} s\n",
               scene.triangles.size(), static_cast<double>(atlas.texel_count()) * 1e-6, texel_m, reference_directions,
               report.seconds.sky);
    const double texels = static_cast<double>(report.rays.sky) / reference_directions;
    fmt::print("{:>12} {:>10} {:>12} {:>9} | {:>22} | {:>30} {:>9}\n", "sampling", "directions", "rays/texel", "sky s",
               "RMSE to reference, %", "to the same directions: RMSE %", "max %, texels off by 10 % of the mean");
    for (const int directions : {128, 256, 512, 1024, 2048}) {
        BakeReport full_report;
        const Lightmaps full = bake({directions, SkySampling::full}, full_report);
        const Error error = error_of(full, reference);
        fmt::print("{:>12} {:>10} {:>12.1f} {:>9.2f} | {:>22.3f} |\n", "full", directions,
                   static_cast<double>(full_report.rays.sky) / texels, full_report.seconds.sky,
                   100.0 * error.rmse_over_mean);
        if (directions < 512) continue;
        const auto print_row = [&](const std::string& name, const BakeOptions& options, bool lists_off) {
            BakeReport fast_report;
            const Lightmaps fast = bake(options, fast_report);
            const Error own = error_of(fast, full);
            fmt::print(
                "{:>12} {:>10} {:>12.1f} {:>9.2f} | {:>22.3f} | {:>30.3f} {:>9.1f} {} of {} ({:.1f} % of the rays)\n",
                name, directions, static_cast<double>(fast_report.rays.sky) / texels, fast_report.seconds.sky,
                100.0 * error_of(fast, reference).rmse_over_mean, 100.0 * own.rmse_over_mean, 100.0 * own.max_over_mean,
                own.off, own.texels, 100.0 * fast_report.evaluated_fraction);
            if (lists_off) list_off_texels(atlas, fast, full, own.mean);
        };
        print_row("projected", {directions, SkySampling::projected}, directions == 1024);
        for (const float tolerance : {0.02f, 0.01f, 0.005f}) {
            print_row(fmt::format("tol {}", tolerance), {directions, SkySampling::hierarchical, tolerance},
                      directions == 1024 && tolerance == 0.01f);
        }
    }
}
