// The hierarchy against full sampling of the same directions, and the same bits whatever the number of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "bake/bake_lightmaps.h"
#include "base/hash_rng.h"
#include "scenes.h"

namespace skybake {
namespace {

/// Boxes of 8–20 m on a warped grid of 24 m, some with a chimney of 0.6 m: shadows of all lengths and features thinner
/// than a cell.
Scene box_town() {
    QuadScene town;
    town.ground(60);
    const auto random = [](int i, int j, int k) {
        return uniform_float(7, static_cast<std::uint64_t>(i + 10), static_cast<std::uint64_t>(j + 10),
                             static_cast<std::uint64_t>(k));
    };
    for (int i = -2; i < 2; ++i) {
        for (int j = -2; j < 2; ++j) {
            const Vec3f lo(24.0f * static_cast<float>(i) + 2.0f + 4.0f * random(i, j, 0),
                           24.0f * static_cast<float>(j) + 2.0f + 4.0f * random(i, j, 1), 0.0f);
            const Vec3f hi = lo + Vec3f(10.0f + 8.0f * random(i, j, 2), 10.0f + 8.0f * random(i, j, 3),
                                        8.0f + 12.0f * random(i, j, 4));
            town.box(lo, hi);
            if (random(i, j, 5) > 0.3f) {
                const Vec3f foot(lo.x + 3.0f, lo.y + 4.0f, hi.z - 0.3f);
                town.box(foot, foot + Vec3f(0.6f, 0.6f, 1.8f));
            }
        }
    }
    return town.scene();
}

Lightmaps bake(const Scene& scene, const Atlas& atlas, SkySampling sampling, BakeReport& report) {
    const RayScene rays(scene);
    SilentProgress silent;
    const std::vector<Daylight> instants{
        {"noon",
         UniformSky{1000.0f},
         {glm::normalize(Vec3f(0.3f, -0.6f, 0.7f)), Rgb(50000.0f), 700.0f, 0.00465f, SunShape::point}}};
    return bake_lightmaps(scene, atlas, rays, instants, {1024, sampling}, silent, report);
}

TEST(Hierarchy, KeepsItsToleranceAndSavesRays) {
    const Scene scene = box_town();
    const Atlas atlas = build_atlas(scene, {0.25f});
    BakeReport full_report, report;
    const Lightmaps full = bake(scene, atlas, SkySampling::full, full_report);
    const Lightmaps fast = bake(scene, atlas, SkySampling::hierarchical, report);
    double error2 = 0.0, sum = 0.0, count = 0.0, worst = 0.0;
    for (std::size_t p = 0; p < full.pages.size(); ++p) {
        for (std::size_t i = 0; i < full.pages[p].state.size(); ++i) {
            if (full.pages[p].state[i] != TexelState::chart) continue;
            const double a = static_cast<double>(luminance(full.instants[0].pages[p].sky[i])),
                         b = static_cast<double>(luminance(fast.instants[0].pages[p].sky[i]));
            error2 += (a - b) * (a - b);
            worst = std::max(worst, std::abs(a - b));
            sum += a;
            ++count;
        }
    }
    const double rmse = std::sqrt(error2 / count) / (sum / count);
    RecordProperty("rmse", std::to_string(rmse));
    std::printf("evaluated %.3f, rmse %.4f of the mean, predicted %.4f, worst %.3f of the mean\n",
                report.evaluated_fraction, rmse, report.predicted_rmse_over_mean, worst / (sum / count));
    EXPECT_EQ(full_report.evaluated_fraction, 1.0);
    EXPECT_LE(rmse, 0.01);
    EXPECT_LE(report.evaluated_fraction, 0.25);
}

Lightmaps bake_with_photons(const Scene& scene, const Atlas& atlas, SkySampling sampling, BakeReport& report) {
    const RayScene rays(scene);
    SilentProgress silent;
    const std::vector<Daylight> instants{
        {"noon",
         UniformSky{1000.0f},
         {glm::normalize(Vec3f(0.3f, -0.6f, 0.7f)), Rgb(50000.0f), 700.0f, 0.00465f, SunShape::point}}};
    BouncePhotons bounces;
    bounces.photons.count = 50'000;
    const BakeOptions options{64, sampling, 0.01f, bounces};
    return bake_lightmaps(scene, atlas, rays, instants, options, silent, report);
}

/// Reflected light from a lattice against every texel's own, from one photon map.
TEST(IndirectHierarchy, KeepsItsToleranceAndSavesGathers) {
    const Scene scene = box_town();
    const Atlas atlas = build_atlas(scene, {0.5f});
    BakeReport full_report, report;
    const Lightmaps full = bake_with_photons(scene, atlas, SkySampling::full, full_report);
    const Lightmaps fast = bake_with_photons(scene, atlas, SkySampling::projected, report);
    double error2 = 0.0, total = 0.0, indirect = 0.0, count = 0.0;
    for (std::size_t p = 0; p < full.pages.size(); ++p) {
        for (std::size_t i = 0; i < full.pages[p].state.size(); ++i) {
            if (full.pages[p].state[i] != TexelState::chart || fast.pages[p].state[i] != TexelState::chart) continue;
            const double a = static_cast<double>(luminance(full.instants[0].pages[p].indirect[i])),
                         b = static_cast<double>(luminance(fast.instants[0].pages[p].indirect[i]));
            error2 += (a - b) * (a - b);
            total += static_cast<double>(luminance(total_irradiance(full, 0, p, i)));
            indirect += a;
            ++count;
        }
    }
    std::printf("gathered %.3f of the texels, rmse %.4f of the mean light, %.3f of it reflected\n",
                report.indirect_evaluated_fraction, std::sqrt(error2 / count) / (total / count), indirect / total);
    EXPECT_GT(indirect, 0.03 * total);
    EXPECT_EQ(full_report.indirect_evaluated_fraction, 1.0);
    EXPECT_LE(std::sqrt(error2 / count) / (total / count), 0.01);
    EXPECT_LE(report.indirect_evaluated_fraction, 0.8);
    EXPECT_NEAR((report.photons.absorbed + report.photons.escaped + report.photons.at_limit) / report.photons.emitted,
                1.0, 1e-9);
}

TEST(Hierarchy, SameBitsForAnyNumberOfThreads) {
    const Scene scene = box_town();
    const Atlas atlas = build_atlas(scene, {0.5f});
    std::vector<Lightmaps> bakes;
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        BakeReport report;
        bakes.push_back(bake(scene, atlas, SkySampling::hierarchical, report));
    }
    for (std::size_t b = 1; b < bakes.size(); ++b) {
        for (std::size_t p = 0; p < bakes[0].pages.size(); ++p) {
            EXPECT_EQ(bakes[b].pages[p].state, bakes[0].pages[p].state);
            EXPECT_EQ(bakes[b].pages[p].sky_view_factor, bakes[0].pages[p].sky_view_factor);
            EXPECT_EQ(bakes[b].instants[0].pages[p].sky, bakes[0].instants[0].pages[p].sky);
            EXPECT_EQ(bakes[b].instants[0].pages[p].sun_cosine, bakes[0].instants[0].pages[p].sun_cosine);
        }
    }
}

}  // namespace
}  // namespace skybake
