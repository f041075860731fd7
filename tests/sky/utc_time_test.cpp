#include "sky/utc_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace skybake {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& text, const std::optional<std::string>& timezone = std::nullopt) {
    try {
        parse_instants(text, timezone);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::vector<std::string> shown(const std::string& text, const std::optional<std::string>& timezone = std::nullopt) {
    std::vector<std::string> labels;
    for (const Instant& instant : parse_instants(text, timezone)) labels.push_back(to_iso8601(instant));
    return labels;
}

// Truth: POSIX seconds of well-known moments.
TEST(UtcTime, ReadsIso8601) {
    EXPECT_EQ(parse_instant("1970-01-01T00:00Z", std::nullopt).utc.milliseconds, 0);
    EXPECT_EQ(parse_instant("2001-09-09T01:46:40Z", std::nullopt).utc.milliseconds, 1'000'000'000'000);
    EXPECT_EQ(parse_instant("2001-09-09T03:46:40.25+02:00", std::nullopt).utc.milliseconds, 1'000'000'000'250);
    EXPECT_EQ(parse_instant("2001-09-08 20:16:40-0530", std::nullopt).utc.milliseconds, 1'000'000'000'000);
    EXPECT_EQ(parse_instant("2001-09-09T24:00Z", std::nullopt), parse_instant("2001-09-10T00:00Z", std::nullopt));
    EXPECT_EQ(parse_instant("1969-12-31T23:59:59.999Z", std::nullopt).utc.milliseconds, -1);
}

TEST(UtcTime, ShowsTheOffsetItWasGiven) {
    for (const char* text : {"2026-06-21T12:00:00+02:00", "2026-06-21T12:00:00Z", "2026-06-21T12:00:00.125-03:30",
                             "0001-01-01T00:00:00Z"}) {
        EXPECT_EQ(to_iso8601(parse_instant(text, std::nullopt)), text);
    }
    // An offset in the text wins over the zone.
    EXPECT_EQ(shown("2026-06-21T12:00Z", "Europe/Vienna"), std::vector<std::string>{"2026-06-21T12:00:00Z"});
}

// Truth: Vienna keeps +01:00 in winter and +02:00 in summer.
TEST(UtcTime, ReadsLocalTime) {
    EXPECT_EQ(shown("2026-01-21T12:00", "Europe/Vienna"), std::vector<std::string>{"2026-01-21T12:00:00+01:00"});
    EXPECT_EQ(shown("2026-06-21T12:00", "Europe/Vienna"), std::vector<std::string>{"2026-06-21T12:00:00+02:00"});
}

// Truth: on 29 March 2026 the clocks of Vienna go from 02:00 to 03:00, on 25 October from 03:00 back to 02:00.
TEST(UtcTime, RefusesLocalTimesThatSummerTimeSkipsOrRepeats) {
    EXPECT_THAT(
        refusal("2026-03-29T02:30", "Europe/Vienna"),
        HasSubstr("2026-03-29T02:30 does not exist in Europe/Vienna: the clocks go from +01:00 to +02:00 then"));
    EXPECT_THAT(refusal("2026-10-25T02:30", "Europe/Vienna"),
                HasSubstr("Write 2026-10-25T02:30+02:00 or 2026-10-25T02:30+01:00"));
    EXPECT_EQ(shown("2026-10-25T02:30+01:00", "Europe/Vienna"), std::vector<std::string>{"2026-10-25T02:30:00+01:00"});
}

TEST(UtcTime, SaysWhatIsWrong) {
    EXPECT_THAT(refusal("2026-06-21T12:00"), HasSubstr("it has neither an offset nor Z, and there is no --timezone"));
    EXPECT_THAT(refusal("2026-02-29T12:00Z"), HasSubstr("there is no day 2026-02-29"));
    EXPECT_THAT(refusal("2026-13-01T12:00Z"), HasSubstr("the month 13 is not in 1…12"));
    EXPECT_THAT(refusal("2026-06-21"), HasSubstr("there is no ' ' after the day"));
    EXPECT_THAT(refusal("2026-06-21T25:00Z"), HasSubstr("the hour 25 is not in 0…24"));
    EXPECT_THAT(refusal("2026-06-21T24:01Z"), HasSubstr("the hour 24 exists only as 24:00"));
    EXPECT_THAT(refusal("2026-06-21T12:00+02:00x"), HasSubstr("something follows after the offset"));
    EXPECT_THAT(refusal("noon"), HasSubstr("the year is not 4 digits"));
    EXPECT_THAT(refusal(""), HasSubstr("the year is not 4 digits"));
    EXPECT_THAT(refusal("2026-06-21T12:00", "Europe/Viena"), HasSubstr("did you mean 'Europe/Vienna'?"));
}

TEST(UtcTime, ReadsLists) {
    EXPECT_EQ(shown("2026-06-21T10:00Z,2026-06-21T12:00+02:30").size(), 2u);
    const auto hours = shown("2026-06-21T04:00Z/2026-06-21T20:00Z/1h");
    ASSERT_EQ(hours.size(), 17u);
    EXPECT_EQ(hours.front(), "2026-06-21T04:00:00Z");
    EXPECT_EQ(hours.back(), "2026-06-21T20:00:00Z");
    EXPECT_EQ(shown("2026-06-21T04:00Z/2026-06-21T05:00Z/25min").size(), 3u);
    EXPECT_EQ(shown("2026-06-21T04:00Z/2026-06-21T05:00Z/0.5h,2026-06-22T04:00Z").size(), 4u);
}

// Truth: a planner's "noon of each day" stays noon on the clock; hours are hours of the sun.
TEST(UtcTime, WholeDaysKeepTheClockTimeOverASwitch) {
    EXPECT_EQ(shown("2026-03-28T12:00/2026-03-29T12:00/1d", "Europe/Vienna"),
              (std::vector<std::string>{"2026-03-28T12:00:00+01:00", "2026-03-29T12:00:00+02:00"}));
    EXPECT_EQ(shown("2026-03-29T01:00/2026-03-29T04:00/1h", "Europe/Vienna"),
              (std::vector<std::string>{"2026-03-29T01:00:00+01:00", "2026-03-29T03:00:00+02:00",
                                        "2026-03-29T04:00:00+02:00"}));
}

TEST(UtcTime, BoundsLists) {
    EXPECT_THAT(refusal("2026-01-01T00:00Z/2027-01-01T00:00Z/1min"), HasSubstr("more than 10000 instants"));
    EXPECT_THAT(refusal("2026-01-02T00:00Z/2026-01-01T00:00Z/1h"), HasSubstr("the end is before the start"));
    for (const char* step : {"0h", "-1h", "1", "h", "1month", "nan", "1e300d", "1e-9s", ""}) {
        EXPECT_THAT(refusal(std::string("2026-01-01T00:00Z/2026-01-02T00:00Z/") + step),
                    HasSubstr("is not a positive number with a unit"))
            << step;
    }
    EXPECT_THAT(refusal("2026-01-01T00:00Z/2026-01-02T00:00Z"), HasSubstr("START/END/STEP"));
    EXPECT_THAT(refusal("2026-01-01T00:00Z,2026-01-01T01:00+01:00"), HasSubstr("twice"));
}

TEST(UtcTime, DecimalYear) {
    EXPECT_DOUBLE_EQ(decimal_year(utc_midnight(2026, 1, 1)), 2026.0);
    EXPECT_NEAR(decimal_year(utc_midnight(2024, 7, 2)), 2024.5, 1e-9);  // 183 of 366 days
}

}  // namespace
}  // namespace skybake
