// Pictures of one card whose light and albedo are known: L = ρ E / π, areas by geometry, the same bits for any threads.
#include "render/render_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/threads.h"

namespace skybake {
namespace {

constexpr float kSky = 3000.0f;

/// A card 4 m × 4 m in the plane y = 0 that faces south, under an even sky without sun.
struct Card {
    PictureScene scene;
    SurfaceLight light;
    Backdrop backdrop{{8, 5, std::vector<Rgb>(40, Rgb(kSky))}, {{0, 0, 1}, Rgb(0.0f), 0.005f}, {}, {}};

    Card() {
        const std::array<Vec3f, 4> corners = {Vec3f(-2, 0, -2), {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}};
        const std::array<Vec2f, 4> uvs = {Vec2f(0, 0), {1, 0}, {1, 1}, {0, 1}};
        for (const auto& [i, j, k] : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
            scene.triangles.push_back({corners[i], corners[j], corners[k]});
            PictureSurface surface;
            surface.albedo_uv = {uvs[i], uvs[j], uvs[k]};
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec2f uv = surface.albedo_uv[c];
                surface.texel[c] = Vec2f(2.0f + 8.0f * uv.x, 2.0f + 8.0f * (1.0f - uv.y));
            }
            scene.surfaces.push_back(surface);
        }
        for (const Vec3f& corner : corners) scene.bounds.extend(corner);
        scene.materials.push_back({Rgb(0.5f, 0.25f, 1.0f), {}, TextureWrap::repeat});
        std::vector<Rgb> texels;  // from west to east 1000, 2000, … lx at the texels' centres
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) texels.emplace_back(1000.0f * (static_cast<float>(x) - 1.0f));
        light.emplace_back(12, 12, texels);
    }
    Picture take(const PictureSettings& settings) const {
        SilentProgress progress;
        return render_picture(scene, RayScene(scene.triangles), light, backdrop, settings, progress);
    }
};

PictureSettings from_south(PictureKind kind, Vec2i size = {8, 8}, float width = 4.0f) {
    PictureSettings settings;
    settings.size = size;
    settings.kind = kind;
    settings.camera = orthographic_camera({0, -5, 0}, {0, 0, 0}, width, 5.0f, size);
    return settings;
}

TEST(RenderPicture, RadianceIsAlbedoTimesLightOverPi) {
    const Card card;
    const Picture picture = card.take(from_south(PictureKind::lit));
    for (int row = 0; row < 8; ++row) {
        for (int column = 1; column < 7; ++column) {
            // A pixel is a texel; the linear filter is exact on the ramp, and its mean over the pixel is its centre's.
            const Rgb expected =
                Rgb(0.5f, 0.25f, 1.0f) * 1000.0f * (static_cast<float>(column) + 1.0f) / static_cast<float>(kPi);
            const Rgb got = picture.pixels[static_cast<std::size_t>(8 * row + column)];
            EXPECT_NEAR(got.x / expected.x, 1.0f, 1e-5f);
            EXPECT_NEAR(got.y / expected.y, 1.0f, 1e-5f);
            EXPECT_NEAR(got.z / expected.z, 1.0f, 1e-5f);
        }
    }
}

TEST(RenderPicture, KindsShowAlbedoLightOrTheMeasure) {
    const Card card;
    const std::size_t pixel = 8 * 4 + 2;
    EXPECT_NEAR(card.take(from_south(PictureKind::textures)).pixels[pixel].y, 0.25f, 1e-6f);
    EXPECT_NEAR(card.take(from_south(PictureKind::light)).pixels[pixel].y, 3000.0f / static_cast<float>(kPi), 0.1f);
    EXPECT_NEAR(card.take(from_south(PictureKind::illuminance)).pixels[pixel].y, 3000.0f, 0.1f);
}

TEST(RenderPicture, ExposureToneMapsEachSample) {
    const Card card;
    PictureSettings settings = from_south(PictureKind::lit, {8, 8}, 400.0f);  // the card is a fraction of one pixel
    settings.exposure = 1e-4f;
    const Picture picture = card.take(settings);
    EXPECT_EQ(picture.pixels[0], agx_tone_mapped(Rgb(1e-4f * kSky)));
    const Picture card_alone = card.take([] {
        PictureSettings near = from_south(PictureKind::lit);
        near.exposure = 1e-4f;
        return near;
    }());
    const Rgb expected = agx_tone_mapped(1e-4f * Rgb(0.5f, 0.25f, 1.0f) * 4000.0f / static_cast<float>(kPi));
    // Across the pixel the light runs from 3500 to 4500 lx, over which the curve bends a little.
    EXPECT_NEAR(card_alone.pixels[8 * 4 + 3].y, expected.y, 2e-3f);
}

TEST(RenderPicture, EdgesAreCoveredByTheirArea) {
    const Card card;
    PictureSettings settings = from_south(PictureKind::illuminance, {40, 40}, 8.1f);
    settings.camera.up = glm::normalize(Vec3f(0.3f, 0.0f, 1.0f));  // tilted: edges cut pixels everywhere
    settings.camera.right = glm::cross(settings.camera.forward, settings.camera.up);
    const Picture picture = card.take(settings);
    double area = 0.0;
    for (const float share : picture.coverage) {
        EXPECT_EQ(share * 16.0f, std::round(share * 16.0f));
        area += share;
    }
    const double pixel_m2 = (8.1 / 40.0) * (8.1 / 40.0);
    // 16 points a pixel on some 80 border pixels: 1/√12/4 of a pixel each, were they random: 0.65 pixels in all.
    EXPECT_NEAR(area, 16.0 / pixel_m2, 2.0);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (picture.coverage[i] == 0.0f) {
            EXPECT_EQ(picture.pixels[i], Rgb(0.0f));
        }
    }
}

TEST(RenderPicture, TheSamplesFilterAFineTexture) {
    Card card;
    AlbedoImage checks{256, 256, {}};
    for (int i = 0; i < 256 * 256; ++i) {
        const std::uint8_t code = (i % 256 + i / 256) % 2 == 0 ? 255 : 0;
        checks.pixels.push_back({code, code, code});
    }
    card.scene.textures.emplace_back(checks);
    card.scene.materials[0] = {Rgb(1.0f), 0, TextureWrap::repeat};
    const Picture picture = card.take(from_south(PictureKind::textures));        // 32 pixels of the texture in one
    for (const Rgb& pixel : picture.pixels) EXPECT_NEAR(pixel.x, 0.5f, 0.004f);  // the code nearest to one half
}

TEST(RenderPicture, TheSameBitsForAnyNumberOfThreads) {
    const Card card;
    PictureSettings settings = from_south(PictureKind::lit, {100, 70}, 6.0f);
    settings.exposure = 1e-4f;
    std::vector<Picture> pictures;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        pictures.push_back(card.take(settings));
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
    EXPECT_EQ(pictures[0].pixels, pictures[2].pixels);
    EXPECT_EQ(screen_bytes(pictures[0], PictureKind::lit), screen_bytes(pictures[2], PictureKind::lit));
}

TEST(RenderPicture, StopsWhenAsked) {
    struct Stop final : Progress {
        void begin(std::string_view, std::uint64_t) override {}
        void advance(std::uint64_t) override {}
        bool stop_requested() const override { return true; }
    } stop;
    const Card card;
    EXPECT_THROW(render_picture(card.scene, RayScene(card.scene.triangles), card.light, card.backdrop,
                                from_south(PictureKind::lit), stop),
                 Interrupted);
}

}  // namespace
}  // namespace skybake
