// Exposure, tone mapping and sRGB against display_values.csv: pixels that the walkthrough's own shader drew in Chromium
// (viewer/test/browser/display.test.ts measures them again, so that both sides stand by one table).
#include "render/display.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace skybake {
namespace {

TEST(Display, GivesTheWalkthroughsPixels) {
    std::ifstream table(DISPLAY_VALUES);
    ASSERT_TRUE(table) << DISPLAY_VALUES;
    std::string line;
    std::getline(table, line);
    ASSERT_EQ(line, "picture,hint_m2_per_kcd,ev,r_kcd_m2,g_kcd_m2,b_kcd_m2,r_code,g_code,b_code");
    const std::map<std::string, PictureKind> kinds = {{"lit", PictureKind::lit}, {"light", PictureKind::light}};
    int rows = 0;
    while (std::getline(table, line)) {
        std::istringstream fields(line);
        std::string field;
        std::getline(fields, field, ',');
        const PictureKind kind = kinds.at(field);
        std::array<float, 8> v{};
        for (float& value : v) {
            ASSERT_TRUE(std::getline(fields, field, ',')) << line;
            value = std::stof(field);
        }
        const float factor = exposure_factor(v[0], v[1], kind);
        const Rgb display = agx_tone_mapped(factor * 1e3f * Rgb(v[2], v[3], v[4]));
        for (int c = 0; c < 3; ++c) {
            // The measured code is a mean over 256 dithered pixels: half a code of rounding cancels to a tenth, and the
            // lightmap's own 8 bit are not in it (the card's texels are its brightest).
            EXPECT_NEAR(255.0f * srgb_from_linear(display[c]), v[static_cast<std::size_t>(5 + c)], 0.5f)
                << line << ", channel " << c;
        }
        ++rows;
    }
    EXPECT_GE(rows, 20);
}

TEST(Display, OneStopDoublesAndTheLightAloneIsDarker) {
    EXPECT_FLOAT_EQ(exposure_factor(0.2f, 1.0f, PictureKind::lit),
                    2.0f * exposure_factor(0.2f, 0.0f, PictureKind::lit));
    EXPECT_FLOAT_EQ(exposure_factor(0.2f, 0.0f, PictureKind::light), exposure_factor(0.2f, -1.2f, PictureKind::lit));
}

TEST(Display, GreyStaysGreyAndGrows) {
    float last = -1.0f;
    for (float exposed = 1e-3f; exposed < 64.0f; exposed *= 1.3f) {
        const Rgb display = agx_tone_mapped(Rgb(exposed));
        // The matrices are printed with four digits: their rows miss one by up to 2e-4.
        EXPECT_NEAR(display.x, display.y, 2e-3f);
        EXPECT_NEAR(display.y, display.z, 2e-3f);
        EXPECT_GE(display.y, last);
        last = display.y;
    }
    EXPECT_GT(last, 0.95f);
    EXPECT_EQ(agx_tone_mapped(Rgb(0.0f)), Rgb(0.0f));
}

TEST(Display, DitherKeepsTheMeanAndStaysWithinAStep) {
    const float linear = linear_from_srgb(100.3f / 255.0f);
    double sum = 0.0;
    for (int row = 0; row < 64; ++row) {
        for (int column = 0; column < 64; ++column) {
            const std::uint8_t code = dithered_srgb(linear, column, row);
            EXPECT_TRUE(code == 100 || code == 101);
            sum += code;
        }
    }
    EXPECT_NEAR(sum / 4096.0, 100.3, 0.02);  // measured 0.003
    EXPECT_EQ(dithered_srgb(0.0f, 3, 5), 0);
    EXPECT_EQ(dithered_srgb(1.0f, 3, 5), 255);
}

}  // namespace
}  // namespace skybake
