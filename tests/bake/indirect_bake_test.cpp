// Reflected light of whole bakes: paths at each texel, photons against them, one instant at a time, leaks found.
#include <gtest/gtest.h>

#include <cmath>

#include "atlas/chart_samples.h"
#include "bake/bake_lightmaps.h"
#include "scenes.h"

namespace skybake {
namespace {

/// Two houses, the higher one in the sun.
Scene houses() {
    return QuadScene().ground(20).box({-6, 0, 0}, {6, 8, 6}).box({-6, 8, 0}, {6, 14, 14}).scene();
}

Daylight day(const Vec3f& sun) {
    return {"day", UniformSky{1000.0f}, {glm::normalize(sun), Rgb(50000.0f), 700.0f, 0.00465f, SunShape::point}};
}

Lightmaps bake(const Scene& scene, const Atlas& atlas, std::vector<Daylight> instants, const BakeOptions& options,
               BakeReport& report) {
    const RayScene rays(scene);
    SilentProgress silent;
    return bake_lightmaps(scene, atlas, rays, instants, options, silent, report);
}

template <typename Body>
void for_chart_texels(const Lightmaps& light, const Body& body) {
    for (std::size_t p = 0; p < light.pages.size(); ++p) {
        for (std::size_t t = 0; t < light.pages[p].state.size(); ++t) {
            if (light.pages[p].state[t] == TexelState::chart) body(p, t);
        }
    }
}

/// With full sampling each texel holds what the paths say at its place.
TEST(ReferenceBake, HoldsThePathsOfEachTexel) {
    const Scene scene = houses();
    const Atlas atlas = build_atlas(scene, {2.0f});
    const Daylight daylight = day({0.3f, -0.6f, 0.7f});
    const PathOptions paths{300, 4, 9};
    BakeReport report;
    const Lightmaps light = bake(scene, atlas, {daylight}, {64, SkySampling::full, 0.01f, paths}, report);
    const RayScene rays(scene);
    const LightSources sources{daylight, {}};
    const PathReference reference(sources, scene, rays, paths);
    double sum = 0.0, squares = 0.0, texels = 0.0;
    for (const Chart& chart : atlas.charts) {
        const ChartSamples samples = sample_chart(scene, chart);
        const LightmapPage& page = light.pages[chart.page.index()];
        const LightmapLayer& layer = light.instants[0].pages[chart.page.index()];
        for (int row = 0; row < chart.size.y; ++row) {
            for (int column = 0; column < chart.size.x; ++column) {
                const std::size_t p =
                    static_cast<std::size_t>((chart.position.y + row) * page.width + chart.position.x + column);
                if (page.state[p] != TexelState::chart) continue;
                const IndirectLight truth =
                    reference.light({samples.position[samples.index(column, row)], chart.normal});
                ASSERT_EQ(layer.indirect[p], truth.irradiance);
                ASSERT_EQ(layer.indirect_error[p], truth.standard_error_lx);
                sum += static_cast<double>(luminance(truth.irradiance));
                squares += std::pow(static_cast<double>(truth.standard_error_lx), 2);
                ++texels;
            }
        }
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_NEAR(report.indirect.mean_lx, sum / texels, 1e-6 * sum / texels);
    EXPECT_NEAR(report.indirect.error_lx, std::sqrt(squares / texels), 1e-6 * sum / texels);
    EXPECT_EQ(report.indirect_evaluated_fraction, 1.0);
}

/// A bake by photons has the mean light of a bake by paths, within what photons are allowed: 2 % of all light.
TEST(ReferenceBake, JudgesABakeByPhotons) {
    const Scene scene = houses();
    const Atlas atlas = build_atlas(scene, {1.0f});
    const Daylight daylight = day({0.3f, -0.6f, 0.7f});
    BakeReport report;
    BouncePhotons bounces;
    bounces.photons = {300'000, 4, 9};
    const Lightmaps photons = bake(scene, atlas, {daylight}, {64, SkySampling::projected, 0.01f, bounces}, report);
    const Lightmaps paths =
        bake(scene, atlas, {daylight}, {64, SkySampling::projected, 0.01f, PathOptions{256, 4, 9}}, report);
    EXPECT_LT(report.indirect_evaluated_fraction, 1.0);
    double difference = 0.0, total = 0.0;
    for_chart_texels(paths, [&](std::size_t p, std::size_t t) {
        difference += static_cast<double>(
            luminance(photons.instants[0].pages[p].indirect[t] - paths.instants[0].pages[p].indirect[t]));
        total += static_cast<double>(luminance(total_irradiance(paths, 0, p, t)));
    });
    std::printf("photons less paths: %.3f %% of the light\n", 100.0 * difference / total);
    EXPECT_LE(std::abs(difference), 0.02 * total);
}

TEST(IndirectBake, EachInstantIsAsItWouldBeAlone) {
    const Scene scene = houses();
    const Atlas atlas = build_atlas(scene, {1.0f});
    const std::vector<Daylight> instants{day({0.3f, -0.6f, 0.7f}), day({-0.7f, -0.2f, 0.3f})};
    BouncePhotons bounces;
    bounces.photons.count = 20'000;
    const BakeOptions options{64, SkySampling::full, 0.01f, bounces};
    BakeReport report;
    const Lightmaps both = bake(scene, atlas, instants, options, report);
    for (std::size_t k = 0; k < 2; ++k) {
        const Lightmaps alone = bake(scene, atlas, {instants[k]}, options, report);
        for (std::size_t p = 0; p < alone.pages.size(); ++p)
            EXPECT_EQ(both.instants[k].pages[p].indirect, alone.instants[0].pages[p].indirect);
    }
}

/// A dark passage behind a thin wall of a sunlit court, and the same court without the passage.
TEST(LeakReport, FindsThePassageAndNothingInTheOpen) {
    QuadScene open;
    open.ground(20).box({-15, -12, 0}, {15, -11, 3});
    QuadScene passage = open;
    passage.box({-15, 0, 0}, {15, 0.05f, 3}).box({-15, 3, 0}, {15, 3.5f, 3}).box({-15, 0, 3}, {15, 3.5f, 3.2f});
    BouncePhotons bounces;
    bounces.photons.count = 200'000;
    // Within some metres here; with more, what lies beyond a wall's foot in the open is a leak too.
    bounces.gather.nearest = 100;
    BakeOptions options{64, SkySampling::projected, 0.01f, bounces};
    options.keeps_leaks = true;
    const auto leaks = [&](QuadScene& quads) {
        const Scene scene = quads.scene();
        const Atlas atlas = build_atlas(scene, {0.5f});
        BakeReport report;
        const Lightmaps light = bake(scene, atlas, {day({0.0f, -0.6f, 0.7f})}, options, report);
        EXPECT_EQ(light.instants[0].pages[0].leak.size(), light.pages[0].state.size());
        return *report.leaks;
    };
    const LeakReport in_passage = leaks(passage), in_open = leaks(open);
    std::printf("passage: %.1f m2, %.3g lm, worst %.0f lx; open: %.1f m2\n", in_passage.area_m2, in_passage.lumen,
                in_passage.worst.leak_lx, in_open.area_m2);
    // The half of the passage that lies within the photons' reach from the court, at least.
    EXPECT_GT(in_passage.area_m2, 15.0);
    EXPECT_GT(in_passage.lumen, 0.0);
    EXPECT_LT(in_open.area_m2, 0.1 * in_passage.area_m2);
}

}  // namespace
}  // namespace skybake
