// Sunny intervals against day lengths, closed forms and brute force.
#include "study/sun_intervals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash_rng.h"
#include "study/new_shadow.h"
#include "study/study_scenes.h"

namespace skybake {
namespace {

SunDay day_at_graz(CalendarDay day, SunDayOptions options = {}) {
    return SunDay(2026, day, graz(), 0.0, options);
}

SunIntervals intervals(std::span<const Sample> samples, const SunDay& day, QuadScene quads,
                       const SunIntervalOptions& options = {}) {
    const Scene scene = quads.scene();
    const RayScene rays(scene);
    SilentProgress silent;
    return sun_intervals(samples, day, scene.origin, rays, options, silent);
}

/// Day lengths and hours with the sun at 11° or higher at Graz over a flat horizon, as in published tables, to 0.1 h.
TEST(SunDay, DayLengthsAtGraz) {
    struct Row {
        CalendarDay day;
        double all_h, above_11_h;
    };
    for (const Row& row :
         {Row{{1, 17}, 9.0, 6.0}, Row{{3, 21}, 12.2, 9.9}, Row{{6, 21}, 15.9, 13.2}, Row{{12, 21}, 8.5, 5.3}}) {
        const SunDay whole = day_at_graz(row.day), high = day_at_graz(row.day, {.min_elevation_deg = 11.0});
        EXPECT_NEAR(whole.hours(), row.all_h, 0.051) << row.day.month;
        EXPECT_NEAR(high.hours(), row.above_11_h, 0.051) << row.day.month;
        const Sample ground = sample_at({0, 0, 0}, {0, 0, 1});
        const SunIntervals found = intervals({&ground, 1}, whole, QuadScene().ground(50));
        EXPECT_NEAR(duration_of(found.of(0), whole).sun_h, row.all_h, 0.051);
    }
}

TEST(SunDay, WindowsByEveryClock) {
    using Clock = SunWindow::Clock;
    const SunDay solar = day_at_graz({3, 21}, {.window = {Clock::solar, 9, 15}});
    // The equation of time changes by at most 30 s a day, which is 7.5 s in six hours.
    EXPECT_NEAR(solar.hours(), 6.0, 7.5 / 3600.0);
    EXPECT_NEAR(true_solar_time_h(solar.begin(), graz()), 9.0, 2e-3);
    const SunDay civil = day_at_graz({6, 21}, {.window = {Clock::civil, 9, 15}, .timezone = "Europe/Vienna"});
    EXPECT_EQ(to_iso8601({civil.begin(), 0}), "2026-06-21T07:00:00Z");
    const SunDay standard = day_at_graz({6, 21}, {.window = {Clock::standard, 9, 15}, .timezone = "Europe/Vienna"});
    EXPECT_EQ(to_iso8601({standard.begin(), 0}), "2026-06-21T08:00:00Z");
    const SunDay relative = day_at_graz({6, 21}, {.window = {Clock::after_sunrise, 1.5, 1.5}});
    EXPECT_NEAR(relative.hours(), day_at_graz({6, 21}).hours() - 3.0, 1e-3);
    EXPECT_THROW(day_at_graz({6, 21}, {.window = {Clock::civil, 9, 15}}), InputError);
    // Barrow in December: no sun at all.
    const Site barrow{radians_from_degrees(71.3), radians_from_degrees(-156.8), 0.0};
    EXPECT_EQ(SunDay(2026, {12, 21}, barrow, 0.0, {}).hours(), 0.0);
}

/// A screen hides the azimuths between two instants: the sun is gone between them and at no other time.
TEST(SunIntervals, EndWhereTheSunsAzimuthMeetsTheScreen) {
    const SunDay day = day_at_graz({3, 21});
    const auto azimuth = [&](double second) {
        const Vec3f d = day.direction(second);
        return std::atan2(static_cast<double>(d.x), static_cast<double>(d.y));
    };
    QuadScene quads;
    add_screen(quads, azimuth(12'345.0), azimuth(16'789.0));
    const Sample point = sample_at({0, 0, 0}, {0, 0, 1});
    const SunIntervals found = intervals({&point, 1}, day, quads);
    ASSERT_EQ(found.of(0).size(), 2u);
    // Screens are 10 m away and corners are floats: 1e-6 m, far below a second (7e-5 rad).
    EXPECT_NEAR(found.of(0)[0].end_s, 12'345.0, 1.0);
    EXPECT_NEAR(found.of(0)[1].begin_s, 16'789.0, 1.0);
    const SunDuration d = duration_of(found.of(0), day);
    EXPECT_NEAR(d.longest_shadow_h, 4'444.0 / 3600.0, 1.001 / 3600.0);  // half a second at each end
    EXPECT_NEAR(d.sun_h + d.shadow_h, day.hours(), 1e-9);
    // Runs that are too short are shadow.
    EXPECT_NEAR(duration_of(found.of(0), day, 13'000.0).sun_h, d.sun_h - 12'345.0 / 3600.0, 1.0 / 3600.0);
}

/// Random boxes, random points: every change between two seconds of a brute force lies within 2 s of an interval's end.
/// What the scan may miss are moments shorter than its step; at a step of 30 s one in a thousand ends is allowed.
TEST(SunIntervals, AgreeWithBruteForce) {
    RandomSequence random(1, 2, 3);
    QuadScene quads;
    quads.ground(200);
    for (int i = 0; i < 60; ++i) {
        const Vec3f lo(160 * random.next() - 80, 160 * random.next() - 80, 0);
        quads.box(lo, lo + Vec3f(3 + 12 * random.next(), 3 + 12 * random.next(), 3 + 25 * random.next()));
    }
    std::vector<Sample> samples;
    for (int i = 0; i < 48; ++i)
        samples.push_back(
            sample_at({60 * random.next() - 30, 60 * random.next() - 30, 30 * random.next()}, {0, -1, 0}));
    const SunDay day = day_at_graz({4, 10});
    const SunIntervals found = intervals(samples, day, quads, {.scan_s = 30.0});
    const Scene scene = quads.scene();
    const RayScene rays(scene);
    int ends = 0, missed = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec3f origin = Vec3f(samples[i].position) + rays.surface_offset() * samples[i].normal;
        bool was_sunny = false;
        for (int s = 0; s <= day.length_s(); ++s) {
            const Vec3f direction = day.direction(s);
            const bool is_sunny = direction.y < 0.0f && !rays.is_occluded(origin, direction);
            if (is_sunny != was_sunny) {
                ++ends;
                missed += std::none_of(found.of(i).begin(), found.of(i).end(), [&](const SunInterval& interval) {
                    const float end = is_sunny ? interval.begin_s : interval.end_s;
                    return std::abs(end - static_cast<float>(s)) <= 2.0f;
                });
            }
            was_sunny = is_sunny;
        }
    }
    EXPECT_GT(ends, 100);
    EXPECT_LE(missed, ends / 1000 + 1);
}

/// Hourly instants of a day whose sun is hidden between two of them.
TEST(SunIntervals, SampledConstructionDecidesBetweenInstants) {
    const SunDay day = day_at_graz({3, 21}, {.window = {SunWindow::Clock::solar, 8, 16}});
    QuadScene quads;
    const auto azimuth = [&](double hour) {
        const Vec3f d = day.direction(3600.0 * hour);
        return std::atan2(static_cast<double>(d.x), static_cast<double>(d.y));
    };
    add_screen(quads, azimuth(1.5), azimuth(4.5));  // hides hours 2, 3, 4 of 0…8
    const Sample point = sample_at({0, 0, 0}, {0, 0, 1});
    const auto shadow = [&](BetweenSamples between) {
        const SunIntervals found =
            intervals({&point, 1}, day, quads, {.sampled = SampledConstruction{3600.0, between}});
        return duration_of(found.of(0), day);
    };
    EXPECT_NEAR(shadow(BetweenSamples::nearest).shadow_h, 3.0, 1e-3);
    EXPECT_NEAR(shadow(BetweenSamples::shadow_needs_both).longest_shadow_h, 2.0, 1e-3);
    EXPECT_NEAR(shadow(BetweenSamples::sun_needs_both).longest_shadow_h, 4.0, 1e-3);
}

TEST(NewShadow, IsWhatIsLost) {
    using testing::ElementsAre;
    const std::vector<SunInterval> before{{0, 10}, {20, 30}}, after{{2, 4}, {8, 22}, {29, 40}};
    EXPECT_THAT(lost_sun(before, after), ElementsAre(SunInterval{0, 2}, SunInterval{4, 8}, SunInterval{22, 29}));
    EXPECT_THAT(lost_sun(after, after), ElementsAre());
    EXPECT_THAT(united({{5, 7}, {0, 2}, {1, 3}}), ElementsAre(SunInterval{0, 3}, SunInterval{5, 7}));
}

}  // namespace
}  // namespace skybake
