// Pages painted with light: each pixel is what `skybake render` shows of that place, edges go on into the gutter.
#include "render/lit_page.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skybake {
namespace {

constexpr float kExposure = 2e-4f;

/// A square of 8 × 8 texels at (2, 2) of a page of 12 × 12, red on the left half of its texture, blue on the right.
struct Square {
    PictureScene scene;
    LightPage light;

    Square() : light(12, 12, texels()) {
        const std::array<Vec2f, 4> uvs = {Vec2f(0, 0), {1, 0}, {1, 1}, {0, 1}};
        for (const auto& [i, j, k] : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
            PictureSurface surface;
            surface.albedo_uv = {uvs[i], uvs[j], uvs[k]};
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec2f uv = surface.albedo_uv[c];
                surface.texel[c] = Vec2f(2.0f + 8.0f * uv.x, 2.0f + 8.0f * (1.0f - uv.y));
            }
            scene.surfaces.push_back(surface);
        }
        scene.textures.emplace_back(AlbedoImage{2, 1, {{255, 0, 0}, {0, 0, 255}}});
        scene.materials.push_back({Rgb(0.8f), 0u, TextureWrap::clamp});
    }
    /// From west to east 1000, 2000, … lx at the texels' centres.
    static std::vector<Rgb> texels() {
        std::vector<Rgb> all;
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) all.emplace_back(1000.0f * (static_cast<float>(x) - 1.0f));
        return all;
    }
};

std::array<int, 3> pixel(const std::vector<std::uint8_t>& pixels, int width, int x, int y) {
    const std::size_t at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {pixels[at], pixels[at + 1], pixels[at + 2]};
}

TEST(LitPage, APixelIsAlbedoTimesLightAsItIsShown) {
    const Square square;
    for (const int detail : {1, 3}) {
        const std::vector<std::uint8_t> page =
            lit_page(square.scene, square.light, 0, {12, 12}, {detail, PictureKind::light, kExposure});
        ASSERT_EQ(page.size(), static_cast<std::size_t>(3 * 144 * detail * detail));
        for (int x = 2 * detail; x < 10 * detail; ++x) {
            const float texel = (static_cast<float>(x) + 0.5f) / static_cast<float>(detail);
            const float lux = 1000.0f * (texel - 1.5f);  // linear between the centres
            const Rgb shown = agx_tone_mapped(Rgb(kExposure * lux / static_cast<float>(kPi)));
            for (int c = 0; c < 3; ++c)  // half a step of rounding and half a step of dither
                EXPECT_NEAR(pixel(page, 12 * detail, x, 5 * detail)[static_cast<std::size_t>(c)],
                            255.0f * srgb_from_linear(shown[c]), 1.01f);
        }
    }
}

TEST(LitPage, TexturesLieTheRightWayRound) {
    const Square square;
    const std::vector<std::uint8_t> page =
        lit_page(square.scene, square.light, 0, {12, 12}, {2, PictureKind::lit, 1e-3f});
    const auto left = pixel(page, 24, 5, 12), right = pixel(page, 24, 18, 12);
    EXPECT_GT(left[0], left[2] + 40);
    EXPECT_GT(right[2], right[0] + 40);
}

TEST(LitPage, EdgesGoOnIntoTheGutterAndNoFarther) {
    Square square;
    for (PictureSurface& surface : square.scene.surfaces)
        for (Vec2f& texel : surface.texel) texel += Vec2f(2.0f, 2.0f);  // on a larger page, clear of its borders
    const LightPage light(16, 16, std::vector<Rgb>(256, Rgb(5000.0f)));
    const int detail = 2;
    const std::vector<std::uint8_t> page =
        lit_page(square.scene, light, 0, {16, 16}, {detail, PictureKind::light, kExposure});
    const auto inside = pixel(page, 32, 8, 16);
    for (int x = 4; x < 8; ++x) EXPECT_EQ(pixel(page, 32, x, 16), inside) << x;  // two texels of gutter
    EXPECT_EQ(pixel(page, 32, 3, 16), (std::array<int, 3>{0, 0, 0}));
}

TEST(LitPage, TrianglesThinnerThanAPixelAreSeen) {
    Square square;
    square.scene.surfaces.resize(1);
    square.scene.surfaces[0].texel = {Vec2f(5.1f, 2.0f), Vec2f(5.2f, 2.0f), Vec2f(5.15f, 2.3f)};
    const std::vector<std::uint8_t> page =
        lit_page(square.scene, square.light, 0, {12, 12}, {1, PictureKind::light, kExposure});
    EXPECT_GT(pixel(page, 12, 5, 2)[0], 0);
}

TEST(LitPage, OtherPagesAreLeftAlone) {
    const Square square;
    const std::vector<std::uint8_t> page =
        lit_page(square.scene, square.light, 1, {12, 12}, {1, PictureKind::lit, kExposure});
    EXPECT_EQ(page, std::vector<std::uint8_t>(3 * 144, 0));
}

}  // namespace
}  // namespace skybake
