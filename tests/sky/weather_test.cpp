#include "sky/weather.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/hash_rng.h"
#include "sky/clear_sky.h"
#include "sky/daylight_settings.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

using ::testing::HasSubstr;

constexpr int kDaysOfMonth[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

struct MadeYear {
    double latitude_deg = 47.0;
    double longitude_deg = 15.5;
    double utc_offset_h = 1.0;
    double centre_h = -0.5;  // from the label
    int records_per_hour = 1;
    int year = 2018;
};

/// A year of clear sky at turbidity 3, each row for the middle of its interval, by the full solar position.
Weather clear_year(const MadeYear& made) {
    Weather weather;
    weather.file = "made.epw";
    weather.station.site = {radians_from_degrees(made.latitude_deg), radians_from_degrees(made.longitude_deg), 0.0};
    weather.station.utc_offset_h = made.utc_offset_h;
    weather.records_per_hour = made.records_per_hour;
    const bool is_leap = made.year % 4 == 0;
    for (int month = 1; month <= 12; ++month) {
        const int days = kDaysOfMonth[month - 1] + (is_leap && month == 2 ? 1 : 0);
        for (int day = 1; day <= days; ++day) {
            for (int i = 1; i <= 24 * made.records_per_hour; ++i) {
                WeatherRow row;
                row.line = weather.rows.size() + 9;
                row.year = made.year;
                row.month = month;
                row.day = day;
                row.label_h = static_cast<double>(i) / made.records_per_hour;
                const UtcTime middle{label_time(weather, row).milliseconds + std::llround(made.centre_h * 3.6e6)};
                const SolarPosition sun = solar_position(middle, weather.station.site);
                const ClearSkyIrradiance clear =
                    clear_sky_irradiance(3.0, kPi / 2.0 - sun.elevation_rad, sun.distance_au);
                row.dni = clear.dni;
                row.dhi = clear.dhi;
                row.ghi = clear.dhi + clear.dni * std::max(0.0, std::sin(sun.elevation_rad));
                weather.rows.push_back(row);
            }
        }
    }
    return weather;
}

UtcTime at(const char* text) {
    return parse_instant(text, std::nullopt).utc;
}

WeatherRow& row_of(Weather& weather, int month, int day, double label_h) {
    for (WeatherRow& row : weather.rows) {
        if (row.month == month && row.day == day && row.label_h == label_h) return row;
    }
    throw std::out_of_range("no such row");
}

// Truth: the middle that the rows were made for, from pole to pole, with the labels of several kinds of writers.
TEST(HourCentre, IsFoundWhereverTheRowsWereMade) {
    for (const MadeYear& made :
         {MadeYear{.centre_h = -0.5}, MadeYear{.centre_h = -1.5}, MadeYear{.centre_h = 0.0}, MadeYear{.centre_h = 0.5},
          MadeYear{.centre_h = -0.25}, MadeYear{.centre_h = -0.85},
          MadeYear{.latitude_deg = -77.8, .longitude_deg = 166.7, .utc_offset_h = 12.0},
          MadeYear{.latitude_deg = 71.3, .longitude_deg = -156.8, .utc_offset_h = -9.0, .centre_h = 1.0},
          MadeYear{.latitude_deg = 1.4, .longitude_deg = 104.0, .utc_offset_h = 8.0},
          MadeYear{.longitude_deg = 139.7, .utc_offset_h = 0.0, .centre_h = -9.5},
          MadeYear{.centre_h = -0.125, .records_per_hour = 4}, MadeYear{.centre_h = 0.125, .records_per_hour = 4}}) {
        SCOPED_TRACE(made.centre_h);
        const HourCentre centre = find_hour_centre(clear_year(made));
        EXPECT_TRUE(centre.is_detected);
        EXPECT_NEAR(centre.offset_h, made.centre_h, 1.0 / 60.0);
        EXPECT_GT(centre.confidence, 0.9);
        EXPECT_LT(centre.residual_w_m2, 1.5);
    }
}

// Truth: measured data. Noise of 30 W/m² on each value leaves the middle to within ten minutes and lowers the
// confidence; without a sun nothing is known, and the format's promise stands.
TEST(HourCentre, SurvivesNoiseAndAdmitsIgnorance) {
    Weather noisy = clear_year({.centre_h = -1.0});
    std::uint64_t n = 0;
    // Uniform, so √12 times the standard deviation wide.
    const auto noise = [&] {
        return 30.0 * std::sqrt(12.0) * (static_cast<double>(uniform_float(1, n++, 0, 0)) - 0.5);
    };
    for (WeatherRow& row : noisy.rows) {
        if (*row.ghi == 0.0) continue;
        row.ghi = std::max(0.0, *row.ghi + noise());
        row.dhi = std::max(0.0, *row.dhi + noise());
    }
    const HourCentre centre = find_hour_centre(noisy);
    EXPECT_TRUE(centre.is_detected);
    EXPECT_NEAR(centre.offset_h, -1.0, 10.0 / 60.0);
    EXPECT_NEAR(centre.confidence, 0.17, 0.05);

    Weather overcast = clear_year({.centre_h = -1.0});
    for (WeatherRow& row : overcast.rows) {
        row.dni = 0.0;
        row.ghi = row.dhi;
    }
    const HourCentre unknown = find_hour_centre(overcast);
    EXPECT_FALSE(unknown.is_detected);
    EXPECT_EQ(unknown.offset_h, -0.5);
    FindingLog findings;
    settle_weather(overcast, findings);
    EXPECT_EQ(findings.count("SB710"), 1u);
}

TEST(SettleWeather, TellsOfHoursThatAreNotWhereTheFormatHasThem) {
    Weather shifted = clear_year({.centre_h = -1.5});
    FindingLog findings;
    settle_weather(shifted, findings);
    ASSERT_EQ(findings.count("SB709"), 1u);
    EXPECT_THAT(to_text(findings.list()[0]), HasSubstr("the middle of the hours is label −1.5 h, not label −0.5 h"));

    Weather usual = clear_year({});
    FindingLog silent;
    settle_weather(usual, silent);
    EXPECT_TRUE(silent.empty());
}

// Truth: the columns as they were before they were exchanged.
TEST(SettleWeather, PutsExchangedColumnsRight) {
    const Weather right = clear_year({.centre_h = -1.0});
    for (const auto& [a, b] :
         {std::pair{&WeatherRow::ghi, &WeatherRow::dni}, std::pair{&WeatherRow::ghi, &WeatherRow::dhi},
          std::pair{&WeatherRow::dni, &WeatherRow::dhi}}) {
        Weather wrong = right;
        for (WeatherRow& row : wrong.rows) std::swap(row.*a, row.*b);
        FindingLog findings;
        settle_weather(wrong, findings);
        EXPECT_EQ(findings.count("SB708"), 1u);
        EXPECT_NEAR(wrong.centre.offset_h, -1.0, 1e-9);
        EXPECT_EQ(wrong.rows[4000].ghi, right.rows[4000].ghi);
        EXPECT_EQ(wrong.rows[4000].dni, right.rows[4000].dni);
    }
}

// Truth: the value that was taken away.
TEST(SettleWeather, FillsOneMissingValue) {
    const Weather whole = clear_year({});
    Weather gaps = whole;
    row_of(gaps, 6, 21, 12.0).ghi.reset();
    row_of(gaps, 6, 21, 13.0).dni.reset();
    row_of(gaps, 6, 21, 14.0).dhi.reset();
    row_of(gaps, 6, 21, 15.0).dhi.reset();
    row_of(gaps, 6, 21, 15.0).dni.reset();
    row_of(gaps, 6, 21, 1.0).dni.reset();
    FindingLog findings;
    settle_weather(gaps, findings);
    EXPECT_EQ(findings.count("SB705"), 4u);
    EXPECT_EQ(findings.count("SB706"), 1u);
    for (const double label : {1.0, 12.0, 13.0, 14.0}) {
        Weather copy = whole;
        const WeatherRow& expected = row_of(copy, 6, 21, label);
        const WeatherRow& row = row_of(gaps, 6, 21, label);
        EXPECT_NEAR(*row.ghi, *expected.ghi, 0.5) << label;
        EXPECT_NEAR(*row.dni, *expected.dni, 0.5) << label;
        EXPECT_NEAR(*row.dhi, *expected.dhi, 0.5) << label;
    }
    EXPECT_FALSE(row_of(gaps, 6, 21, 15.0).dni.has_value());
}

TEST(SettleWeather, TellsOfHoursThatDoNotAddUpAndOfWrongZones) {
    Weather weather = clear_year({});
    *row_of(weather, 6, 21, 12.0).ghi += 300.0;
    FindingLog findings;
    settle_weather(weather, findings);
    ASSERT_EQ(findings.count("SB707"), 1u);
    EXPECT_THAT(findings.list()[0].where, HasSubstr("made.epw:"));

    Weather mirrored = clear_year({.longitude_deg = 105.0, .utc_offset_h = 7.0});
    mirrored.station.site.longitude_rad *= -1.0;
    FindingLog zone;
    settle_weather(mirrored, zone);
    EXPECT_EQ(zone.count("SB714"), 1u);
}

// Truth: a row counts wholly at the middle of its interval, half of two rows in between; the year closes on itself.
TEST(WeatherAt, IsLinearBetweenTheMiddlesOfTheHours) {
    Weather weather = clear_year({.centre_h = -1.5});
    FindingLog findings;
    settle_weather(weather, findings);
    row_of(weather, 12, 31, 24.0).dni = 10.0;
    row_of(weather, 1, 1, 1.0).dni = 30.0;
    row_of(weather, 1, 1, 2.0).dni = 50.0;
    // Labels 13 and 14 have their middles at 11:30 and 12:30.
    const WeatherRow thirteen = row_of(weather, 6, 21, 13.0);
    const WeatherRow fourteen = row_of(weather, 6, 21, 14.0);
    const auto middle = weather_at(weather, at("2026-06-21T11:30+01:00"));
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->dni_w_m2, *thirteen.dni, 1e-9);
    EXPECT_NEAR(middle->dhi_w_m2, *thirteen.dhi, 1e-9);
    EXPECT_NEAR(weather_at(weather, at("2026-06-21T12:00+01:00"))->dni_w_m2, 0.5 * (*thirteen.dni + *fourteen.dni),
                1e-9);
    EXPECT_NEAR(weather_at(weather, at("2026-06-21T13:15+02:00"))->dni_w_m2,
                0.25 * *thirteen.dni + 0.75 * *fourteen.dni, 1e-9);
    // Label 24 of the last day: 22:30; label 1 of the first: 23:30 of the day before.
    EXPECT_NEAR(weather_at(weather, at("2025-12-31T22:30+01:00"))->dni_w_m2, 10.0, 1e-9);
    EXPECT_NEAR(weather_at(weather, at("2025-12-31T23:00+01:00"))->dni_w_m2, 20.0, 1e-9);
    EXPECT_NEAR(weather_at(weather, at("2026-01-01T00:00+01:00"))->dni_w_m2, 40.0, 1e-9);
}

TEST(WeatherAt, KnowsLeapDaysGapsAndYears) {
    FindingLog findings;
    Weather common = clear_year({});
    settle_weather(common, findings);
    const auto replaced = weather_at(common, at("2028-02-29T11:30+01:00"));
    ASSERT_TRUE(replaced);
    EXPECT_TRUE(replaced->is_leap_day_replaced);
    EXPECT_NEAR(replaced->dni_w_m2, *row_of(common, 2, 28, 12.0).dni, 1e-9);

    Weather leap = clear_year({.year = 2020});
    settle_weather(leap, findings);
    EXPECT_EQ(leap.rows.size(), 8784u);
    EXPECT_EQ(expected_rows(leap), 8784u);
    EXPECT_NEAR(weather_at(leap, at("2028-02-29T11:30+01:00"))->dni_w_m2, *row_of(leap, 2, 29, 12.0).dni, 1e-9);
    EXPECT_NEAR(weather_at(leap, at("2026-03-01T11:30+01:00"))->dni_w_m2, *row_of(leap, 3, 1, 12.0).dni, 1e-9);

    // An hour without radiation: its own middle is out of reach of both neighbours, their own halves are not.
    row_of(common, 6, 21, 12.0).dni.reset();
    EXPECT_FALSE(weather_at(common, at("2026-06-21T11:30+01:00")));
    EXPECT_NEAR(weather_at(common, at("2026-06-21T10:45+01:00"))->dni_w_m2, *row_of(common, 6, 21, 11.0).dni, 1e-9);

    // Two years in one file: an instant takes the one of its own year, and finds nothing in others.
    Weather two = clear_year({.year = 2018});
    const Weather second = clear_year({.year = 2019});
    two.rows.insert(two.rows.end(), second.rows.begin(), second.rows.end());
    FindingLog whole;
    settle_weather(two, whole);
    EXPECT_TRUE(two.spans_years);
    EXPECT_TRUE(whole.empty()) << to_text(whole.list()[0]);
    two.rows[8760 + 11].dni = 123.0;
    EXPECT_NEAR(weather_at(two, at("2019-01-01T11:30+01:00"))->dni_w_m2, 123.0, 1e-9);
    EXPECT_GT(weather_at(two, at("2018-01-01T11:30+01:00"))->dni_w_m2, 200.0);
    EXPECT_FALSE(weather_at(two, at("2026-01-01T11:30+01:00")));
}

// Truth: closure. The daylight of an hour's middle gives the file's own diffuse and direct irradiance, hence its
// global.
TEST(DaylightOfWeather, HasTheIrradianceOfItsHour) {
    DaylightSettings settings;
    settings.sky = PreethamSettings{};
    settings.weather = clear_year({});
    settle_weather(*settings.weather, settings.weather_findings);
    WeatherRow& row = row_of(*settings.weather, 6, 21, 12.0);
    row.dni = 400.0;
    row.dhi = 250.0;
    settings.instants = parse_instants("2026-06-21T11:30+01:00", std::nullopt);
    FindingLog findings;
    const Daylight light = make_daylights(settings, std::nullopt, 0.0, findings).at(0);
    EXPECT_EQ(findings.count("SB711"), 1u);
    EXPECT_NEAR(light.sun.dni_w_m2, 400.0, 1e-3);
    EXPECT_NEAR(horizontal_diffuse(light.sky).irradiance_w_m2, 250.0, 0.5);
    const double efficacy = static_cast<double>(luminance(light.sun.normal_illuminance)) / 400.0;
    EXPECT_GT(efficacy, 80.0);  // of a high sun: 90…115 lm/W in Perez 1990
    EXPECT_LT(efficacy, 120.0);
    EXPECT_EQ(to_text(sky_at(settings, 0)), "preetham:turbidity=3,level=dhi=250");

    // The sun is down, whatever the neighbouring hours brought.
    settings.instants = parse_instants("2026-06-21T23:30+01:00", std::nullopt);
    EXPECT_EQ(make_daylights(settings, std::nullopt, 0.0, findings).at(0).sun.dni_w_m2, 0.0f);

    FindingLog far;
    make_daylights(settings, Site{radians_from_degrees(48.2), radians_from_degrees(16.4), 0.0}, 0.0, far);
    EXPECT_EQ(far.count("SB712"), 1u);
    EXPECT_EQ(far.count("SB711"), 0u);

    row.dni.reset();
    settings.instants = parse_instants("2026-06-21T11:30+01:00", std::nullopt);
    EXPECT_THROW(make_daylights(settings, std::nullopt, 0.0, findings), InputError);
    settings.instants.clear();
    EXPECT_THROW(make_daylights(settings, std::nullopt, 0.0, findings), InputError);
}

}  // namespace
}  // namespace skybake
