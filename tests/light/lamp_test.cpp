// Lamps in closed form: inverse square, cosine, cone, flux, colour.
#include "light/lamp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/point_light.h"
#include "vessels.h"

namespace skybake {
namespace {

TEST(LampLight, FollowsInverseSquareAndCosine) {
    const Lamp lamp = point_lamp({0, 0, 5}, 1000.0f);
    for (const float x : {0.0f, 1.0f, 3.0f, 12.0f}) {
        const float r2 = 25.0f + x * x;
        EXPECT_NEAR(luminance(unobstructed_irradiance(lamp, {x, 0, 0}, {0, 0, 1})), 1000.0f * 5.0f / std::pow(r2, 1.5f),
                    1e-3f);
    }
    EXPECT_EQ(unobstructed_irradiance(lamp, {0, 0, 6}, {0, 0, 1}), Rgb(0));
}

TEST(LampLight, StandsInShadows) {
    const Scene scene = QuadScene().ground(20).box({1, -1, 0}, {2, 1, 3}).scene();
    const RayScene rays(scene);
    const std::vector<Lamp> lamps{point_lamp({0, 0, 2}, 100.0f), point_lamp({8, 0, 2}, 50.0f)};
    const std::vector<ReceiverPoint> points{{{4, 0, 0}, {0, 0, 1}}, {{-1, 0, 0}, {0, 0, 1}}};
    const std::vector<Rgb> light = light_points_by_lamps(points, lamps, rays);
    EXPECT_NEAR(luminance(light[0]), 50.0f * 2.0f / std::pow(20.0f, 1.5f), 1e-4f);  // only the lamp on its side
    EXPECT_NEAR(luminance(light[1]), 100.0f * 2.0f / std::pow(5.0f, 1.5f), 1e-4f);
}

TEST(LampLight, SpotHasItsConeAndItsFlux) {
    Lamp spot{"s", Lamp::Type::spot, {0, 0, 4}, Rgb(1.0f), {0, 0, -1}, 0.5f, 0.0f};
    EXPECT_EQ(intensity_share(spot, glm::normalize(Vec3f(std::tan(0.49f), 0, -1))), 1.0f);
    EXPECT_EQ(intensity_share(spot, glm::normalize(Vec3f(std::tan(0.51f), 0, -1))), 0.0f);
    EXPECT_NEAR(effective_solid_angle(spot), 2.0 * kPi * (1.0 - std::cos(0.5)), 1e-6);
    spot.blend_rad = 0.2f;
    EXPECT_NEAR(intensity_share(spot, glm::normalize(Vec3f(std::tan(0.4f), 0, -1))), 0.5f, 1e-4f);
    // The flux on a fine grid of the plane below is intensity times solid angle.
    double flux = 0.0;
    constexpr double kStep = 0.01;
    for (double x = -3.0; x < 3.0; x += kStep) {
        for (double y = -3.0; y < 3.0; y += kStep) {
            flux += kStep * kStep *
                    static_cast<double>(
                        unobstructed_irradiance(spot, Vec3f(Vec3d(x + kStep / 2, y + kStep / 2, 0)), {0, 0, 1}).x);
        }
    }
    EXPECT_NEAR(flux / effective_solid_angle(spot), 1.0, 1e-3);
}

/// CIE 15: illuminant A is a black body of 2856 K with x = 0.4476, y = 0.4074.
TEST(BlackBody, IsIlluminantA) {
    const Rgb a = black_body_colour(2856.0);
    EXPECT_NEAR(luminance(a), 1.0f, 1e-5f);
    // Rec. 709 of x = 0.4476, y = 0.4074, Y = 1 by the matrix of IEC 61966-2-1.
    EXPECT_NEAR(a.x, 1.8456f, 0.01f);
    EXPECT_NEAR(a.y, 0.8259f, 0.01f);
    EXPECT_NEAR(a.z, 0.2334f, 0.01f);
    EXPECT_LT(black_body_colour(10000.0).x, black_body_colour(10000.0).z);
}

}  // namespace
}  // namespace skybake
