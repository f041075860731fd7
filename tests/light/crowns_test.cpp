// Light through trees against closed forms: Beer and Lambert's law, the exponential integral of a slab under a uniform
// sky, and a lamp within a body of white leaves in a vessel, which loses nothing.
#include "crowns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/flight.h"
#include "light/path_reference.h"
#include "light/photon_gather.h"
#include "light/photon_tracer.h"
#include "light/point_light.h"
#include "vessels.h"

namespace skybake {
namespace {

// A slab 2 m thick over a kilometre of ground, its optical depth 0.8 when looked through upright. Seen from its middle
// the edges lie below 1° of elevation.
constexpr double kDepth = 0.8;
constexpr float kThickness = 2.0f;

Scene ground_under_a_slab() {
    Scene scene = QuadScene().ground(500).scene();
    const double side = 1000.0, volume = side * side * kThickness,
                 surface = 2.0 * side * side + 4.0 * side * kThickness;
    add_plant(scene, box_triangles({-500, -500, 3}, {500, 500, 3 + kThickness}), 0.2f);
    grow_crowns(scene, transmissivity_of(kDepth / kThickness, volume, surface));
    return scene;
}

PointLight under(const Scene& scene, const Daylight& daylight, const Vec3f& position, int samples) {
    const RayScene rays(scene);
    const std::vector<Daylight> instants{daylight};
    const DomeSampler sampler(instants);
    return light_points(std::vector<ReceiverPoint>{{position, {0, 0, 1}}}, sampler, 0, daylight.sun, rays,
                        {samples, 1})[0];
}

TEST(Crowns, SunThroughASlabByItsElevation) {
    const Scene scene = ground_under_a_slab();
    for (const double elevation : {90.0, 60.0, 30.0, 10.0}) {
        const double e = elevation * kPi / 180.0;
        const Vec3f direction(0, static_cast<float>(std::cos(e)), static_cast<float>(std::sin(e)));
        const double truth = std::exp(-kDepth / std::sin(e));
        EXPECT_NEAR(static_cast<double>(under(scene, sun_only(direction, 1e5f), {0.3f, 0.7f, 0}, 16).sun_visible),
                    truth, 1e-4 * truth)
            << elevation;
    }
}

TEST(Crowns, HalfASlabAboveAPointWithin) {
    const Scene scene = ground_under_a_slab();
    const RayScene rays(scene);
    EXPECT_NEAR(rays.visibility({0, 0, 4}, {0, 0, 1}), std::exp(-0.5 * kDepth), 1e-4);
    EXPECT_NEAR(rays.visibility({0, 0, 1}, {0, 0, 1}, 3.0f), std::exp(-0.5 * kDepth), 1e-4);  // ends within
    EXPECT_EQ(rays.visibility({0, 0, 1}, {0, 0, 1}, 1.5f), 1.0f);                             // ends before it
    EXPECT_EQ(rays.visibility({0, 0, 5.5f}, {0, 0, 1}), 1.0f);                                // starts behind it
}

/// E₃(x) = ∫₀¹ μ exp(−x/μ) dμ: a uniform sky through a slab leaves 2 E₃ of it.
double exponential_integral_3(double x) {
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        sum += mu * std::exp(-x / mu) / kSteps;
    }
    return sum;
}

TEST(Crowns, UniformSkyThroughASlab) {
    const PointLight light = under(ground_under_a_slab(), uniform_sky(1000.0f), {0.3f, 0.7f, 0}, 4096);
    const double truth = 2.0 * exponential_integral_3(kDepth);
    EXPECT_NEAR(static_cast<double>(light.sky_view_factor), truth, 0.003 * truth);
    EXPECT_NEAR(static_cast<double>(luminance(light.sky)), kPi * 1000.0 * truth, 0.003 * kPi * 1000.0 * truth);
}

/// In a vessel of radius 5 a lamp in the hollow of a ball of white leaves, of radii 1.5 and 3: nothing is lost but at
/// the walls, so that they get Φ / (A (1 − ρ)) in all, of which the lamp alone gives Φ/A exp(−1.5 k). (Leaves up to the
/// lamp itself would be lit without bound.)
struct LampInLeaves {
    Scene scene = sphere_inside(5.0f, 0.5f);
    LightSources sources{night(), {point_lamp({0, 0, 5}, 100.0f)}};
    double extinction = 0.6;
    double reflected = 0.0;  // lx

    LampInLeaves() {
        const double inner = 1.5, outer = 3.0;
        const double area = area_of(scene);
        std::vector<std::array<Vec3f, 3>> leaves = sphere_triangles({0, 0, 5}, static_cast<float>(outer));
        for (const auto& [a, b, c] : sphere_triangles({0, 0, 5}, static_cast<float>(inner)))
            leaves.push_back({a, c, b});
        add_plant(scene, leaves, 1.0f);
        grow_crowns(scene,
                    transmissivity_of(extinction, 4.0 / 3.0 * kPi * (outer * outer * outer - inner * inner * inner),
                                      4.0 * kPi * (outer * outer + inner * inner)));
        const double flux = 4.0 * kPi * 100.0;
        reflected = flux / area * (1.0 / (1.0 - 0.5) - std::exp(-extinction * (outer - inner)));
    }
};

// The leaves' body is a polyhedron: its chords are 0.2 % short of the sphere's.
constexpr double kPolyhedron = 0.005;

TEST(Crowns, PathsLoseNothingInWhiteLeaves) {
    const LampInLeaves vessel;
    const RayScene rays(vessel.scene);
    SilentProgress silent;
    const auto [position, normal] = inner_point(vessel.scene, 5000, {0, 0, 5});
    const IndirectLight light = PathReference(vessel.sources, vessel.scene, rays, {200000, 200, 1})
                                    .light(std::vector{ReceiverPoint{position, normal}}, silent)[0];
    const double value = static_cast<double>(luminance(light.irradiance));
    const double error = static_cast<double>(light.standard_error_lx);
    std::printf("%.4f lx, standard error %.4f, in closed form %.4f\n", value, error, vessel.reflected);
    EXPECT_NEAR(value, vessel.reflected, 4.0 * error + kPolyhedron * vessel.reflected);
    EXPECT_LT(error, 0.01 * vessel.reflected);
}

TEST(Crowns, PhotonsLoseNothingInWhiteLeaves) {
    const LampInLeaves vessel;
    const RayScene rays(vessel.scene);
    SilentProgress silent;
    PhotonRun run = trace_photons(vessel.sources, vessel.scene, rays, {500'000, 200, 1}, silent);
    const PhotonLedger& l = run.ledger;
    EXPECT_NEAR((l.absorbed + l.escaped + l.at_limit) / l.emitted, 1.0, 1e-9);
    EXPECT_LT(l.escaped / l.emitted, 1e-5);
    const PhotonMap map(std::move(run.photons));
    const PhotonGatherer gatherer(map, rays, surface_area(vessel.scene), {100, PhotonArea::octagon, 8});
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < 300; ++i) {
        const auto [position, normal] = inner_point(vessel.scene, (2 * i + 1) * 16384 / 600, {0, 0, 5});
        points.push_back({position, normal});
    }
    std::uint64_t traced = 0;
    double sum = 0.0, square = 0.0;
    for (const IndirectLight& light : gather_indirect(points, gatherer, traced)) {
        const double e = static_cast<double>(luminance(light.irradiance));
        sum += e;
        square += e * e;
    }
    const double n = static_cast<double>(points.size()), mean = sum / n,
                 error = std::sqrt((square / n - mean * mean) / n);
    std::printf("%.4f lx ± %.4f, in closed form %.4f\n", mean, error, vessel.reflected);
    EXPECT_NEAR(mean, vessel.reflected, 4.0 * error + kPolyhedron * vessel.reflected);
}

/// A crown's own outside gets light as a surface does: photons and paths agree on it.
TEST(Crowns, PhotonsAndPathsAgreeOnACrown) {
    Scene scene = QuadScene().ground(30).box({-8, 6, 0}, {8, 12, 10}).scene();
    add_plant(scene, sphere_triangles({0, 0, 4}, 2.5f), 0.15f);
    grow_crowns(scene, kTransmissivityInLeaf);
    const LightSources sources{sun_only({0.2f, -0.6f, 0.7f}, 1e5f), {}};
    const RayScene rays(scene);
    SilentProgress silent;
    PhotonRun run = trace_photons(sources, scene, rays, {4'000'000, 8, 1}, silent);
    const PhotonMap map(std::move(run.photons));
    const PhotonGatherer gatherer(map, rays, surface_area(scene), {200, PhotonArea::octagon, 4});
    std::vector<ReceiverPoint> points;
    const Crown& crown = scene.crowns.front();
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto& t = scene.triangles[crown.first_triangle + (i * crown.triangle_count + 32) / 64];
        points.push_back({(t[0] + t[1] + t[2]) / 3.0f, glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]))});
    }
    const std::vector<IndirectLight> paths = PathReference(sources, scene, rays, {4096, 8, 1}).light(points, silent);
    std::uint64_t traced = 0;
    const std::vector<IndirectLight> photons = gather_indirect(points, gatherer, traced);
    double by_paths = 0.0, by_photons = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        by_paths += static_cast<double>(luminance(paths[i].irradiance));
        by_photons += static_cast<double>(luminance(photons[i].irradiance));
        variance += static_cast<double>(paths[i].standard_error_lx * paths[i].standard_error_lx);
    }
    const double error = std::sqrt(variance);
    std::printf("crown: photons %.1f lx, paths %.1f ± %.1f lx\n", by_photons / 64, by_paths / 64, error / 64);
    // The facets are a quarter metre wide and hold 50 photons: measured are −3.3 % with the 30 nearest, −1.6 % with 60,
    // +3.7 % with 200.
    EXPECT_NEAR(by_photons, by_paths, 4.0 * error + 0.05 * by_paths);
}

TEST(Crowns, DeepLeavesReflectAsTheirSurface) {
    // The two streams of a half space of leaves of albedo w: (1 − √(1 − w)) / (1 + √(1 − w)).
    for (const float surface : {0.05f, 0.2f, 0.6f}) {
        const float gamma = std::sqrt(1.0f - leaf_albedo(Rgb(surface)).x);
        EXPECT_NEAR((1.0f - gamma) / (1.0f + gamma), surface, 1e-5f);
    }
}

TEST(FindCrowns, TellsBodiesFromBoardsAndLawns) {
    Scene scene = QuadScene().ground(30).scene();
    add_plant(scene, sphere_triangles({0, 0, 5}, 2.0f), 0.2f);
    add_plant(scene, quad_triangles({4, 0, 0}, {6, 0, 0}, {6, 0, 5}, {4, 0, 5}), 0.2f);
    add_plant(scene, quad_triangles({-9, 0, 0.1f}, {-6, 0, 0.1f}, {-6, 5, 0.1f}, {-9, 5, 0.1f}), 0.2f,
              ObjectType::plant_cover);
    add_plant(scene, box_triangles({-9, -9, 0}, {-6, -6, 3}), 0.2f, ObjectType::plant_cover);
    const FindingLog findings = grow_crowns(scene, 0.05f);
    ASSERT_EQ(scene.crowns.size(), 3u);
    EXPECT_NEAR(scene.crowns[0].extinction, -std::log(0.05f) / (4.0f * 2.0f / 3.0f), 0.01f);
    EXPECT_EQ(scene.crowns[0].depth_per_crossing, 0.0f);
    EXPECT_EQ(scene.crowns[1].extinction, 0.0f);
    EXPECT_NEAR(scene.crowns[1].depth_per_crossing, -0.5f * std::log(0.05f), 1e-5f);
    EXPECT_NEAR(scene.crowns[2].extinction, -std::log(0.05f) / 2.0f, 1e-5f);  // a cube's mean chord: 2/3 of its side
    EXPECT_EQ(findings.count("SB218"), 1u);
    const RayScene rays(scene);
    EXPECT_NEAR(rays.visibility({5, -2, 2}, {0, 1, 0}), std::sqrt(0.05f), 1e-5f);
    EXPECT_EQ(rays.visibility({-7, 2, -1}, {0, 0, 1}), 0.0f);  // under the ground and the lawn
}

/// A crown lost at an edge between triangles must not take the light from what lies behind.
TEST(Crowns, NoRayThroughEdgesIsOffByMoreThanTheCrown) {
    Scene scene = QuadScene().ground(30).scene();
    add_plant(scene, sphere_triangles({0, 0, 400}, 2.0f), 0.2f);
    grow_crowns(scene, 0.03f);
    const RayScene rays(scene);
    const double k = static_cast<double>(scene.crowns[0].extinction);
    // Straight through the polyhedron's vertices and edges.
    for (int i = 0; i < 64; ++i) {
        const float a = static_cast<float>(2.0 * kPi) * static_cast<float>(i) / 64;
        for (const float r : {0.0f, 0.195f, 0.5f, 1.0f}) {
            const Vec3f origin(r * std::cos(a), r * std::sin(a), 1.0f);
            const double truth = std::exp(-k * 2.0 * std::sqrt(4.0 - static_cast<double>(r * r)));
            EXPECT_NEAR(rays.visibility(origin, {0, 0, 1}), truth, 0.1 * truth);
        }
    }
}

}  // namespace
}  // namespace skybake
