// The scene of bench/cycles_bake: mesh with lightmap coordinates, sky, sun, our own bake with its seconds, and the true
// light at some texels.
//   bench_cycles_bake_scene CITY OUT_FOLDER TEXEL_M [RADIUS_M [TEXELS [PATHS [BOUNCES]]]]
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "atlas/chart_samples.h"
#include "bake/bake_lightmaps.h"
#include "bake/bake_report.h"
#include "cycles_export.h"
#include "light/path_reference.h"
#include "light/point_light.h"

namespace skybake::bench {
namespace {

constexpr int kSkySamples = 16384;

struct Texel {
    std::size_t page = 0, index = 0;  // in the page
    ReceiverPoint point;              // above its centre
};

/// Texels that lie wholly in a triangle, under a sun that is all there or not at all: a shadow's edge has another mean
/// over the texel than at its centre. Those that see under 2 % of the sky lie in houses.
std::vector<Texel> judged_texels(const Scene& scene, const Atlas& atlas, const Lightmaps& light) {
    std::vector<Texel> texels;
    const Vec3f& to_sun = light.instants[0].daylight.sun.direction;
    for (const Chart& chart : atlas.charts) {
        const ChartSamples samples = sample_chart(scene, chart);
        const std::size_t page = chart.page.index();
        for (int row = 0; row < chart.size.y; ++row) {
            for (int column = 0; column < chart.size.x; ++column) {
                const std::size_t i = samples.index(column, row);
                if (samples.cover[i] != ChartSamples::Cover::whole) continue;
                const std::size_t p = static_cast<std::size_t>(chart.position.y + row) *
                                          static_cast<std::size_t>(light.pages[page].width) +
                                      static_cast<std::size_t>(chart.position.x + column);
                if (light.pages[page].state[p] != TexelState::chart || light.pages[page].sky_view_factor[p] < 0.02f)
                    continue;
                const Vec3f normal = shading_normal(scene, chart, samples.triangle[i]);
                const float full = std::max(0.0f, glm::dot(normal, to_sun));
                const float cosine = light.instants[0].pages[page].sun_cosine[p];
                if (cosine > 0.01f * full && cosine < 0.98f * full) continue;
                texels.push_back({page, p, {samples.position[i] + kPointHeight * normal, normal}});
            }
        }
    }
    return texels;
}

int run(int argc, char** argv) {
    if (argc < 4) {
        fmt::print(stderr,
                   "usage: bench_cycles_bake_scene CITY OUT_FOLDER TEXEL_M [RADIUS_M [TEXELS [PATHS [BOUNCES]]]]\n");
        return 2;
    }
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    const float texel_m = std::strtof(argv[3], nullptr);
    const double radius = argc > 4 ? std::atof(argv[4]) : 1e6;
    const std::size_t wanted = argc > 5 ? static_cast<std::size_t>(std::atoll(argv[5])) : 2000;
    const int paths = argc > 6 ? std::atoi(argv[6]) : 4096;
    const int bounces = argc > 7 ? std::atoi(argv[7]) : 4;

    Scene scene = load_scene(argv[1], radius, texel_m);
    flatten_materials(scene);
    const Daylight daylight = write_daylight(folder);

    const auto begin = std::chrono::steady_clock::now();
    const Atlas atlas = build_atlas(scene, {texel_m});
    const RayScene rays(scene);
    BakeOptions options;
    options.bounces = BouncePhotons{{std::nullopt, bounces, 0}, {}};
    SilentProgress silent;
    BakeReport report;
    const Lightmaps light = bake_lightmaps(scene, atlas, rays, std::span(&daylight, 1), options, silent, report);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

    write_mesh(folder, scene, &atlas);
    fmt::ostream pages = fmt::output_file((folder / "pages.csv").string());
    pages.print("width,height\n");
    for (const AtlasPage& page : atlas.pages) pages.print("{},{}\n", page.width, page.height);

    const std::vector<Texel> all = judged_texels(scene, atlas, light);
    std::vector<Texel> texels;
    std::vector<ReceiverPoint> points;
    for (std::size_t k = 0; k < std::min(wanted, all.size()); ++k) {
        texels.push_back(all[k * all.size() / std::min(wanted, all.size())]);
        points.push_back(texels.back().point);
    }
    const DomeSampler sampler(std::span(&daylight, 1));
    const std::vector<PointLight> direct = light_points(points, sampler, 0, daylight.sun, rays, {kSkySamples, 1});
    const std::vector<IndirectLight> reflected =
        PathReference({daylight, {}}, scene, rays, {paths, bounces, 0}).light(points, silent);
    fmt::ostream csv = fmt::output_file((folder / "texels.csv").string());
    csv.print("page,column,row,true_lx,error_lx,skybake_lx\n");
    for (std::size_t k = 0; k < texels.size(); ++k) {
        const Texel& t = texels[k];
        const std::size_t width = static_cast<std::size_t>(atlas.pages[t.page].width);
        const Rgb truth = direct[k].sun + direct[k].sky + reflected[k].irradiance;
        csv.print("{},{},{},{},{},{}\n", t.page, t.index % width, t.index / width, luminance(truth),
                  reflected[k].standard_error_lx, luminance(total_irradiance(light, 0, t.page, t.index)));
    }
    fmt::print(
        "{} triangles, {} texels of {} m on {} pages; skybake: {:.1f} s (sky {:.1f}, photons {:.1f}, gather {:.1f})\n",
        scene.triangles.size(), atlas.texel_count(), texel_m, atlas.pages.size(), seconds, report.seconds.sky,
        report.seconds.photons, report.seconds.gather);
    fmt::output_file((folder / "skybake_seconds.txt").string()).print("{}\n", seconds);
    return 0;
}

}  // namespace
}  // namespace skybake::bench

int main(int argc, char** argv) {
    return skybake::bench::run(argc, argv);
}
