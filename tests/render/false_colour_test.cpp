// The scale of false colours: ends, order of lightness, round ticks, range of a picture.
#include "render/false_colour.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace skybake {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels(const FalseColour& scale) {
    std::vector<std::string> names;
    for (const ScaleTick& tick : ticks_of(scale)) names.push_back(tick.label);
    return names;
}

TEST(FalseColour, GrowsLighterFromLowToHighAndStopsAtTheEnds) {
    const FalseColour scale{100.0, 900.0, false};
    float last = -1.0f;
    for (double value = 100.0; value <= 900.0; value += 10.0) {
        const float lightness = std::cbrt(luminance(colour_of(scale, value)));
        EXPECT_GT(lightness, last);
        last = lightness;
    }
    EXPECT_EQ(colour_of(scale, 0.0), colour_of(scale, 100.0));
    EXPECT_EQ(colour_of(scale, 1e9), colour_of(scale, 900.0));
    EXPECT_NEAR(255.0f * srgb_from_linear(colour_of(scale, 500.0).y), 145.0f, 0.01f);  // the middle: #21918c
}

/// The walkthrough's scale (viewer/src/core/false_colour.ts) is held to the same table.
TEST(FalseColour, HasTheColoursOfTheTable) {
    std::ifstream table(FALSE_COLOUR_VALUES);
    ASSERT_TRUE(table) << FALSE_COLOUR_VALUES;
    std::string line;
    std::getline(table, line);
    ASSERT_EQ(line, "low,high,is_logarithmic,value,r_code,g_code,b_code");
    int rows = 0;
    while (std::getline(table, line)) {
        std::istringstream fields(line);
        std::array<double, 7> v{};
        for (double& value : v) {
            std::string field;
            std::getline(fields, field, ',');
            value = std::stod(field);
        }
        const Rgb colour = colour_of({v[0], v[1], v[2] == 1.0}, v[3]);
        // Linear and back in single precision: a hundredth of a code.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(255.0f * srgb_from_linear(colour[c]), v[4 + static_cast<std::size_t>(c)], 0.01) << line;
        ++rows;
    }
    EXPECT_GE(rows, 10);
}

TEST(FalseColour, TicksAreRound) {
    EXPECT_THAT(labels({0.0, 1.0, false}), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1"));
    EXPECT_THAT(labels({0.0, 120000.0, false}), ElementsAre("0", "20\u2009000", "40\u2009000", "60\u2009000",
                                                            "80\u2009000", "100\u2009000", "120\u2009000"));
    EXPECT_THAT(labels({1000.0, 100000.0, true}),
                ElementsAre("1000", "2000", "5000", "10\u2009000", "20\u2009000", "50\u2009000", "100\u2009000"));
    EXPECT_THAT(labels({1.0, 10000.0, true}), ElementsAre("1", "10", "100", "1000", "10\u2009000"));
    const std::vector<ScaleTick> ticks = ticks_of({1.0, 10000.0, true});
    EXPECT_NEAR(ticks[1].place, 0.25, 1e-12);
    EXPECT_NEAR(ticks[4].place, 1.0, 1e-12);
}

TEST(FalseColour, TheRangeLeavesOutTheBrightestHalfPercent) {
    Picture picture{{100, 10}, {}, {}};
    for (int i = 0; i < 1000; ++i) {
        picture.pixels.emplace_back(i < 997 ? static_cast<float>(i) : 1e6f);
        picture.coverage.push_back(1.0f);
    }
    EXPECT_EQ(range_of(picture).high, 1000.0);
    picture.coverage.assign(1000, 0.0f);
    EXPECT_EQ(range_of(picture).high, 1.0);
}

TEST(FalseColour, PartlyCoveredPixelsMixWithThePaper) {
    const Picture picture{{3, 1}, {Rgb(0.0f), Rgb(7.0f), Rgb(7.0f)}, {0.0f, 0.5f, 1.0f}};
    const Picture coloured = in_false_colours(picture, {0.0, 10.0, false});
    const Rgb mean = 0.5f * (coloured.pixels[0] + coloured.pixels[2]);
    EXPECT_LT(glm::length(coloured.pixels[1] - mean), 1e-6f);
}

}  // namespace
}  // namespace skybake
