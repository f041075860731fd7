// Light that is known in closed form, through the bake and through free points.
#include <gtest/gtest.h>

#include <cmath>

#include "bake/bake_lightmaps.h"
#include "base/hash_rng.h"
#include "light/crowns.h"
#include "light/point_light.h"
#include "scenes.h"

namespace skybake {
namespace {

constexpr float kL = 1000.0f;  // cd m⁻²
const float kOpen = static_cast<float>(kPi) * kL;

Daylight uniform_sky() {
    return {"uniform", UniformSky{kL}, {{0, 0, 1}, Rgb(0), 0, 0.00465f, SunShape::none}};
}

/// Skylight at a point under a uniform sky of luminance kL.
float sky_at(const Scene& scene, const Vec3f& position, const Vec3f& normal, int samples) {
    const RayScene rays(scene);
    const std::vector<Daylight> instants{uniform_sky()};
    const DomeSampler sampler(instants);
    const std::vector<ReceiverPoint> points{{position, normal}};
    return luminance(light_points(points, sampler, 0, instants[0].sun, rays, {samples, 1})[0].sky);
}

/// The two numbers of samples that the issue states bounds for: 1024 (default, 1 %) and 4096 (0.3 %).
struct SamplesAndBound {
    int samples;
    float bound;
};
class Analytic : public testing::TestWithParam<SamplesAndBound> {};
INSTANTIATE_TEST_SUITE_P(DefaultAndFine, Analytic,
                         testing::Values(SamplesAndBound{1024, 0.01f}, SamplesAndBound{4096, 0.003f}));

TEST_P(Analytic, OpenGroundGetsPiL) {
    const Scene scene = QuadScene().ground(100).scene();
    EXPECT_NEAR(sky_at(scene, {3, 2, 0}, {0, 0, 1}, GetParam().samples), kOpen, GetParam().bound * kOpen);
}

TEST_P(Analytic, FreeWallGetsHalf) {
    const Scene scene = QuadScene().ground(100).box({-5, -5, 0}, {5, 5, 20}).scene();
    EXPECT_NEAR(sky_at(scene, {0, -5, 10}, {0, -1, 0}, GetParam().samples), 0.5f * kOpen,
                GetParam().bound * 0.5f * kOpen);
}

// Endless walls are a thousand metres long: what is seen past their ends is below 1e-4, and larger coordinates would
// lift the points by more than a millimetre or two (RayScene::surface_offset).

/// The foot of an endless wall hides a quarter sphere: half of the horizontal irradiance is left.
TEST_P(Analytic, FootOfALongWallGetsHalf) {
    const Scene scene = QuadScene().ground(1500).box({-1000, 0, 0}, {1000, 10, 2000}).scene();
    EXPECT_NEAR(sky_at(scene, {0, -0.05f, 0}, {0, 0, 1}, GetParam().samples), 0.5f * kOpen,
                GetParam().bound * 0.5f * kOpen);
}

/// The floor's centre in an endless canyon of height h and width w sees 1/√(1 + 4h²/w²) (Oke 1987; crossed strings).
TEST_P(Analytic, CanyonFloor) {
    for (const float h : {5.0f, 10.0f, 25.0f}) {
        const float w = 10.0f;
        const Scene scene = QuadScene()
                                .ground(1500)
                                .box({-1000, -25, 0}, {1000, -w / 2, h})
                                .box({-1000, w / 2, 0}, {1000, 25, h})
                                .scene();
        const float expected = kOpen / std::sqrt(1.0f + 4.0f * h * h / (w * w));
        // The error of N directions is one of the visible share: in the deep canyon, where a fifth is left, the bound
        // is taken of open ground.
        const float bound = GetParam().bound * (h > 2.0f * w ? kOpen : expected);
        EXPECT_NEAR(sky_at(scene, {0, 0, 0}, {0, 0, 1}, GetParam().samples), expected, bound) << "h/w " << h / w;
    }
}

/// No light gets into a closed shell of 90,000 triangles, half a kilometre off the origin. The scene is not built
/// robust (docs/decisions/0006): 6 of 8.2 million rays slip between two triangles. The bound is 16 of them, which a
/// number of mean 6 exceeds once in 5,000 times: other instruction sets may round another way.
TEST(Leaks, AClosedShellIsDark) {
    constexpr int kAround = 300, kUp = 150;
    const auto point = [](int i, int j) {
        const float azimuth = static_cast<float>(2.0 * kPi) * static_cast<float>(i % kAround) / kAround;
        const float height = static_cast<float>(kPi) * static_cast<float>(j) / kUp;
        const float bump = j == 0 || j == kUp ? 0.0f
                                              : uniform_float(3, static_cast<std::uint64_t>(i % kAround),
                                                              static_cast<std::uint64_t>(j), 0);
        return Vec3f(300, 400, 0) + (50.0f + bump) * Vec3f(std::sin(height) * std::cos(azimuth),
                                                           std::sin(height) * std::sin(azimuth), -std::cos(height));
    };
    QuadScene shell;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kUp; ++j) shell.quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
    }
    const RayScene rays(shell.scene());
    std::vector<ReceiverPoint> points;
    for (int k = 0; k < 2000; ++k) {
        const std::uint64_t key = static_cast<std::uint64_t>(k);
        const Vec3f off(uniform_float(4, key, 0, 0), uniform_float(4, key, 1, 0), uniform_float(4, key, 2, 0));
        points.push_back({Vec3f(300, 400, 0) + 50.0f * (off - 0.5f), {0, 0, 1}});
    }
    const std::vector<Daylight> instants{uniform_sky()};
    double open = 0.0;
    for (const PointLight& light : light_points(points, DomeSampler(instants), 0, instants[0].sun, rays, {4096, 1}))
        open += static_cast<double>(light.sky_view_factor);
    const double share = open / static_cast<double>(points.size());
    std::printf("share of 8 million rays that leak: %.2g\n", share);
    EXPECT_LT(share, 2e-6);
}

struct Baked {
    Scene scene;
    Atlas atlas;
    Lightmaps lightmaps;
    BakeReport report;
};

Baked bake(const Scene& scene, float texel_m, const Daylight& daylight, const BakeOptions& options) {
    Baked baked{scene, build_atlas(scene, {texel_m}), {}, {}};
    const RayScene rays(scene);
    SilentProgress silent;
    const std::vector<Daylight> instants{daylight};
    baked.lightmaps = bake_lightmaps(baked.scene, baked.atlas, rays, instants, options, silent, baked.report);
    return baked;
}

/// Light of the texel that holds `point`, on the chart whose plane holds it.
Rgb at(const Baked& baked, const Vec3f& point, const Vec3f& normal) {
    for (const Chart& chart : baked.atlas.charts) {
        if (glm::dot(chart.normal, normal) < 0.999f || std::abs(glm::dot(point - chart.origin, chart.normal)) > 0.01f)
            continue;
        const Vec2f t = texel_coordinate(chart, point);
        if (t.x < 0 || t.y < 0 || t.x >= static_cast<float>(chart.size.x) || t.y >= static_cast<float>(chart.size.y))
            continue;
        const LightmapPage& page = baked.lightmaps.pages[chart.page.index()];
        const std::size_t texel = static_cast<std::size_t>((chart.position.y + static_cast<int>(t.y)) * page.width +
                                                           chart.position.x + static_cast<int>(t.x));
        return total_irradiance(baked.lightmaps, 0, chart.page.index(), texel);
    }
    ADD_FAILURE() << "no chart at the point";
    return Rgb(0);
}

/// The same bounds through charts, tiles and all ways of sampling.
class AnalyticBake : public testing::TestWithParam<SamplesAndBound> {
  protected:
    static void expect(const Scene& scene, const std::vector<Vec3f>& points, const Vec3f& normal, float expected,
                       float texel_m = 0.5f) {
        for (std::size_t way = 0; way < kSkySamplingNames.size(); ++way) {
            const Baked baked =
                bake(scene, texel_m, uniform_sky(), {GetParam().samples, static_cast<SkySampling>(way)});
            float mean = 0.0f;
            for (const Vec3f& point : points)
                mean += luminance(at(baked, point, normal)) / static_cast<float>(points.size());
            std::printf("%d directions, %s: %+.3f %%\n", GetParam().samples, kSkySamplingNames[way].data(),
                        static_cast<double>(100.0f * (mean / expected - 1.0f)));
            EXPECT_NEAR(mean, expected, GetParam().bound * expected);
        }
    }
};
INSTANTIATE_TEST_SUITE_P(DefaultAndFine, AnalyticBake,
                         testing::Values(SamplesAndBound{1024, 0.01f}, SamplesAndBound{4096, 0.003f}));

TEST_P(AnalyticBake, OpenGroundGetsPiL) {
    expect(QuadScene().ground(20).scene(), {{3, 2, 0}}, {0, 0, 1}, kOpen);
}

TEST_P(AnalyticBake, FreeWallGetsHalf) {
    expect(QuadScene().ground(20).box({-5, -5, 0}, {5, 5, 20}).scene(), {{0, -5, 12}}, {0, -1, 0}, 0.5f * kOpen);
}

TEST_P(AnalyticBake, FootOfALongWallGetsHalf) {
    // The texel's centre lies 0.5 m before the wall; past the ends of 500 m it sees 6 · 10⁻⁴ of the sky.
    const float h = 30.0f, d = 0.5f;
    expect(QuadScene().ground(20).box({-250, 0, 0}, {250, 1, h}).scene(), {{0.2f, -0.2f, 0}}, {0, 0, 1},
           0.5f * kOpen * (1.0f + d / std::hypot(d, h)), 1.0f);
}

TEST_P(AnalyticBake, CanyonFloor) {
    const float w = 10.0f;
    for (const float h : {5.0f, 10.0f}) {
        const Scene scene =
            QuadScene().ground(20).box({-250, -15, 0}, {250, -w / 2, h}).box({-250, w / 2, 0}, {250, 15, h}).scene();
        // The two texels beside the centre line; their mean is the centre's to second order (0.25² × curvature: below
        // 0.1 %).
        expect(scene, {{0.2f, 0.2f, 0}, {0.2f, -0.2f, 0}}, {0, 0, 1}, kOpen / std::sqrt(1.0f + 4.0f * h * h / (w * w)));
    }
}

/// A slab of leaves of depth x leaves 2 E₃(x) of a uniform sky, E₃(x) = ∫₀¹ μ exp(−x/μ) dμ. Past its edges, 0.5° high,
/// there are 10⁻⁴ of the light.
TEST_P(AnalyticBake, UnderASlabOfLeaves) {
    constexpr double kDepth = 0.7;
    constexpr float kHalf = 60.0f, kThickness = 0.5f;
    Scene scene = QuadScene().ground(20).scene();
    add_plant(scene, box_triangles({-kHalf, -kHalf, 1}, {kHalf, kHalf, 1 + kThickness}), 0.2f);
    const double area = 4.0 * kHalf * kHalf, volume = area * kThickness,
                 surface = 2.0 * area + 8.0 * kHalf * kThickness;
    grow_crowns(scene, transmissivity_of(kDepth / kThickness, volume, surface));
    double e3 = 0.0;
    constexpr int kSteps = 10000;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        e3 += mu * std::exp(-kDepth / mu) / kSteps;
    }
    expect(scene, {{0.3f, 0.4f, 0}}, {0, 0, 1}, kOpen * static_cast<float>(2.0 * e3), 4.0f);
}

/// A crown's shadow is the same where it falls on one texel's point and on sixteen: the mean over the ground of what
/// the sun loses is the mean over the crown's disc.
TEST(BakeOfATree, ShadowHasTheCrownsLoss) {
    Scene scene = QuadScene().ground(20).scene();
    const double radius = 4.0;
    add_plant(scene, sphere_triangles({0, 0, 6}, static_cast<float>(radius)), 0.2f);
    grow_crowns(scene, kTransmissivityBare);
    Daylight sun = uniform_sky();
    sun.sky = NoSky{};
    sun.sun = {Vec3f(0, 0, 1), Rgb(1.0f), 1.0f, 0.00465f, SunShape::point};
    const Baked baked = bake(scene, 0.5f, sun, {64, SkySampling::full});
    double lost = 0.0;
    for (std::size_t p = 0; p < baked.lightmaps.pages.size(); ++p) {
        const LightmapPage& page = baked.lightmaps.pages[p];
        for (std::size_t i = 0; i < page.state.size(); ++i) {
            if (page.state[i] != TexelState::chart) continue;
            if (baked.atlas.charts[page.chart[i].index()].size.x < 60) continue;  // the crown
            lost += 0.25 * (1.0 - static_cast<double>(baked.lightmaps.instants[0].pages[p].sun_cosine[i]));
        }
    }
    // ∫ (1 − exp(−2 k √(R² − r²))) 2πr dr = πR² (1 − 2 (1 − (1 + x) exp(−x)) / x²), x = 2 k R.
    const double x = 2.0 * static_cast<double>(scene.crowns[0].extinction) * radius;
    const double truth = kPi * radius * radius * (1.0 - 2.0 * (1.0 - (1.0 + x) * std::exp(-x)) / (x * x));
    std::printf("lost %.3f m2, in closed form %.3f\n", lost, truth);
    EXPECT_NEAR(lost, truth, 0.005 * truth);  // the polyhedron's disc is 0.16 % short, its chords 0.2 %
}

/// A shadow's edge is antialiased by area: the shadow's texels add up to its area. Four rows of points a texel place a
/// straight edge to 1/8 texel, so 20 columns are right to 2.5 texels.
TEST(BakeOfABox, ShadowOfABoxHasItsArea) {
    const float height = 10.3f;
    const Scene scene = QuadScene().ground(40).box({-5, -5, 0}, {5, 5, height}).scene();
    Daylight sun = uniform_sky();
    sun.sky = NoSky{};
    sun.sun = {glm::normalize(Vec3f(0, -1, 1)), Rgb(1.0f), 1.0f, 0.00465f,
               SunShape::point};  // 45° high: the shadow is as long as the box is high
    const Baked baked = bake(scene, 0.5f, sun, {64, SkySampling::full});
    double shadow = 0.0;
    int buried = 0;
    for (std::size_t p = 0; p < baked.lightmaps.pages.size(); ++p) {
        const LightmapPage& page = baked.lightmaps.pages[p];
        for (std::size_t i = 0; i < page.state.size(); ++i) {
            if (page.state[i] == TexelState::gutter || page.state[i] == TexelState::empty) continue;
            if (baked.atlas.charts[page.chart[i].index()].size.x < 100) continue;  // the box
            buried += page.state[i] == TexelState::buried;
            if (page.state[i] == TexelState::chart)
                shadow +=
                    1.0 - static_cast<double>(baked.lightmaps.instants[0].pages[p].sun_cosine[i]) / std::sqrt(0.5);
        }
    }
    EXPECT_EQ(buried, 20 * 20 - 14 * 14);  // the ground under the box, as far in as three texels
    EXPECT_NEAR(shadow, 14 * 14 + 20 * (static_cast<double>(height) / 0.5), 2.5);
}

/// No light leaks under the box, and no dark rim beside it: along its north wall's foot, lookups between texels stay
/// lit by the sky.
TEST(BakeOfABox, GroundBesideAWallHasNoDarkRim) {
    const Scene scene =
        QuadScene().ground(40).box({-5.2f, -5.2f, 0}, {5.2f, 5.2f, 10}).scene();  // the wall cuts through texels
    const Baked baked = bake(scene, 0.5f, uniform_sky(), {512, SkySampling::full});
    for (float x = -4.0f; x < 4.0f; x += 0.5f) {
        for (const float y :
             {5.3f, 5.0f, 4.6f}) {  // outside, cut by the wall, wholly inside but within a bilinear lookup's reach
            EXPECT_GT(luminance(at(baked, {x, y, 0}, {0, 0, 1})), 0.3f * kOpen) << x << ' ' << y;
        }
    }
}

}  // namespace
}  // namespace skybake
