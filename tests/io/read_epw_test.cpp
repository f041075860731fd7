#include "io/epw/read_epw.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "base/hash_rng.h"
#include "base/vec.h"
#include "io/scratch_folder.h"
#include "sky/solar_position.h"
#include "test_data.h"

namespace skybake {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHeader =
    "LOCATION,Testville,TV,AUT,made,123456,47.10000,15.40000,1.0,350.0\n"
    "DESIGN CONDITIONS,0\n"
    "TYPICAL/EXTREME PERIODS,0\n"
    "GROUND TEMPERATURES,0\n"
    "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
    "COMMENTS 1,\"with, a comma\"\n"
    "COMMENTS 2,\n"
    "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";

/// A row as programs write it; 9999 is "missing".
std::string row(const std::string& date, const std::string& ghi, const std::string& dni, const std::string& dhi) {
    return date + ",?9?9?9?9E0,-4.3,-6.9,80,98190,0,0,246," + ghi + "," + dni + "," + dhi +
           ",0,0,0,0,30,1.0,7,7,777.7,2000,9,999999999,5,0.0850,0,88,0.487,0.0,0.0\n";
}

class ReadEpw : public ::testing::Test {
  protected:
    Weather read(const std::string& text) {
        const auto path = folder_ / "made.epw";
        std::ofstream(path, std::ios::binary) << text;
        findings_ = FindingLog();
        return io::read_epw(path, findings_);
    }
    std::string refusal(const std::string& text) {
        try {
            read(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }
    /// The findings as the user sees them.
    std::string told() const {
        std::string all;
        for (const Finding& finding : findings_.list()) all += to_text(finding) + "\n";
        return all;
    }

    ScratchFolder folder_{"epw"};
    FindingLog findings_;
};

TEST_F(ReadEpw, TakesHeaderAndRows) {
    const Weather weather =
        read(kHeader + row("2016,1,2,13,0", "300", "450.5", "120") + row("2017,3,4,24,60", "0", "0", "0"));
    EXPECT_TRUE(findings_.empty()) << told();
    EXPECT_EQ(weather.name(), "made.epw");
    EXPECT_EQ(weather.station.city, "Testville");
    EXPECT_EQ(weather.station.wmo, "123456");
    EXPECT_NEAR(degrees_from_radians(weather.station.site.latitude_rad), 47.1, 1e-12);
    EXPECT_NEAR(degrees_from_radians(weather.station.site.longitude_rad), 15.4, 1e-12);
    EXPECT_EQ(weather.station.site.elevation_m, 350.0);
    EXPECT_EQ(weather.station.utc_offset_h, 1.0);
    ASSERT_EQ(weather.rows.size(), 2u);
    const WeatherRow& first = weather.rows[0];
    EXPECT_EQ(first.line, 9u);
    EXPECT_EQ(first.year, 2016);
    EXPECT_EQ(first.label_h, 13.0);
    EXPECT_EQ(first.dry_bulb_c, -4.3);
    EXPECT_EQ(first.dew_point_c, -6.9);
    EXPECT_EQ(first.pressure_pa, 98190.0);
    EXPECT_EQ(first.ghi, 300.0);
    EXPECT_EQ(first.dni, 450.5);
    EXPECT_EQ(first.dhi, 120.0);
    EXPECT_EQ(weather.rows[1].label_h, 24.0);
    EXPECT_EQ(label_time(weather, first), parse_instant("2016-01-02T13:00+01:00", std::nullopt).utc);
    EXPECT_EQ(years_of(weather), (std::vector<int>{2016, 2017}));
}

TEST_F(ReadEpw, UnderstandsAllLineEndsAndAByteOrderMark) {
    const std::string text = kHeader + row("2016,1,2,13,0", "300", "450", "120") + row("2016,1,2,14,0", "1", "2", "3");
    for (const char* line_end : {"\r\n", "\r"}) {
        std::string other = "\xef\xbb\xbf";
        for (const char c : text) other += c == '\n' ? std::string(line_end) : std::string(1, c);
        const Weather weather = read(other);
        EXPECT_TRUE(findings_.empty()) << told();
        ASSERT_EQ(weather.rows.size(), 2u);
        EXPECT_EQ(weather.rows[1].line, 10u);
        EXPECT_EQ(weather.rows[1].dhi, 3.0);
    }
}

// Truth: the missing values of the EPW data dictionary.
TEST_F(ReadEpw, LeavesMissingValuesEmpty) {
    std::string text = row("2016,1,2,13,0", "9999", "9999.0", "");
    text.replace(text.find("-4.3,-6.9,80,98190"), 18, "99.9,99.9,999,999999");
    const Weather weather = read(kHeader + text);
    EXPECT_TRUE(findings_.empty()) << told();
    const WeatherRow& only = weather.rows.at(0);
    EXPECT_FALSE(only.ghi || only.dni || only.dhi);
    EXPECT_FALSE(only.dry_bulb_c || only.dew_point_c || only.pressure_pa);
}

TEST_F(ReadEpw, ReadsSeveralRecordsAnHour) {
    std::string header = kHeader;
    header.replace(header.find("PERIODS,1,1"), 11, "PERIODS,1,4");
    const Weather weather = read(header + row("2016,1,2,13,15", "1", "1", "1") + row("2016,1,2,13,60", "1", "1", "1"));
    EXPECT_EQ(weather.records_per_hour, 4);
    EXPECT_EQ(weather.rows.at(0).label_h, 12.25);
    EXPECT_EQ(weather.rows.at(1).label_h, 13.0);
    EXPECT_NEAR(sums_of(weather).ghi, 2.0 * 0.25e-3, 1e-12);
}

// Each fault is told with file, line and remedy; the rows about it stay.
TEST_F(ReadEpw, LeavesBadRowsOutAndSaysWhich) {
    const std::string good = row("2016,1,2,13,0", "300", "450", "120");
    struct Case {
        std::string bad;
        std::string told;
    };
    const std::string cut = row("2016,1,2,14,0", "1", "1", "1").substr(0, 60) + "\n";
    std::string longer = row("2016,1,2,14,0", "1", "1", "1");
    longer.insert(longer.size() - 1, ",1,2,3");
    for (const Case& c : {
             Case{cut, "SB701 error: made.epw:10: the row has 17 fields, not 32 to 35; the row is left out."},
             Case{longer, "SB701 error: made.epw:10: the row has 38 fields, not 32 to 35"},
             Case{row("2015,2,29,1,0", "1", "1", "1"), "SB701 error: made.epw:10: there is no day 2015-02-29"},
             Case{row("2016,13,1,1,0", "1", "1", "1"), "the month is '13', not a whole number in 1…12"},
             Case{row("2016,1,1,25,0", "1", "1", "1"), "the hour is '25', not a whole number in 0…24"},
             Case{row("2016,1,1.5,1,0", "1", "1", "1"), "the day is '1.5'"},
             Case{row("2016,1,1,1,0", "abc", "1", "1"),
                  "the global horizontal radiation in field 14 is 'abc', which is no "
                  "number"},
             Case{row("2016,1,1,1,0", "nan", "1", "1"), "in field 14 is 'nan'"},
             Case{row("2016,1,1,1,0", "1", "-5", "1"),
                  "SB702 error: made.epw:10: the direct normal radiation in field 15 "
                  "is -5 W/m², outside 0…1500"},
             Case{row("2016,1,1,1,0", "1", "1", "2000"), "the diffuse horizontal radiation in field 16 is 2000 W/m²"},
             Case{good, "SB703 warning: made.epw:10: 2016-01-02 hour 13 stands in the file twice"},
             Case{"garbage \x01\xff\n", "the row has 1 fields"},
         }) {
        const Weather weather = read(kHeader + good + c.bad + row("2016,1,2,15,0", "1", "2", "3"));
        EXPECT_THAT(told(), HasSubstr(c.told));
        EXPECT_EQ(weather.rows.size(), 2u) << c.told;
        EXPECT_EQ(weather.rows_left_out, 1u) << c.told;
    }
    std::string header = kHeader;
    header.replace(header.find("PERIODS,1,1"), 11, "PERIODS,1,7");
    read(header + good);
    EXPECT_EQ(findings_.count("SB715"), 1u);
}

TEST_F(ReadEpw, RefusesWhatIsNoWeather) {
    EXPECT_THAT(refusal(""), HasSubstr("made.epw: there is no LOCATION line"));
    EXPECT_THAT(refusal("#1\ndouble tab1(8760,30)\n"), HasSubstr("line 1 begins with '#1', not with LOCATION"));
    EXPECT_THAT(refusal(kHeader), HasSubstr("there is no row of weather below the header"));
    EXPECT_THAT(refusal(std::string(kHeader) + "1,2,3\n4,5\n"),
                HasSubstr("none of its 2 rows can be used; the first: line 9, the row has 3 fields"));
    EXPECT_THAT(refusal(row("2016,1,2,13,0", "1", "1", "1")), HasSubstr("there is no LOCATION line"));
    std::string header = kHeader;
    header.replace(header.find("47.10000"), 8, "97.10000");
    EXPECT_THAT(refusal(header), HasSubstr("line 1: the latitude in field 7 of LOCATION is '97.10000', not a number in "
                                           "-90…90. Repair the line."));
    EXPECT_THAT(refusal("LOCATION,a,b,c,d,1,10,20\n"), HasSubstr("the time zone in field 9 of LOCATION is missing"));
    EXPECT_THROW(io::read_epw(folder_ / "absent.epw", findings_), InputError);
    EXPECT_THROW(io::read_epw(folder_.path(), findings_), InputError);
}

// Truth: none; whatever the bytes, the reader either reads or refuses, and what it read can be settled and asked.
TEST_F(ReadEpw, SurvivesEveryCutAndRandomBytes) {
    std::string whole = kHeader;
    for (int hour = 1; hour <= 24; ++hour) whole += row(fmt::format("2016,6,21,{},0", hour), "300", "400", "100");
    const auto survives = [&](const std::string& text) {
        try {
            Weather weather = read(text);
            settle_weather(weather, findings_);
            weather_at(weather, parse_instant("2024-02-29T12:00Z", std::nullopt).utc);
            const WeatherSums sums = sums_of(weather);
            EXPECT_TRUE(std::isfinite(sums.ghi + sums.dni + sums.dhi));
            EXPECT_TRUE(std::isfinite(weather.centre.offset_h));
        } catch (const InputError&) {
        }
    };
    for (std::size_t size = 0; size < 700; ++size) survives(whole.substr(0, size));
    for (std::size_t size = 700; size < whole.size(); size += 37) survives(whole.substr(0, size));
    for (std::uint64_t trial = 0; trial < 500; ++trial) {
        std::string changed = whole;
        for (std::uint64_t k = 0; k <= trial % 9; ++k) {
            const auto at = static_cast<std::size_t>(uniform_float(7, trial, k, 0) * static_cast<float>(whole.size()));
            constexpr std::string_view kNasty = "\0\n\r\",-.9eE+x\xff\x1f/";
            const float pick = uniform_float(7, trial, k, 1);
            changed[at] = kNasty[static_cast<std::size_t>(pick * static_cast<float>(kNasty.size()))];
        }
        survives(changed);
    }
}

// Truth: data/DATA.md, which found the middle of the hours and the sums with other programs.
TEST(RealWeather, HasTheStatedMiddleAndSums) {
    struct File {
        const char* name;
        double centre_h;
        double ghi, dni, dhi;
    };
    fmt::print("| file | label to middle, h | confidence | residual, W/m² | GHI, DNI, DHI, kWh/m² |\n");
    for (const File& expected : {File{"AUT_ST_Graz.Univ.112900_TMYx.2015-2019.derived.epw", -1.5, 1583, 1686, 566},
                                 File{"700260_Barrow_AK_TMY3.epw", -0.5, 713, 675, 462},
                                 File{"855740_Santiago_CHL_TMYx.epw", -0.5, 1910, 1894, 654},
                                 File{"Singapore-Changi_1990_2010_TMY.epw", -0.5, 1638, 1004, 939}}) {
        const auto path = test_data(std::string("data/weather/") + expected.name);
        SKYBAKE_NEEDS_DATA(path);
        SCOPED_TRACE(expected.name);
        FindingLog findings;
        Weather weather = io::read_epw(path, findings);
        EXPECT_TRUE(findings.empty());
        settle_weather(weather, findings);
        EXPECT_EQ(weather.rows.size(), 8760u);
        EXPECT_TRUE(weather.centre.is_detected);
        EXPECT_EQ(weather.centre.offset_h, expected.centre_h);
        EXPECT_GT(weather.centre.confidence, 0.7);
        EXPECT_LT(weather.centre.residual_w_m2, 2.0);
        EXPECT_EQ(findings.count("SB709"), expected.centre_h == -0.5 ? 0u : 1u);
        const WeatherSums sums = sums_of(weather);
        EXPECT_NEAR(sums.ghi, expected.ghi, 0.5);
        EXPECT_NEAR(sums.dni, expected.dni, 0.5);
        EXPECT_NEAR(sums.dhi, expected.dhi, 0.5);
        fmt::print("| {} | {:+.2f} | {:.2f} | {:.2f} (format's label: {:.2f}) | {:.1f}, {:.1f}, {:.1f} |\n",
                   weather.name(), weather.centre.offset_h, weather.centre.confidence, weather.centre.residual_w_m2,
                   weather.centre.standard_residual_w_m2, sums.ghi, sums.dni, sums.dhi);

        // Truth: the year's sum. Interpolation between the middles keeps it, asked a quarter past each full hour.
        double dni = 0.0;
        for (std::int64_t hour = 0; hour < 8760; ++hour) {
            const UtcTime time{utc_midnight(2026, 1, 1).milliseconds + hour * 3'600'000 + 900'000};
            dni += 1e-3 * weather_at(weather, time)->dni_w_m2;
        }
        EXPECT_NEAR(dni / sums.dni, 1.0, 0.001);

        // The residual again, by the full solar position of every row.
        double sum = 0.0;
        int count = 0;
        for (const WeatherRow& row : weather.rows) {
            if (*row.ghi + *row.dni + *row.dhi <= 0.0) continue;
            const UtcTime middle{label_time(weather, row).milliseconds + std::llround(weather.centre.offset_h * 3.6e6)};
            const SolarPosition sun = solar_position(middle, weather.station.site);
            sum += std::abs(*row.ghi - *row.dhi - *row.dni * std::max(0.0, std::sin(sun.elevation_rad)));
            ++count;
        }
        EXPECT_NEAR(sum / count, weather.centre.residual_w_m2, 0.05);
    }
}

// Truth: the rows that were not touched. A real year with every 97th line broken in one of six ways.
TEST(RealWeather, IsReadAroundBrokenLines) {
    const auto path = test_data("data/weather/855740_Santiago_CHL_TMYx.epw");
    SKYBAKE_NEEDS_DATA(path);
    std::ifstream in(path, std::ios::binary);
    const ScratchFolder folder("epw-broken");
    std::ofstream out(folder / "broken.epw", std::ios::binary);
    std::uint64_t number = 0;
    std::uint64_t broken = 0;
    for (std::string line; std::getline(in, line);) {
        if (++number > 8 && number % 97 == 0) {
            switch (broken++ % 6) {
                case 0:
                    line.resize(line.size() / 3);
                    break;
                case 1:
                    line += ",1,2,3,4";
                    break;
                case 2:
                    line.replace(0, 4, "x");
                    break;
                case 3:
                    line.assign(5000, ',');
                    break;
                case 4:
                    line = "2016,2,30" + line.substr(line.find(',', 9));
                    break;
                case 5:
                    line = std::string("1988,1,1,1,0") + '\0' + "\xff";
                    break;
            }
        }
        out << line << "\n";
    }
    out.close();
    FindingLog findings;
    Weather weather = io::read_epw(folder / "broken.epw", findings);
    EXPECT_EQ(weather.rows_left_out, broken);
    EXPECT_EQ(findings.count("SB701"), broken);
    EXPECT_EQ(weather.rows.size() + weather.rows_left_out, 8760u);
    settle_weather(weather, findings);
    EXPECT_EQ(findings.count("SB704"), 1u);
    EXPECT_EQ(weather.centre.offset_h, -0.5);
    EXPECT_NEAR(sums_of(weather).ghi / 1910.0, 1.0, 0.02);
}

TEST(RealWeather, SixteenHoursAreReadAndNotGuessedAbout) {
    const auto path = test_data("data/broken/real/multiyear_16rows.epw");
    SKYBAKE_NEEDS_DATA(path);
    FindingLog findings;
    Weather weather = io::read_epw(path, findings);
    settle_weather(weather, findings);
    EXPECT_EQ(weather.rows.size(), 16u);
    EXPECT_FALSE(weather.centre.is_detected);
    EXPECT_EQ(weather.centre.offset_h, -0.5);
    EXPECT_EQ(findings.count("SB704"), 1u);
    EXPECT_EQ(findings.count("SB710"), 1u);
    EXPECT_FALSE(weather_at(weather, parse_instant("2009-06-21T12:00-05:00", std::nullopt).utc));
}

}  // namespace
}  // namespace skybake
