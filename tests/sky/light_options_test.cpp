#include "light_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace skybake::cli {
namespace {

using ::testing::HasSubstr;

template <typename Action>
std::string refusal(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

// Truth: the form that the command line promises.
TEST(ParseAlbedo, ReadsOneOrThreeValuesForEachKind) {
    using Albedos = std::vector<std::pair<std::string, Rgb>>;
    EXPECT_EQ(parse_albedo(""), Albedos{});
    EXPECT_EQ(parse_albedo("0.3"), (Albedos{{"default", Rgb(0.3f)}}));
    EXPECT_EQ(parse_albedo("0.3,0.2,0.1"), (Albedos{{"default", Rgb(0.3f, 0.2f, 0.1f)}}));
    EXPECT_EQ(parse_albedo("default=0.3,roof=0.4,0.2,0.1,ground=0"),
              (Albedos{{"default", Rgb(0.3f)}, {"roof", Rgb(0.4f, 0.2f, 0.1f)}, {"ground", Rgb(0.0f)}}));
}

// Truth: physics. A surface that reflects more than it gets is refused where it enters.
TEST(ParseAlbedo, Refuses) {
    EXPECT_THAT(refusal([] { parse_albedo("1.5"); }), HasSubstr("'1.5' is not a number in 0…1"));
    EXPECT_THAT(refusal([] { parse_albedo("-0.1"); }), HasSubstr("is not a number in 0…1"));
    EXPECT_THAT(refusal([] { parse_albedo("nan"); }), HasSubstr("is not a number in 0…1"));
    EXPECT_THAT(refusal([] { parse_albedo("rof=0.3"); }), HasSubstr("did you mean 'roof'"));
    EXPECT_THAT(refusal([] { parse_albedo("roof=0.3,0.2"); }), HasSubstr("'roof' has 2 values"));
    EXPECT_THAT(refusal([] { parse_albedo("roof=0.3,roof=0.2"); }), HasSubstr("'roof' is given twice"));
}

// Truth: what is wrong by itself is found before a city is read; that the CRS gives no site is found after.
TEST(LightOptions, AreCheckedBeforeAndAfterTheCityIsRead) {
    LightOptions options;
    EXPECT_THAT(refusal([&] { check_light_options(options); }), HasSubstr("give --at TIME"));
    options.at = "2026-06-21T12:00Z";
    EXPECT_EQ(refusal([&] { check_light_options(options); }), "accepted");
    FindingLog findings;
    EXPECT_THAT(refusal([&] { daylights_of(options, std::nullopt, 0.0, findings); }), HasSubstr("give --site LAT,LON"));
    const Site from_crs{0.8, 0.3, 0.0};
    EXPECT_EQ(daylights_of(options, from_crs, 0.0, findings).size(), 1u);
    options.site = "10,20";
    EXPECT_NEAR(site_of(options, from_crs)->latitude_rad, radians_from_degrees(10.0), 1e-12)
        << "--site wins over the CRS";
}

}  // namespace
}  // namespace skybake::cli
