// How near the bake comes to the rays that Embree can trace: skylight rays per second of a full bake, and of a bare
// loop of rtcOccluded16 with one direction over the same points of the same scene, taken in turns in one run.
//   bench_traversal CITY TEXEL_M [RADIUS_M] [ROUNDS]
#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <limits>

#include "atlas/chart_samples.h"
#include "bench_city.h"
#include "sky/dome_sampling.h"

namespace {

using namespace skybake;
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Points of one chart, in blocks of 4 × 4 texels within bands, as a tile's packets are.
struct ChartPoints {
    std::vector<float> x, y, z;
    std::vector<Vec3f> directions;
};

/// Nothing but rays: two threads, no accumulation, no refinement.
double bare_loop(RTCScene scene, const std::vector<ChartPoints>& charts) {
    std::atomic<std::uint64_t> rays{0};
    const auto begin = Clock::now();
    tbb::parallel_for(std::size_t{0}, charts.size(), [&](std::size_t c) {
        const ChartPoints& points = charts[c];
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        RTCRay16 packet{};
        alignas(64) int valid[16];
        std::fill_n(packet.mask, 16, ~0u);
        constexpr std::size_t kTile = 2400;  // as many points as a tile of the bake
        for (std::size_t tile = 0; tile < points.x.size(); tile += kTile) {
            const std::size_t end = std::min(tile + kTile, points.x.size());
            for (const Vec3f& d : points.directions) {
                std::fill_n(packet.dir_x, 16, d.x);
                std::fill_n(packet.dir_y, 16, d.y);
                std::fill_n(packet.dir_z, 16, d.z);
                for (std::size_t i = tile; i < end; i += 16) {
                    const std::size_t n = std::min<std::size_t>(16, end - i);
                    std::copy_n(&points.x[i], n, packet.org_x);
                    std::copy_n(&points.y[i], n, packet.org_y);
                    std::copy_n(&points.z[i], n, packet.org_z);
                    std::fill_n(packet.tfar, 16, std::numeric_limits<float>::infinity());
                    for (std::size_t k = 0; k < 16; ++k) valid[k] = k < n ? -1 : 0;
                    rtcOccluded16(valid, scene, &context, &packet);
                }
                rays += end - tile;
            }
        }
    });
    return static_cast<double>(rays) / seconds_since(begin);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: bench_traversal CITY TEXEL_M [RADIUS_M] [ROUNDS]\n");
        return 2;
    }
    const float texel_m = std::strtof(argv[2], nullptr);
    const Scene scene = bench::load_scene(argv[1], argc > 3 ? std::atof(argv[3]) : 1e9, texel_m);
    const int rounds = argc > 4 ? std::atoi(argv[4]) : 3;
    const Atlas atlas = build_atlas(scene, {texel_m});
    const RayScene rays(scene);
    const std::vector<Daylight> instants = bench::midsummer_noon();
    const DomeSampler sampler(instants);

    // The bare loop has a hierarchy of its own, built alike.
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene bare = rtcNewScene(device);
    rtcSetSceneFlags(bare, RTC_SCENE_FLAG_NONE);  // as RayScene does
    rtcSetSceneBuildQuality(bare, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 sizeof(Vec3f), 3 * scene.triangles.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), scene.triangles.size()));
    for (std::size_t i = 0; i < 3 * scene.triangles.size(); ++i) {
        vertices[i] = scene.triangles[i / 3][i % 3];
        indices[i] = static_cast<unsigned>(i);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(bare, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(bare);

    std::vector<ChartPoints> charts;
    for (const Chart& chart : atlas.charts) {
        const ChartSamples samples = sample_chart(scene, chart);
        ChartPoints& points = charts.emplace_back();
        for (int row = 0; row < samples.size.y; row += 4) {
            for (int column = 0; column < samples.size.x; column += 4) {
                for (int y = row; y < std::min(row + 4, samples.size.y); ++y) {
                    for (int x = column; x < std::min(column + 4, samples.size.x); ++x) {
                        const std::size_t i = samples.index(x, y);
                        if (samples.cover[i] == ChartSamples::Cover::none) continue;
                        const Vec3f p = samples.position[i] + rays.surface_offset() * chart.normal;
                        points.x.push_back(p.x);
                        points.y.push_back(p.y);
                        points.z.push_back(p.z);
                    }
                }
            }
        }
        points.directions = sampler.sample(chart.normal, 128).directions;
    }

    SilentProgress silent;
    fmt::print("{} triangles, {} charts, {:.2f} million texels of {} m, {}\n", scene.triangles.size(),
               atlas.charts.size(), static_cast<double>(atlas.texel_count()) * 1e-6, texel_m, rays.isa());
    fmt::print("{:>28} {:>28} {:>7} {:>34} {:>34}\n", "bare loop, million rays/s", "full bake, million rays/s", "share",
               "hierarchy: s, share of rays, of time", "projected: s, share of rays, of time");
    std::vector<double> shares;
    for (int round = 0; round < rounds; ++round) {
        const double limit = bare_loop(bare, charts);
        BakeReport full, hierarchy, projected;
        bake_lightmaps(scene, atlas, rays, instants, {1024, SkySampling::full}, silent, full);
        bake_lightmaps(scene, atlas, rays, instants, {1024, SkySampling::hierarchical}, silent, hierarchy);
        bake_lightmaps(scene, atlas, rays, instants, {1024, SkySampling::projected}, silent, projected);
        shares.push_back(full.rays_per_second / limit);
        fmt::print("{:28.1f} {:28.1f} {:6.1f}% {:16.2f} {:8.1f}% {:7.1f}% {:16.2f} {:8.1f}% {:7.1f}%\n", limit * 1e-6,
                   full.rays_per_second * 1e-6, 100.0 * shares.back(), hierarchy.seconds.sky,
                   100.0 * hierarchy.evaluated_fraction, 100.0 * hierarchy.seconds.sky / full.seconds.sky,
                   projected.seconds.sky, 100.0 * projected.evaluated_fraction,
                   100.0 * projected.seconds.sky / full.seconds.sky);
    }
    std::sort(shares.begin(), shares.end());
    fmt::print("median share of the bare loop: {:.1f} %\n", 100.0 * shares[shares.size() / 2]);
    rtcReleaseScene(bare);
    rtcReleaseDevice(device);
}
