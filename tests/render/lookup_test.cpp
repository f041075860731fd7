// Lightmap pages and albedo textures: what their filters and mean levels give by definition.
#include <gtest/gtest.h>

#include "render/light_page.h"
#include "render/mip_texture.h"

namespace skybake {
namespace {

LightPage ramp(int width, int height) {
    std::vector<Rgb> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texels.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 7.0f);
    return {width, height, texels};
}

TEST(LightPage, ARampIsItsOwnPlaceAtBothLevels) {
    const LightPage page = ramp(16, 12);
    for (const float footprint : {0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 100.0f}) {
        for (const Vec2f& place : {Vec2f(2.0f, 3.0f), Vec2f(7.3f, 4.9f), Vec2f(14.0f, 10.0f)}) {
            const Rgb value = page.at(place, footprint);
            EXPECT_NEAR(value.x, place.x, 1e-5f);
            EXPECT_NEAR(value.y, place.y, 1e-5f);
            EXPECT_NEAR(value.z, 7.0f, 1e-5f);
        }
    }
}

TEST(LightPage, BeyondTheBorderStandsTheBorder) {
    const LightPage page = ramp(4, 4);
    const Rgb corner = page.at({-3.0f, 99.0f}, 0.0f);
    EXPECT_NEAR(corner.x, 0.5f, 1e-6f);
    EXPECT_NEAR(corner.y, 3.5f, 1e-6f);
    EXPECT_NEAR(corner.z, 7.0f, 1e-5f);
}

TEST(LightPage, AWideSampleSeesTheMeanOfTwoByTwo) {
    std::vector<Rgb> texels(16, Rgb(0.0f));
    for (const int lit : {0, 2, 8, 10}) texels[static_cast<std::size_t>(lit)] = Rgb(4.0f);
    const LightPage page(4, 4, texels);
    EXPECT_FLOAT_EQ(page.at({1.0f, 1.0f}, 2.0f).x, 1.0f);
    // At the first texel's centre: 5/6 of it in both directions, for beyond the border it stands again.
    const float fine = 4.0f * 25.0f / 36.0f;
    EXPECT_FLOAT_EQ(page.at({0.5f, 0.5f}, 1.0f).x, fine);
    // Half way between in the logarithm of the width: half of each. At (½, ½) the coarse level shows its first texel.
    EXPECT_NEAR(page.at({0.5f, 0.5f}, std::sqrt(2.0f)).x, 0.5f * (fine + 1.0f), 1e-5f);
}

TEST(LightPage, ALitTexelSpreadsAsTheCubicBSpline) {
    std::vector<Rgb> texels(81, Rgb(0.0f));
    texels[4 * 9 + 4] = Rgb(1.0f);
    const LightPage page(9, 9, texels);
    // B₃(d) = 2/3 − d² + |d|³/2 up to 1, (2 − |d|)³/6 up to 2, 0 beyond.
    const auto spline = [](float d) {
        const float a = std::abs(d);
        return a < 1.0f ? 2.0f / 3.0f - a * a + 0.5f * a * a * a : a < 2.0f ? std::pow(2.0f - a, 3.0f) / 6.0f : 0.0f;
    };
    for (const float dx : {-2.2f, -1.7f, -1.0f, -0.4f, 0.0f, 0.3f, 0.5f, 1.2f, 1.9f, 2.5f}) {
        for (const float dy : {-1.5f, 0.0f, 0.8f}) {
            EXPECT_NEAR(page.at({4.5f + dx, 4.5f + dy}, 0.3f).x, spline(dx) * spline(dy), 1e-6f);
        }
    }
    EXPECT_EQ(page.bilinear({4.5f, 4.5f}).x, 1.0f);
}

TEST(LightPage, TwoTexelsAboutAChartKeepItsNeighbourOut) {
    // A chart of 4 × 4 texels with its gutter; beyond it a neighbour of a thousand times the light.
    std::vector<Rgb> texels(144, Rgb(1000.0f));
    for (std::size_t y = 2; y < 10; ++y)
        for (std::size_t x = 2; x < 10; ++x) texels[y * 12 + x] = Rgb(1.0f);
    const LightPage page(12, 12, texels);
    for (float x = 4.0f; x <= 8.0f; x += 0.125f) {
        for (const float footprint : {0.1f, 1.0f, 1.4f, 3.0f}) {
            for (const Vec2f& place : {Vec2f(x, 4.0f), Vec2f(x, 8.0f), Vec2f(4.0f, x), Vec2f(8.0f, x), Vec2f(x, 5.3f)})
                EXPECT_NEAR(page.at(place, footprint).x, 1.0f, 1e-4f);
        }
    }
    EXPECT_NEAR(page.at({3.5f, 6.0f}, 0.1f).x, 1.0f, 1e-4f);  // it holds for half a texel more
    EXPECT_GT(page.at({3.4f, 6.0f}, 0.1f).x, 1.01f);
}

TEST(LightPage, OneTexelIsAWholePage) {
    const LightPage page(1, 1, {Rgb(3.0f)});
    EXPECT_EQ(page.at({0.2f, 0.9f}, 1.7f), Rgb(3.0f));
}

TEST(MipTexture, AFarCheckerboardIsTheMeanOfItsLight) {
    AlbedoImage image{8, 8, {}};
    for (int i = 0; i < 64; ++i) {
        const std::uint8_t code = (i % 8 + i / 8) % 2 == 0 ? 255 : 0;
        image.pixels.push_back({code, code, code});
    }
    const MipTexture texture(image);
    // Half the light, as its nearest 8-bit code holds it: 188, not the 128 of averaged codes.
    EXPECT_NEAR(texture.at({0.3f, 0.3f}, Vec2f(1.0f), TextureWrap::repeat).x, 0.5f, 0.004f);
    EXPECT_NEAR(texture.at({0.0f, 0.0f}, Vec2f(0.25f), TextureWrap::repeat).x, 0.5f, 0.004f);
    EXPECT_EQ(texture.at({0.5f / 8.0f, 0.5f / 8.0f}, Vec2f(0.0f), TextureWrap::repeat).x, 0.0f);  // lower left is odd
    EXPECT_EQ(texture.at({0.5f / 8.0f, 7.5f / 8.0f}, Vec2f(0.0f), TextureWrap::repeat).x, 1.0f);
}

TEST(MipTexture, OddSidesKeepAnEvenColour) {
    const AlbedoImage image{5, 3, std::vector<std::array<std::uint8_t, 3>>(15, {10, 200, 90})};
    const MipTexture texture(image);
    for (const float width : {0.0f, 0.3f, 0.7f, 5.0f}) {
        const Rgb value = texture.at({0.4f, 0.1f}, Vec2f(width), TextureWrap::clamp);
        EXPECT_NEAR(value.y, linear_from_srgb(200.0f / 255.0f), 1e-6f);
    }
}

}  // namespace
}  // namespace skybake
