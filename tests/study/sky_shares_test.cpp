// Sky view factors, vertical sky components and the light of a year against closed forms and direct sums.
#include "study/sky_shares.h"

#include <gtest/gtest.h>

#include "study/light_incidence.h"
#include "study/study_scenes.h"
#include "study/year_light.h"

namespace skybake {
namespace {

struct Vessel {
    explicit Vessel(QuadScene quads) : scene(quads.scene()), rays(scene) {}
    Scene scene;
    RayScene rays;
    SilentProgress silent;
    SkyShares shares(const Sample& sample, int directions = 4096) {
        return sky_shares({&sample, 1}, scene.origin, rays, directions, nullptr, silent);
    }
};

/// Two walls 2 km long at ±5 m, `h` high, about the origin.
QuadScene canyon(float h) {
    return QuadScene().ground(2000).box({-1000, 5, 0}, {1000, 15, h}).box({-1000, -15, 0}, {1000, -5, h});
}

/// A wall's point faces −y; an endless wall before it reaches `angle_deg` above its horizon.
QuadScene obstruction(double angle_deg) {
    const float top = static_cast<float>(100.0 * std::tan(radians_from_degrees(angle_deg)));
    return QuadScene().quad({-60000, -100, -10}, {60000, -100, -10}, {60000, -100, top}, {-60000, -100, top});
}

/// E_v/E_h of the Moon-Spencer sky above an endless obstruction of angle a. With p the angle about the wall's axis and
/// β that from the plane across it, sin θ = cos β sin p, the cosine is cos β cos p and dω = cos β dβ dp, so that E_v =
/// L_z/3 ∫ (π/2 cos p + 8/3 sin p cos p) dp from a to π/2; E_h = 7π/9 L_z.
double vsc_above(double angle_deg) {
    const double s = std::sin(radians_from_degrees(angle_deg));
    return 100.0 * (kPi / 2.0 * (1.0 - s) + 4.0 / 3.0 * (1.0 - s * s)) / 3.0 / (7.0 * kPi / 9.0);
}

/// The published values and the closed form agree; the study agrees with both.
TEST(SkyShares, VerticalSkyComponentBehindEndlessObstructions) {
    struct Row {
        double angle_deg, published;
    };
    for (const Row& row : {Row{0.0, 39.62}, Row{25.0, 27.3}, Row{30.0, 24.4}, Row{45.0, 15.4}}) {
        EXPECT_NEAR(vsc_above(row.angle_deg), row.published, 0.051);
        Vessel vessel(row.angle_deg > 0.0 ? obstruction(row.angle_deg) : QuadScene().ground(1, -1000));
        const SkyShares shares = vessel.shares(sample_at({0, 0, 0}, {0, -1, 0}));
        for (const int n : {512, 1024, 2048}) {
            const SkyShares fewer = vessel.shares(sample_at({0, 0, 0}, {0, -1, 0}), n);
            std::printf("%d directions: %.3f; ", n, static_cast<double>(fewer.sky_component_pct[0]));
        }
        std::printf("VSC above %.0f deg: %.3f %%, closed form %.3f %%\n", row.angle_deg,
                    static_cast<double>(shares.sky_component_pct[0]), vsc_above(row.angle_deg));
        EXPECT_NEAR(shares.sky_component_pct[0], vsc_above(row.angle_deg), 0.1);
    }
}

TEST(SkyShares, CanyonFloor) {
    for (const float h : {5.0f, 10.0f}) {
        Vessel vessel(canyon(h));
        const SkyShares shares = vessel.shares(sample_at({0, 0, 0}, {0, 0, 1}));
        const double truth = 1.0 / std::sqrt(1.0 + 4.0 * static_cast<double>(h * h) / 100.0);
        for (const int n : {512, 1024, 2048}) {
            const SkyShares fewer = vessel.shares(sample_at({0, 0, 0}, {0, 0, 1}), n);
            std::printf("%d directions: %.4f; ", n, static_cast<double>(fewer.sky_view_factor[0]));
        }
        std::printf("canyon %.0f m: %.4f, closed form %.4f\n", static_cast<double>(h),
                    static_cast<double>(shares.sky_view_factor[0]), truth);
        EXPECT_NEAR(shares.sky_view_factor[0], truth, 0.002);
    }
}

TEST(LightIncidence, IsTheObstructionsAngle) {
    for (const double angle : {0.0, 30.5, 44.5, 60.5}) {
        Vessel vessel(angle > 0.0 ? obstruction(angle) : QuadScene().ground(1, -1000));
        const Sample sample = sample_at({0, 0, 0}, {0, -1, 0});
        const LightIncidence found =
            light_incidence({&sample, 1}, vessel.scene.origin, vessel.rays, 0.0, vessel.silent);
        EXPECT_EQ(found.angle_deg[0], std::ceil(angle));
    }
}

/// The lattice of nodes against a ray at every moment of the year: a point beside boxes that hide the sun at all hours.
TEST(YearSun, LatticeAgreesWithEveryMoment) {
    QuadScene quads;
    quads.ground(300).box({-30, -40, 0}, {-5, -15, 18}).box({4, -30, 0}, {12, -20, 25}).box({15, -10, 0}, {30, 20, 15});
    Vessel vessel(quads);
    const YearLight year = cloudless_year(2026, graz(), 0.0);
    EXPECT_NEAR(year.sunshine_h, 4440.0, 60.0);  // half of a year and the refraction
    EXPECT_NEAR(year.winter_sunshine_h / year.sunshine_h, 0.42, 0.03);
    std::vector<Sample> samples;
    for (int i = 0; i < 10; ++i) {
        samples.push_back(sample_at({-20 + 4 * i, 1.0, 0.5 * i}, {0, -1, 0}));
        samples.push_back(sample_at({-20 + 4 * i, 5.0, 0.0}, {0, 0, 1}));
    }
    const YearSun sun = year_sun(samples, vessel.scene.origin, vessel.rays, year, vessel.silent);
    double squares = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        double seen_h = 0.0;
        const Vec3f origin = Vec3f(samples[i].position) + vessel.rays.surface_offset() * samples[i].normal;
        for (const SunMoment& moment : year.moments) {
            if (glm::dot(moment.direction, samples[i].normal) <= 0.0f) continue;
            if (!vessel.rays.is_occluded(origin, moment.direction)) seen_h += static_cast<double>(moment.sunshine_h);
        }
        const double error = static_cast<double>(sun.sunshine_pct[i]) - 100.0 * seen_h / year.sunshine_h;
        squares += error * error;
        EXPECT_NEAR(error, 0.0, 2.5) << i;
    }
    const double rms = std::sqrt(squares / static_cast<double>(samples.size()));
    std::printf("sunshine by the lattice: RMS error %.2f %% of the year's\n", rms);
    EXPECT_LT(rms, 1.0);
}

}  // namespace
}  // namespace skybake
