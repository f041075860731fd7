// Lamps on a chart: closed forms where nothing is in the way, the area of shadows and cones at their edges.
#include "bake/lamp_chart.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "atlas/atlas.h"
#include "scenes.h"

namespace skybake {
namespace {

/// The light of the lamps on the ground's chart.
struct Lit {
    Atlas atlas;
    const Chart* chart = nullptr;
    ChartSamples samples;
    std::vector<Rgb> light;
    LampStatistics statistics;

    Vec3f position(std::size_t i) const { return samples.position[i]; }
    double lux(std::size_t i) const { return static_cast<double>(luminance(light[i])); }
};

Lit light_ground(const Scene& scene, const std::vector<Lamp>& lamps, const LampChartOptions& options,
                 float texel_m = 0.25f) {
    Lit lit;
    lit.atlas = build_atlas(scene, {texel_m});
    const RayScene rays(scene);
    for (const Chart& chart : lit.atlas.charts) {
        if (!lit.chart || chart.size.x * chart.size.y > lit.chart->size.x * lit.chart->size.y) lit.chart = &chart;
    }
    lit.samples = sample_chart(scene, *lit.chart);
    const LampTree tree(lamps);
    lit.light = light_lamps(scene, *lit.chart, lit.samples, rays, tree, options, lit.statistics);
    return lit;
}

constexpr LampChartOptions kAll{LampSampling::adaptive, 0.0f};

TEST(LampsOnAChart, FollowInverseSquareAndCosine) {
    const Lamp lamp{"l", Lamp::Type::point, {1.3f, -2.1f, 5}, Rgb(1000.0f)};
    const Lit lit = light_ground(QuadScene().ground(20).scene(), {lamp}, kAll);
    EXPECT_EQ(lit.statistics.refined, 0u);  // nothing bends enough, nothing is in the way
    EXPECT_EQ(lit.statistics.pairs, lit.light.size());
    for (std::size_t i = 0; i < lit.light.size(); ++i) {
        const Vec3f d = lit.position(i) - lamp.position;
        const double expected = 1000.0 * 5.0 / std::pow(static_cast<double>(glm::dot(d, d)), 1.5);
        ASSERT_NEAR(lit.lux(i), expected, 1e-4 * expected);
    }
}

/// A hard cone paints a disc of radius h tan α. Within it each texel has its closed form; what its rim's texels have
/// adds up to the disc's area. 16 points place each texel's share to 1/16 at worst, about a hundredth of a texel on the
/// mean over the rim's 150 texels.
TEST(LampsOnAChart, SpotPaintsItsDisc) {
    const float height = 6.0f, angle = 0.7f;
    const Lamp lamp{"l", Lamp::Type::spot, {0.1f, 0.05f, height}, Rgb(500.0f), {0, 0, -1}, angle};
    const Lit lit = light_ground(QuadScene().ground(20).scene(), {lamp}, kAll);
    const double radius = static_cast<double>(height * std::tan(angle));
    double area = 0.0;
    std::size_t rim = 0;
    for (std::size_t i = 0; i < lit.light.size(); ++i) {
        const Vec3f d = lit.position(i) - lamp.position;
        const double off = static_cast<double>(glm::length(Vec2f(d)));
        const double full = 500.0 * static_cast<double>(height) / std::pow(static_cast<double>(glm::dot(d, d)), 1.5);
        if (off < radius - 0.25) {
            ASSERT_NEAR(lit.lux(i), full, 1e-4 * full);
        } else if (off > radius + 0.25) {
            ASSERT_EQ(lit.lux(i), 0.0);
        } else {
            ++rim;
        }
        area += lit.lux(i) / full * 0.25 * 0.25;
    }
    EXPECT_NEAR(area / (kPi * radius * radius), 1.0, 2e-3);
    EXPECT_GE(lit.statistics.refined, rim / 2);
    EXPECT_LT(lit.statistics.refined, lit.statistics.pairs / 2);
}

/// Beside a box: few texels get 16 rays, and those come out as if all did.
TEST(LampsOnAChart, EdgesAreAsIfAllWereSupersampled) {
    const Scene scene = QuadScene().ground(20).box({2, -1, 0}, {3, 1.3f, 3}).scene();
    const std::vector<Lamp> lamps{{"a", Lamp::Type::point, {0, 0.4f, 5}, Rgb(800.0f)},
                                  {"b", Lamp::Type::spot, {6, 6, 4}, Rgb(900.0f), {0, 0, -1}, 1.2f, 0.3f}};
    const Lit single = light_ground(scene, lamps, {LampSampling::single, 0.0f});
    const Lit adaptive = light_ground(scene, lamps, kAll);
    const Lit full = light_ground(scene, lamps, {LampSampling::full, 0.0f});
    const auto rmse = [&](const Lit& a) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.light.size(); ++i) sum += (a.lux(i) - full.lux(i)) * (a.lux(i) - full.lux(i));
        return std::sqrt(sum / static_cast<double>(a.light.size()));
    };
    EXPECT_GT(rmse(single), 0.1);
    EXPECT_LT(rmse(adaptive), 0.1 * rmse(single));
    EXPECT_LT(adaptive.statistics.rays, full.statistics.rays / 8);
    EXPECT_EQ(full.statistics.refined, full.statistics.pairs);
}

/// Ground that slopes by 0.4° counts as a plane, level here; its texels' subsamples still lie on the slope. In the
/// chart's plane those uphill would be up to 2.6 mm under it, and dark.
TEST(LampsOnAChart, SubsamplesLieOnTheSlope) {
    constexpr float kSlope = 0.007f;
    const Scene scene = QuadScene()
                            .quad({-8, -8, -8 * kSlope}, {8, -8, 8 * kSlope}, {8, 8, 8 * kSlope}, {-8, 8, -8 * kSlope},
                                  ObjectType::terrain)
                            .scene();
    const Lamp lamp{"l", Lamp::Type::point, {0.3f, -0.2f, 4}, Rgb(1000.0f)};
    const Lit single = light_ground(scene, {lamp}, {LampSampling::single, 0.0f}, 1.0f);
    const Lit full = light_ground(scene, {lamp}, {LampSampling::full, 0.0f}, 1.0f);
    ASSERT_EQ(single.chart->min_normal_cosine, 1.0f);
    ASSERT_EQ(single.chart->normal.z, 1.0f);
    // The mean of I h / d³ over a texel of 1 m is off its middle by ∇²E/24 m², which is most under the lamp:
    // 6/h² of E.
    constexpr double kBend = 6.0 / (4.0 * 4.0) / 24.0;
    for (std::size_t i = 0; i < full.light.size(); ++i)
        ASSERT_NEAR(full.lux(i), single.lux(i), 1.01 * kBend * single.lux(i));
}

/// The promise of the cutoff: no texel loses more.
TEST(LampsOnAChart, CutoffIsKept) {
    std::vector<Lamp> lamps;
    for (int i = 0; i < 400; ++i)
        lamps.push_back({"l",
                         Lamp::Type::point,
                         {-60.0f + 6.0f * static_cast<float>(i % 20), -60.0f + 6.0f * static_cast<float>(i / 20), 4},
                         Rgb(20.0f)});
    const Scene scene = QuadScene().ground(20).box({2, -1, 0}, {3, 1.3f, 3}).scene();
    const Lit all = light_ground(scene, lamps, kAll, 0.5f);
    const Lit cut = light_ground(scene, lamps, {LampSampling::adaptive, 0.5f}, 0.5f);
    EXPECT_LT(cut.statistics.rays, all.statistics.rays * 3 / 4);
    for (std::size_t i = 0; i < all.light.size(); ++i) {
        ASSERT_LE(cut.lux(i), all.lux(i) + 1e-3);
        ASSERT_GE(cut.lux(i), all.lux(i) - 0.5);
    }
}

TEST(LampsOnAChart, AreTheSameForAnyNumberOfThreads) {
    const Scene scene = QuadScene().ground(20).box({2, -1, 0}, {3, 1.3f, 3}).scene();
    std::vector<Lamp> lamps;
    for (int i = 0; i < 12; ++i)
        lamps.push_back({"l", Lamp::Type::point, {static_cast<float>(3 * i) - 18.0f, 2, 4}, Rgb(100.0f, 80.0f, 40.0f)});
    std::vector<std::vector<Rgb>> results;
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(light_ground(scene, lamps, {}).light);
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace skybake
