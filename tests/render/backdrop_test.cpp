// The sky behind the city: energy of the sun's disc, the panorama's rows and columns, land and air.
#include "render/backdrop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skybake {
namespace {

Vec3f direction(double azimuth_deg, double elevation_deg) {
    const double a = radians_from_degrees(azimuth_deg), e = radians_from_degrees(elevation_deg);
    return Vec3f(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
}

const Vec3f kEye(0.0f, 0.0f, 10.0f);
const BackdropSun kNoSun{{0, 0, 1}, Rgb(0.0f), 0.00465f};

TEST(Backdrop, RowsAndColumnsStandWhereTheFormatSays) {
    Panorama panorama{8, 5, {}};
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 8; ++column) panorama.pixels.emplace_back(column, row, 1.0f);
    const Backdrop backdrop(panorama, kNoSun, {}, {});
    for (int row = 1; row < 4; ++row) {
        for (int column = 0; column < 8; ++column) {
            const Rgb value = backdrop.radiance(kEye, direction((column + 0.5) * 45.0, 90.0 - row * 22.5));
            EXPECT_NEAR(value.x, column, 1e-4f);
            EXPECT_NEAR(value.y, row, 1e-4f);
        }
    }
    EXPECT_NEAR(backdrop.radiance(kEye, direction(0.0, 45.0)).x, 3.5f, 1e-4f);  // the seam: half of 7 and of 0
    EXPECT_NEAR(backdrop.radiance(kEye, direction(90.0, 56.25)).y, 1.5f, 1e-4f);
}

TEST(Backdrop, TheDiscHoldsTheBeam) {
    BackdropSun sun{direction(120.0, 40.0), Rgb(90000.0f, 80000.0f, 60000.0f), 0.00465f};
    const Backdrop lit({4, 3, std::vector<Rgb>(12, Rgb(0.0f))}, sun, {}, {});
    // Within the disc the glow is a thousandth of the disc: 0.65 E against E / (π r²) = 14 700 E.
    const double solid_angle = kPi * 0.00465 * 0.00465;
    EXPECT_NEAR(lit.radiance(kEye, sun.direction).x * solid_angle, 90000.0, 90.0);
    const Rgb outside = lit.radiance(kEye, direction(120.0, 40.3));  // 0.0052 rad off
    EXPECT_LT(outside.x, 90000.0f * 0.65f);
    EXPECT_GT(outside.x, 0.0f);
}

TEST(Backdrop, BelowTheHorizonLiesTheLand) {
    const Backdrop backdrop({64, 128, std::vector<Rgb>(64 * 128, Rgb(2000.0f))}, kNoSun, {Rgb(500.0f), 3.0f}, {});
    EXPECT_EQ(backdrop.radiance(kEye, {0, 0, -1}), Rgb(500.0f));
    EXPECT_EQ(backdrop.radiance(kEye, direction(200.0, -0.001)), Rgb(500.0f));
    EXPECT_EQ(backdrop.radiance(kEye, direction(200.0, 0.001)), Rgb(2000.0f));
    EXPECT_EQ(backdrop.through_air(Rgb(7.0f), kEye, {0, 1, 0}, 1e5f), Rgb(7.0f));  // a vacuum
}

TEST(Backdrop, AirFadesLandAndHousesAsTheSkyLayerSays) {
    Air air;
    air.scattering = {Vec3d(6e-6, 9e-6, 19e-6), Vec3d(5e-5, 6e-5, 8e-5)};
    air.columns = 1;
    air.rows = 2;
    air.molecule_airlight = {Rgb(4000.0f), Rgb(3000.0f)};
    air.haze_airlight = {Rgb(9000.0f), Rgb(2000.0f)};
    const float ground = 30.0f;
    const Backdrop backdrop({4, 3, std::vector<Rgb>(12, Rgb(0.0f))}, kNoSun, {Rgb(500.0f), ground}, air);
    const Vec3f eye(0.0f, 0.0f, ground + 100.0f);
    const Vec3f down = direction(45.0, -5.0);
    const AerialView view = view_through(air, 100.0, Vec3d(down), 800.0);
    EXPECT_LT(glm::length(backdrop.through_air(Rgb(500.0f), eye, down, 800.0f) -
                          (500.0f * view.transmittance + view.inscatter)),
              0.1f);
    // Land lies 100 m below: 100 m / sin 5° away.
    const Rgb land = backdrop.radiance(eye, down);
    const Rgb wanted =
        backdrop.through_air(Rgb(500.0f), eye, down, 100.0f / std::sin(static_cast<float>(radians_from_degrees(5.0))));
    EXPECT_LT(glm::length(land - wanted), 0.1f);
    EXPECT_GT(land.z, 500.0f);  // brightened by airlight
}

TEST(Backdrop, NightHasNoDisc) {
    const Backdrop dark({4, 3, std::vector<Rgb>(12, Rgb(0.0f))}, {direction(0.0, 10.0), Rgb(0.0f), 0.0f}, {}, {});
    EXPECT_EQ(dark.radiance(kEye, direction(0.0, 10.0)), Rgb(0.0f));
    EXPECT_EQ(dark.radiance(kEye, {0, 0, -1}), Rgb(0.0f));
}

}  // namespace
}  // namespace skybake
