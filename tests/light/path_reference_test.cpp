// The reference estimator against reflected light that is known in closed form. Bounds are standard errors of the very
// run: four for each case, and what the polyhedron differs from the sphere.
#include "light/path_reference.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "base/hash_rng.h"
#include "light/polygon_irradiance.h"
#include "vessels.h"

namespace skybake {
namespace {

IndirectLight at(const Scene& scene, const LightSources& sources, const ReceiverPoint& point,
                 const PathOptions& options) {
    const RayScene rays(scene);
    SilentProgress silent;
    return PathReference(sources, scene, rays, options).light(std::vector{point}, silent)[0];
}

void expect_within(const IndirectLight& light, double truth, double relative) {
    const double value = static_cast<double>(luminance(light.irradiance));
    const double error = static_cast<double>(light.standard_error_lx);
    std::printf("%.3f lx, standard error %.3f, in closed form %.3f: %+.2f %%, %+.1f standard errors\n", value, error,
                truth, 100.0 * (value / truth - 1.0), (value - truth) / error);
    EXPECT_NEAR(value, truth, 4.0 * error + relative * truth);
    EXPECT_LT(error, 0.02 * truth);
}

/// In a sphere, every point sees every other one alike: a lamp of flux Φ anywhere inside gives, after reflection, E =
/// ρ/(1 − ρ) Φ/A everywhere: the furnace, since the walls' radiosity is the geometric series of ρ.
TEST(Furnace, ClosedSphereWithALamp) {
    for (const float albedo : {0.3f, 0.8f}) {
        const Scene scene = sphere_inside(5.0f, albedo);
        const LightSources sources{night(), {point_lamp({1.0f, -0.5f, 6.0f}, 100.0f)}};
        const double rho = static_cast<double>(albedo);
        const double flux = 4.0 * kPi * 100.0;
        const auto [position, normal] = inner_point(scene, 5000, {0, 0, 5});
        expect_within(at(scene, sources, {position, normal}, {50000, 200, 1}),
                      rho / (1.0 - rho) * flux / area_of(scene), 0.003);
    }
}

/// The same up to k reflections: ρ (1 − ρᵏ)/(1 − ρ) Φ/A.
TEST(Furnace, CountsBounces) {
    const Scene scene = sphere_inside(5.0f, 0.8f);
    const LightSources sources{night(), {point_lamp({0, 0, 5}, 100.0f)}};
    const auto [position, normal] = inner_point(scene, 3000, {0, 0, 5});
    for (const int bounces : {1, 2, 4}) {
        const double truth = 0.8 * (1.0 - std::pow(0.8, bounces)) / 0.2 * 4.0 * kPi * 100.0 / area_of(scene);
        expect_within(at(scene, sources, {position, normal}, {50000, bounces, 2}), truth, 0.003);
    }
}

/// A hemispherical bowl under a uniform sky: each point sees the sky by a half and the bowl by a half, so
/// E = (πL/2)/(1 − ρ/2), of which πL/2 is direct.
TEST(Bowl, UnderAUniformSky) {
    const Scene scene = sphere_inside(5.0f, 0.6f, static_cast<float>(kPi / 2.0));
    const LightSources sources{uniform_sky(1000.0f), {}};
    const double direct = kPi * 1000.0 / 2.0;
    for (const std::size_t triangle : {40u, 2000u, 4000u}) {
        const auto [position, normal] = inner_point(scene, triangle, {0, 0, 5});
        expect_within(at(scene, sources, {position, normal}, {200000, 100, 3}), direct / (1.0 - 0.3) - direct, 0.003);
    }
}

/// A wall before a sunlit floor gets, by one reflection, what Lambert's formula gives for a floor of luminance ρE/π.
TEST(SunlitFloor, LightsTheWall) {
    Scene scene = QuadScene()
                      .quad({-10, -20, 0}, {10, -20, 0}, {10, 0, 0}, {-10, 0, 0})
                      .quad({-10, 0, 0}, {10, 0, 0}, {10, 0, 10}, {-10, 0, 10})
                      .scene();
    scene.materials[0].albedo = Rgb(0.5f);
    const Vec3f to_sun = glm::normalize(Vec3f(0.2f, -0.6f, 0.7f));
    const LightSources sources{sun_only(to_sun, 80000.0f), {}};
    const double radiosity = 0.5 * 80000.0 * static_cast<double>(to_sun.z);
    for (const double height : {0.5, 2.0, 8.0}) {
        const double truth = polygon_irradiance({{-10, -20, 0}, {10, -20, 0}, {10, 0, 0}, {-10, 0, 0}}, {1, 0, height},
                                                {0, -1, 0}, radiosity / kPi);
        expect_within(at(scene, sources, {Vec3f(Vec3d(1, 0, height)), {0, -1, 0}}, {200000, 1, 4}), truth, 0.0);
    }
}

/// The sky as a light of its own density and as the end of a cosine's ray must agree whatever the sky's shape: the
/// reflection of a bright patch of sky by an open floor into a downward look has the closed form E = ρ E_floor.
TEST(SkyOnAFloor, SeenFromAbove) {
    Scene scene = QuadScene().ground(2000).scene();
    scene.materials[0].albedo = Rgb(0.4f);
    const PreethamSky sky = preetham_sky(3.0, glm::normalize(Vec3d(0.5, 0.3, 0.4)));
    Daylight day = night();
    day.sky = sky;
    const LightSources sources{day, {}};
    const double floor = static_cast<double>(luminance(horizontal_diffuse(day.sky).illuminance));
    expect_within(at(scene, sources, {{0, 0, 1.0f}, {0, 0, -1}}, {20000, 1, 5}), 0.4 * floor, 0.001);
}

/// Runs of other seeds scatter as their standard errors say: the mean of their squared deviations in units of the
/// error is 1, within four standard errors of a chi² of 200 degrees of freedom.
TEST(StandardError, IsHonest) {
    Scene scene = QuadScene().ground(20).box({-2, -2, 0}, {2, 2, 6}).box({4, -5, 0}, {6, 5, 9}).scene();
    const RayScene rays(scene);
    const LightSources sources{sun_only({-0.5f, 0.1f, 0.6f}, 80000.0f), {}};
    std::vector<ReceiverPoint> points{{{3, 0, 0}, {0, 0, 1}}};
    SilentProgress silent;
    constexpr int kRuns = 200;
    std::vector<IndirectLight> runs;
    double mean = 0.0;
    for (int seed = 0; seed < kRuns; ++seed) {
        runs.push_back(
            PathReference(sources, scene, rays, {512, 6, static_cast<std::uint64_t>(seed)}).light(points, silent)[0]);
        mean += static_cast<double>(luminance(runs.back().irradiance)) / kRuns;
    }
    double chi2 = 0.0;
    for (const IndirectLight& run : runs)
        chi2 += std::pow(
            (static_cast<double>(luminance(run.irradiance)) - mean) / static_cast<double>(run.standard_error_lx), 2.0);
    EXPECT_NEAR(chi2 / (kRuns - 1), 1.0, 4.0 * std::sqrt(2.0 / kRuns));
}

TEST(Reference, IsTheSameForAnyNumberOfThreadsAndAnyCompany) {
    Scene scene = QuadScene().ground(20).box({-2, -2, 0}, {2, 2, 6}).scene();
    const RayScene rays(scene);
    const LightSources sources{uniform_sky(1000.0f), {point_lamp({5, 5, 3}, 500.0f)}};
    SilentProgress silent;
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 20; ++i) points.push_back({{3.0f + static_cast<float>(i), 0, 0}, {0, 0, 1}});
    const auto trace = [&](std::span<const ReceiverPoint> some, std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return PathReference(sources, scene, rays, {700, 5, 9}).light(some, silent);
    };
    const auto one = trace(points, 1), seven = trace(points, 7), alone = trace(std::span(points).subspan(7, 1), 2);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(one[i].irradiance, seven[i].irradiance);
        EXPECT_EQ(one[i].standard_error_lx, seven[i].standard_error_lx);
    }
    EXPECT_EQ(one[7].irradiance, alone[0].irradiance);
}

}  // namespace
}  // namespace skybake
