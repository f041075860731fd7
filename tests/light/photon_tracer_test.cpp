// Photons against reflected light that is known in closed form, and where their energy goes.
#include "light/photon_tracer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "base/hash_rng.h"
#include "light/photon_gather.h"
#include "vessels.h"

namespace skybake {
namespace {

struct Gathered {
    double mean = 0.0;
    double error = 0.0;  // standard error of the mean, from the points' scatter
};

Gathered gather(const Scene& scene, const LightSources& sources, const PhotonOptions& options,
                const std::vector<ReceiverPoint>& points) {
    const RayScene rays(scene);
    SilentProgress silent;
    PhotonRun run = trace_photons(sources, scene, rays, options, silent);
    const PhotonLedger& l = run.ledger;
    EXPECT_NEAR((l.absorbed + l.escaped + l.at_limit) / l.emitted, 1.0, 1e-9);
    const PhotonMap map(std::move(run.photons));
    const PhotonGatherer gatherer(map, rays, surface_area(scene), {60, PhotonArea::octagon, 8});
    std::uint64_t traced = 0;
    double sum = 0.0, square = 0.0;
    for (const IndirectLight& light : gather_indirect(points, gatherer, traced)) {
        const double e = static_cast<double>(luminance(light.irradiance));
        sum += e;
        square += e * e;
    }
    const double n = static_cast<double>(points.size()), mean = sum / n;
    return {mean, std::sqrt((square / n - mean * mean) / n)};
}

void expect_within(const Gathered& light, double truth, double relative) {
    std::printf("%.3f lx ± %.3f, in closed form %.3f: %+.2f %%\n", light.mean, light.error, truth,
                100.0 * (light.mean / truth - 1.0));
    EXPECT_NEAR(light.mean, truth, 4.0 * light.error + relative * truth);
    EXPECT_LT(light.error, 0.02 * truth);
}

std::vector<ReceiverPoint> inner_points(const Scene& scene, std::size_t count) {
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const auto [position, normal] =
            inner_point(scene, (2 * i + 1) * scene.triangles.size() / (2 * count), {0, 0, 5});
        points.push_back({position, normal});
    }
    return points;
}

TEST(PhotonFurnace, ClosedSphereWithALamp) {
    const Scene scene = sphere_inside(5.0f, 0.7f);
    const LightSources sources{night(), {point_lamp({1.0f, -0.5f, 6.0f}, 100.0f)}};
    expect_within(gather(scene, sources, {500'000, 100, 1}, inner_points(scene, 500)),
                  0.7 / 0.3 * 4.0 * kPi * 100.0 / area_of(scene), 0.005);
}

TEST(PhotonFurnace, CountsBounces) {
    const Scene scene = sphere_inside(5.0f, 0.7f);
    const LightSources sources{night(), {point_lamp({0, 0, 5}, 100.0f)}};
    for (const int bounces : {1, 3}) {
        expect_within(gather(scene, sources, {500'000, bounces, 2}, inner_points(scene, 500)),
                      0.7 * (1.0 - std::pow(0.7, bounces)) / 0.3 * 4.0 * kPi * 100.0 / area_of(scene), 0.005);
    }
}

TEST(PhotonBowl, UnderAUniformSky) {
    const Scene scene = sphere_inside(5.0f, 0.6f, static_cast<float>(kPi / 2.0));
    const double direct = kPi * 1000.0 / 2.0;
    expect_within(gather(scene, {uniform_sky(1000.0f), {}}, {1'000'000, 50, 3}, inner_points(scene, 500)),
                  direct / (1.0 - 0.3) - direct, 0.005);
}

/// What the sun and the sky send into an open city is known: the sun's beam on the box that holds it, and of a photon
/// that meets an open floor a share ρ escapes.
TEST(Ledger, OfAnOpenFloor) {
    Scene scene = QuadScene().ground(10).scene();
    scene.materials[0].albedo = Rgb(0.25f, 0.5f, 0.75f);
    const RayScene rays(scene);
    SilentProgress silent;
    const Vec3f to_sun = glm::normalize(Vec3f(0.3f, 0.2f, 0.8f));
    const PhotonLedger sun =
        trace_photons({sun_only(to_sun, 1000.0f), {}}, scene, rays, {100'000, 8, 4}, silent).ledger;
    const double rho = static_cast<double>(luminance(scene.materials[0].albedo));
    EXPECT_NEAR(sun.absorbed, 400.0 * 1000.0 * static_cast<double>(to_sun.z) * (1.0 - rho),
                4.0 * sun.emitted * 0.5 / std::sqrt(1e5));
    const PhotonLedger sky = trace_photons({uniform_sky(100.0f), {}}, scene, rays, {100'000, 8, 4}, silent).ledger;
    EXPECT_NEAR(sky.absorbed, 400.0 * kPi * 100.0 * (1.0 - rho), 4.0 * sky.emitted * 0.5 / std::sqrt(1e5));
    EXPECT_NEAR((sky.absorbed + sky.escaped + sky.at_limit) / sky.emitted, 1.0, 1e-9);
}

/// Nothing is stored at the first hit: an open convex floor has no reflected light.
TEST(Photons, CountFromTheSecondHit) {
    const Scene scene = QuadScene().ground(10).scene();
    const RayScene rays(scene);
    SilentProgress silent;
    EXPECT_TRUE(trace_photons({uniform_sky(100.0f), {}}, scene, rays, {20'000, 8, 4}, silent).photons.empty());
}

TEST(Photons, AreTheSameForAnyNumberOfThreads) {
    const Scene scene = QuadScene().ground(20).box({-2, -2, 0}, {2, 2, 6}).box({5, -4, 0}, {9, 3, 8}).scene();
    const RayScene rays(scene);
    LightSources sources{uniform_sky(1000.0f), {point_lamp({3.5f, 0, 2}, 5000.0f)}};
    sources.daylight.sun = sun_only({0.3f, 0.5f, 0.4f}, 50000.0f).sun;
    SilentProgress silent;
    const auto map = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return PhotonMap(trace_photons(sources, scene, rays, {200'000, 8, 5}, silent).photons);
    };
    const PhotonMap one = map(1), two = map(2), seven = map(7);
    ASSERT_EQ(one.photons().size(), seven.photons().size());
    ASSERT_GT(one.photons().size(), 5'000u);
    EXPECT_EQ(std::memcmp(one.photons().data(), two.photons().data(), one.photons().size_bytes()), 0);
    EXPECT_EQ(std::memcmp(one.photons().data(), seven.photons().data(), one.photons().size_bytes()), 0);
}

/// Photons and paths are two estimates of one light: between houses, in sun and sky, the means over the ground agree.
TEST(Photons, AgreeWithThePaths) {
    const Scene scene = QuadScene().ground(30).box({-8, -9, 0}, {-3, 9, 9}).box({3, -9, 0}, {8, 9, 7}).scene();
    LightSources sources{uniform_sky(3000.0f), {}};
    sources.daylight.sun = sun_only({-0.5f, 0.1f, 0.6f}, 60000.0f).sun;
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 400; ++i) {
        RandomSequence random(3, static_cast<std::uint64_t>(i), 0);
        const float x = random.next(), y = random.next();
        points.push_back({{5.0f * x - 2.5f, 12.0f * y - 6.0f, 0}, {0, 0, 1}});
    }
    const RayScene rays(scene);
    SilentProgress silent;
    double truth = 0.0, error2 = 0.0;
    for (const IndirectLight& light : PathReference(sources, scene, rays, {1024, 8, 1}).light(points, silent)) {
        truth += static_cast<double>(luminance(light.irradiance)) / 400.0;
        error2 += std::pow(static_cast<double>(light.standard_error_lx) / 400.0, 2.0);
    }
    Gathered light = gather(scene, sources, {1'000'000, 8, 6}, points);
    light.error = std::hypot(light.error, std::sqrt(error2));
    expect_within(light, truth, 0.005);
}

}  // namespace
}  // namespace skybake
