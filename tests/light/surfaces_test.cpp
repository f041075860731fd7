// Albedo at a hit: the texture where the ray meets it.
#include "light/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/scenes.h"
#include "base/hash_rng.h"

namespace skybake {
namespace {

/// 2 × 2 pixels: red, green above; blue, white below.
AlbedoImage four_colours() {
    return {2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}};
}

TEST(AlbedoAt, TextureCoordinatesBeginLowerLeft) {
    const AlbedoImage image = four_colours();
    EXPECT_EQ(albedo_at(image, {0.25f, 0.25f}, TextureWrap::clamp, Rgb(0)), Rgb(0, 0, 1));
    EXPECT_EQ(albedo_at(image, {0.75f, 0.25f}, TextureWrap::clamp, Rgb(0)), Rgb(1, 1, 1));
    EXPECT_EQ(albedo_at(image, {0.25f, 0.75f}, TextureWrap::clamp, Rgb(0)), Rgb(1, 0, 0));
}

TEST(AlbedoAt, IsLinearBetweenThePixels) {
    const AlbedoImage image{2, 1, {{0, 0, 0}, {188, 188, 188}}};
    const float bright = linear_from_srgb(188.0f / 255.0f);
    EXPECT_NEAR(albedo_at(image, {0.5f, 0.5f}, TextureWrap::clamp, Rgb(0)).x, 0.5f * bright, 1e-6f);
}

TEST(AlbedoAt, WrapsAsTold) {
    const AlbedoImage image{2, 1, {{0, 0, 0}, {255, 255, 255}}};
    const Rgb border(0.3f);
    EXPECT_NEAR(albedo_at(image, {1.25f, 0.5f}, TextureWrap::repeat, border).x, 0.0f, 1e-6f);
    EXPECT_NEAR(albedo_at(image, {1.25f, 0.5f}, TextureWrap::mirror, border).x, 1.0f, 1e-6f);
    EXPECT_NEAR(albedo_at(image, {-0.25f, 0.5f}, TextureWrap::mirror, border).x, 0.0f, 1e-6f);
    EXPECT_NEAR(albedo_at(image, {1.25f, 0.5f}, TextureWrap::clamp, border).x, 1.0f, 1e-6f);
    EXPECT_NEAR(albedo_at(image, {1.75f, 0.5f}, TextureWrap::border, border).x, 0.3f, 1e-6f);
    EXPECT_NEAR(albedo_at(image, {std::nanf(""), 0.5f}, TextureWrap::repeat, border).x, 0.5f, 1e-6f);
}

TEST(AlbedoAt, AMissingPictureIsGrey) {
    EXPECT_EQ(albedo_at({}, {0.5f, 0.5f}, TextureWrap::repeat, Rgb(0)), Rgb(kAlbedoWithoutTexture));
}

TEST(SurfacePoint, TakesTheTextureAtTheHitAndTheSideOfTheRay) {
    Scene scene = QuadScene().ground(10).scene();
    scene.materials[0] = {"picture", Rgb(1.0f), TextureId(std::size_t{0}), TextureWrap::clamp};
    scene.textures.emplace_back();
    scene.albedo_images = {four_colours()};
    for (std::size_t t = 0; t < 2; ++t) {
        for (int k = 0; k < 3; ++k) scene.triangle_uvs[t][k] = (Vec2f(scene.triangles[t][k]) + 10.0f) / 20.0f;
    }
    const RayScene rays(scene);
    const auto above = rays.first_hit({-5, -5, 3}, {0, 0, -1});
    ASSERT_TRUE(above);
    const SurfacePoint point = surface_point(scene, *above);
    EXPECT_NEAR(glm::length(point.position - Vec3f(-5, -5, 0)), 0.0f, 1e-5f);
    EXPECT_EQ(point.normal, Vec3f(0, 0, 1));
    EXPECT_NEAR(glm::length(point.albedo - Rgb(0, 0, 1)), 0.0f, 1e-4f);
    const auto below = rays.first_hit({5, -5, -3}, {0, 0, 1});
    ASSERT_TRUE(below);
    EXPECT_EQ(surface_point(scene, *below).normal, Vec3f(0, 0, -1));
    EXPECT_NEAR(glm::length(surface_point(scene, *below).albedo - Rgb(1, 1, 1)), 0.0f, 1e-4f);
}

/// Mean of the direction: 2/3 along the normal, and nothing aside; second moment of the cosine: 1/2.
TEST(CosineHemisphere, HasTheCosinesMoments) {
    const Vec3f normal = glm::normalize(Vec3f(0.3f, -0.5f, -0.8f));
    Vec3d mean(0.0);
    double square = 0.0;
    constexpr int kCount = 200000;
    for (int i = 0; i < kCount; ++i) {
        RandomSequence random(1, 2, static_cast<std::uint64_t>(i));
        const float u = random.next(), v = random.next();
        const Vec3f d = square_to_cosine_hemisphere(normal, u, v);
        ASSERT_NEAR(glm::length(d), 1.0f, 1e-5f);
        mean += Vec3d(d) / static_cast<double>(kCount);
        square += std::pow(static_cast<double>(glm::dot(d, normal)), 2.0) / kCount;
    }
    // Four standard errors: each component's variance is at most 1/4, that of the squared cosine 1/12.
    EXPECT_LT(glm::length(mean - Vec3d(normal) * (2.0 / 3.0)), 4.0 * std::sqrt(0.75 / kCount));
    EXPECT_NEAR(square, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kCount));
}

}  // namespace
}  // namespace skybake
