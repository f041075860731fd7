// The sky behind the city: energy of the sun's disc, the panorama's rows and columns, the far land's brightness.
#include "render/backdrop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skybake {
namespace {

Vec3f direction(double azimuth_deg, double elevation_deg) {
    const double a = radians_from_degrees(azimuth_deg), e = radians_from_degrees(elevation_deg);
    return Vec3f(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
}

const BackdropSun kNoSun{{0, 0, 1}, Rgb(0.0f), 0.00465f};

TEST(Backdrop, RowsAndColumnsStandWhereTheFormatSays) {
    Panorama panorama{8, 5, {}};
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 8; ++column) panorama.pixels.emplace_back(column, row, 1.0f);
    const Backdrop backdrop(panorama, kNoSun);
    for (int row = 1; row < 5; ++row) {
        for (int column = 0; column < 8; ++column) {
            const Rgb value = backdrop.radiance(direction((column + 0.5) * 45.0, 90.0 - row * 22.5));
            EXPECT_NEAR(value.x, column, 1e-4f);
            EXPECT_NEAR(value.y, row, 1e-4f);
        }
    }
    EXPECT_NEAR(backdrop.radiance(direction(0.0, 45.0)).x, 3.5f, 1e-4f);  // the seam: half of 7 and of 0
    EXPECT_NEAR(backdrop.radiance(direction(90.0, 56.25)).y, 1.5f, 1e-4f);
}

TEST(Backdrop, TheDiscHoldsTheBeam) {
    BackdropSun sun{direction(120.0, 40.0), Rgb(90000.0f, 80000.0f, 60000.0f), 0.00465f};
    const Backdrop lit({4, 3, std::vector<Rgb>(12, Rgb(0.0f))}, sun);
    // Within the disc the glow is a thousandth of the disc: 0.65 E against E / (π r²) = 14 700 E.
    const double solid_angle = kPi * 0.00465 * 0.00465;
    EXPECT_NEAR(lit.radiance(sun.direction).x * solid_angle, 90000.0, 90.0);
    const Rgb outside = lit.radiance(direction(120.0, 40.3));  // 0.0052 rad off
    EXPECT_LT(outside.x, 90000.0f * 0.65f);
    EXPECT_GT(outside.x, 0.0f);
}

TEST(Backdrop, FarLandReflectsItsShareOfSunAndSky) {
    const BackdropSun sun{direction(0.0, 30.0), Rgb(50000.0f), 0.00465f};
    const Backdrop backdrop({64, 128, std::vector<Rgb>(64 * 128, Rgb(2000.0f))}, sun);
    // E = π L + sin 30° · 50 000 lx; L = ρ E / π with ρ = 0.22 in red. Far below the horizon no haze is left.
    const double expected = 0.22 / kPi * (kPi * 2000.0 + 25000.0);
    EXPECT_NEAR(backdrop.radiance({0, 0, -1}).x, expected, 1e-3 * expected);    // the sum over 128 rows: 5e-5
    EXPECT_NEAR(backdrop.radiance(direction(200.0, -0.001)).x, 2000.0f, 2.0f);  // at the horizon there is only haze
}

TEST(Backdrop, NightHasNoDisc) {
    const Backdrop dark({4, 3, std::vector<Rgb>(12, Rgb(0.0f))}, {direction(0.0, 10.0), Rgb(0.0f), 0.0f});
    EXPECT_EQ(dark.radiance(direction(0.0, 10.0)), Rgb(0.0f));
    EXPECT_EQ(dark.radiance({0, 0, -1}), Rgb(0.0f));
}

}  // namespace
}  // namespace skybake
