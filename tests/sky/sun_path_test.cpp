#include "sky/sun_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/vec.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

Site site_of(double latitude_deg, double longitude_deg) {
    return {radians_from_degrees(latitude_deg), radians_from_degrees(longitude_deg), 0.0};
}

double highest_deg(const DayArc& arc) {
    double highest = 0.0;
    for (const SunPathLine& line : arc.lines) {
        for (const SunPathPoint& point : line) highest = std::max(highest, degrees_from_radians(point.elevation_rad));
    }
    return highest;
}

// Truth: its definition. UTC + longitude + equation of time, and 12 when the sun is in the meridian.
TEST(TrueSolarTime, IsMeanTimePlusTheEquationOfTime) {
    const Site graz = site_of(47.07, 15.44);
    for (const char* text : {"2026-02-11T10:30Z", "2026-11-03T22:59:30Z", "2026-06-21T00:00Z"}) {
        const UtcTime time = parse_instant(text, std::nullopt).utc;
        const double utc_h = std::fmod(seconds_since_1970(time), 86400.0) / 3600.0;
        const double expected = utc_h + 15.44 / 15.0 + solar_position(time, graz).equation_of_time_min / 60.0;
        EXPECT_NEAR(std::remainder(true_solar_time_h(time, graz) - expected, 24.0), 0.0, 0.5 / 3600.0) << text;
    }
    const SolarEvents events = solar_events(parse_instant("2026-02-11T10:30Z", std::nullopt).utc, graz);
    EXPECT_NEAR(true_solar_time_h(events.transit, graz), 12.0, 1.0 / 3600.0);
}

// Truth: 90° − |latitude − declination|, the obliquity 23.44°, and the calendar of 2026 (solstices 21 June, 21
// December, equinox 20 March). Refraction adds 0.01° to 0.05°.
TEST(YearArcs, RunFromSolsticeToSolstice) {
    const std::vector<DayArc> arcs = year_arcs(2026, site_of(47.07, 15.44));
    ASSERT_EQ(arcs.size(), 7u);
    EXPECT_EQ(arcs[0].day, (CalendarDay{12, 21}));
    EXPECT_EQ(arcs[3].day, (CalendarDay{3, 20}));
    EXPECT_EQ(arcs[6].day, (CalendarDay{6, 21}));
    EXPECT_NEAR(highest_deg(arcs[0]), 90.0 - 47.07 - 23.44, 0.08);
    EXPECT_NEAR(highest_deg(arcs[3]), 90.0 - 47.07, 0.2);
    EXPECT_NEAR(highest_deg(arcs[6]), 90.0 - 47.07 + 23.44, 0.05);
    for (const DayArc& arc : arcs) {
        ASSERT_EQ(arc.lines.size(), 1u);
        EXPECT_EQ(arc.lines[0].front().elevation_rad, 0.0);
        EXPECT_EQ(arc.lines[0].back().elevation_rad, 0.0);
        EXPECT_LT(arc.lines[0].front().azimuth_rad, kPi);
        EXPECT_GT(arc.lines[0].back().azimuth_rad, kPi);
    }
    // Twins have the same arc to half a degree.
    EXPECT_FALSE(arcs[0].twin);
    for (std::size_t i = 1; i < 6; ++i) {
        ASSERT_TRUE(arcs[i].twin);
        const UtcTime noon = local_mean_noon(2026, arcs[i].twin->month, arcs[i].twin->day, site_of(47.07, 15.44));
        EXPECT_NEAR(highest_deg(arc_of(noon, site_of(47.07, 15.44))), highest_deg(arcs[i]), 0.25);
    }
}

TEST(YearArcs, KnowPolarDayAndNight) {
    const std::vector<DayArc> arcs = year_arcs(2026, site_of(71.3, -156.8));
    EXPECT_EQ(arcs[0].kind, SolarDayKind::polar_night);
    EXPECT_TRUE(arcs[0].lines.empty());
    EXPECT_EQ(arcs[6].kind, SolarDayKind::midnight_sun);
    ASSERT_EQ(arcs[6].lines.size(), 1u);
    EXPECT_EQ(arcs[6].lines[0].size(), 289u);
}

// Truth: the sun's own position. 12 o'clock solar is due south; 12 o'clock of a clock is the sun at that instant.
TEST(HourLines, AreThoseOfTheSunAndOfTheClock) {
    const Site graz = site_of(47.07, 15.44);
    const std::vector<HourLine> solar = hour_lines(2026, graz, std::nullopt);
    ASSERT_EQ(solar.size(), 24u);
    for (const SunPathPoint& point : solar[12].spring.at(0))
        EXPECT_NEAR(degrees_from_radians(point.azimuth_rad), 180.0, 0.01);
    EXPECT_TRUE(solar[0].spring.empty());

    const std::vector<HourLine> clock = hour_lines(2026, graz, 60);
    const SunPathPoint june = clock[12].spring.at(0).back();
    const SolarPosition sun = solar_position(parse_instant("2026-06-21T12:00+01:00", std::nullopt).utc, graz);
    EXPECT_NEAR(june.azimuth_rad, sun.azimuth_rad, 1e-9);
    EXPECT_NEAR(june.elevation_rad, sun.apparent_elevation_rad, 1e-9);
    // Low hours end on the horizon.
    EXPECT_EQ(clock[6].spring.at(0).front().elevation_rad, 0.0);
}

// Truth: the IANA database.
TEST(StandardUtcOffset, IsTheLeastOfTheYear) {
    EXPECT_EQ(standard_utc_offset_min(2026, "Europe/Vienna"), 60);
    EXPECT_EQ(standard_utc_offset_min(2026, "Australia/Sydney"), 600);
    EXPECT_EQ(standard_utc_offset_min(2026, "Asia/Kolkata"), 330);
    EXPECT_EQ(standard_utc_offset_min(2026, "America/St_Johns"), -210);
    EXPECT_THROW(standard_utc_offset_min(2026, "Europe/Graz"), InputError);
    EXPECT_EQ(year_of(parse_instant("2026-01-01T00:30+01:00", std::nullopt)), 2026);
}

}  // namespace
}  // namespace skybake
