// The outline of shadows on the ground against those of boxes, known by hand.
#include "study/shadow_outline.h"

#include <gtest/gtest.h>

#include "bake/scenes.h"
#include "study/obstruction.h"
#include "study/study_pictures.h"
#include "study/study_rows.h"
#include "study/study_scenes.h"

namespace skybake {
namespace {

/// A wall of 20 × 10 m that runs from west to east, 30 m south of the middle of flat ground.
QuadScene wall_scene() {
    return QuadScene().ground(100).quad({-10, -30, 0}, {10, -30, 0}, {10, -30, 10}, {-10, -30, 10});
}

Vec3f sun_at(double azimuth_deg, double elevation_deg) {
    const double a = radians_from_degrees(azimuth_deg), e = radians_from_degrees(elevation_deg);
    return Vec3f(static_cast<float>(std::sin(a) * std::cos(e)), static_cast<float>(std::cos(a) * std::cos(e)),
                 static_cast<float>(std::sin(e)));
}

class ShadowOutlineTest : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Spacing, ShadowOutlineTest, testing::Values(0.5, 1.0, 2.0));

/// Sun in the south at 45°: a square of 20 × 10 m north of the wall, but for 10 cm that the nodes lie above the ground,
/// and for four corners of which each is cut by at most half a square of the lattice.
TEST_P(ShadowOutlineTest, OfAWallHasItsArea) {
    const double spacing = GetParam();
    const Scene scene = wall_scene().scene();
    const RayScene rays(scene);
    const ShadowGround ground(scene, spacing, 0.0);
    const ShadowOutline outline = ground.outline({&scene, &rays}, std::nullopt, sun_at(180.0, 45.0));
    ASSERT_EQ(outline.rings.size(), 1u);
    EXPECT_LE(outline.area_m2, 20.0 * 9.9 + 0.02 * 60.0);
    EXPECT_GE(outline.area_m2, 20.0 * 9.9 - 0.02 * 60.0 - 4.0 * 0.5 * spacing * spacing);
    for (const Vec2d& p : outline.rings[0]) {
        EXPECT_GT(p.x, -10.02);
        EXPECT_LT(p.x, 10.02);
        EXPECT_GT(p.y, -30.02);
        EXPECT_LT(p.y, -20.08);
    }
}

/// The new shadow of a wall that grows from 10 to 15 m is the strip beyond the old one: 20 × 5 m.
TEST(ShadowOutlines, NewShadowIsWhatWasSunny) {
    const Scene before = wall_scene().scene();
    const Scene after =
        QuadScene().ground(100).quad({-10, -30, 0}, {10, -30, 0}, {10, -30, 15}, {-10, -30, 15}).scene();
    const RayScene before_rays(before), after_rays(after);
    const ShadowGround ground(after, 1.0, 0.0);
    const StudyCity now{&after, &after_rays}, then{&before, &before_rays};
    const ShadowOutline strip = ground.outline(now, then, sun_at(180.0, 45.0));
    EXPECT_NEAR(strip.area_m2, 100.0, 0.02 * 50.0 + 4.0 * 0.5);
    EXPECT_TRUE(ground.outline(now, now, sun_at(180.0, 45.0)).rings.empty());
    EXPECT_TRUE(ground.outline({&after, &after_rays}, std::nullopt, sun_at(90.0, 45.0)).rings.empty());
}

/// A court within a ring of walls: one ring about the shadow, one about the sun in it, taken off.
TEST(ShadowOutlines, HolesRunTheOtherWay) {
    QuadScene roof = QuadScene().ground(60);
    const auto slab = [&](float x0, float y0, float x1, float y1) {
        roof.quad({x0, y0, 5}, {x1, y0, 5}, {x1, y1, 5}, {x0, y1, 5});
    };
    slab(-20, -20, 20, -10), slab(-20, 10, 20, 20), slab(-20, -10, -10, 10), slab(10, -10, 20, 10);
    const Scene scene = roof.scene();
    const RayScene rays(scene);
    const ShadowOutline outline =
        ShadowGround(scene, 1.0, 0.0).outline({&scene, &rays}, std::nullopt, sun_at(180.0, 60.0));
    EXPECT_EQ(outline.rings.size(), 2u);
    EXPECT_NEAR(outline.area_m2, 1600.0 - 400.0, 0.02 * 240.0 + 8.0 * 0.5);
}

TEST(Simplified, KeepsCornersAndDropsWhatLiesBetween) {
    std::vector<Vec2d> square;
    for (int i = 0; i < 40; ++i) {
        const double t = 0.1 * (i % 10);
        square.push_back(i < 10 ? Vec2d(t, 0) : i < 20 ? Vec2d(1, t) : i < 30 ? Vec2d(1 - t, 1) : Vec2d(0, 1 - t));
    }
    EXPECT_EQ(simplified(square, 0.01), (std::vector<Vec2d>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

/// North of an endless wall of 45° the south is hidden up to 45° (and less aside); the wall's own back hides the rest.
TEST(Obstructions, OfAnEndlessWall) {
    const Scene scene =
        QuadScene().quad({-20000, -100, -10}, {20000, -100, -10}, {20000, -100, 100}, {-20000, -100, 100}).scene();
    const RayScene rays(scene);
    const Obstruction dome = obstruction_of(sample_at({0, 0, 0}, {0, -1, 0}), scene.origin, rays, 0.0);
    using Cell = Obstruction::Cell;
    EXPECT_EQ(dome.at(90, 44), Cell::hidden);  // 181° azimuth, 44.5° elevation
    EXPECT_EQ(dome.at(90, 45), Cell::free);
    EXPECT_EQ(dome.at(120, 25), Cell::hidden);  // 241°: tan e = cos 61°, 25.9°
    EXPECT_EQ(dome.at(120, 26), Cell::free);
    EXPECT_EQ(dome.at(10, 80), Cell::behind);
}

TEST(WholeHours, AreThoseOfTheClock) {
    const SunDay day(2026, {6, 21}, graz(), 0.0, {});
    const std::vector<WholeHour> solar = whole_hours(day, graz(), std::nullopt);
    ASSERT_FALSE(solar.empty());
    for (const WholeHour& hour : solar)
        EXPECT_NEAR(true_solar_time_h(day.time_of(hour.second), graz()), std::stod(hour.clock.substr(0, 2)), 0.01);
    const std::vector<WholeHour> vienna = whole_hours(day, graz(), "Europe/Vienna");
    // Sun from 5:05 to 20:56 by the clock of summer.
    EXPECT_EQ(vienna.front().clock, "06:00");
    EXPECT_EQ(vienna.back().clock, "20:00");
    const UtcTime six{utc_midnight(2026, 6, 21).milliseconds + 4 * 3'600'000};
    EXPECT_LE(std::abs(day.time_of(vienna.front().second).milliseconds - six.milliseconds), 500);
}

}  // namespace
}  // namespace skybake
