#include "sky/preetham.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sky/daylight.h"
#include "sky/reference_table.h"
#include "sky/sky_panorama.h"
#include "sky/solar_position.h"
#include "test_data.h"

namespace skybake {
namespace {

constexpr double kSunAzimuth = 1.1;  // any: the model turns with the sun

Vec3d direction(double zenith_deg, double rel_azimuth_deg) {
    return world_direction(kSunAzimuth + radians_from_degrees(rel_azimuth_deg), radians_from_degrees(90.0 - zenith_deg),
                           0.0);
}

void expect_colour(const PreethamSky& sky, const Vec3d& view, double kilo_luminance, double x, double y) {
    const Xyz xyz = sky_xyz(sky, view);
    const double sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.y / 1000.0, kilo_luminance, 1e-6 * kilo_luminance);
    EXPECT_NEAR(xyz.x / sum, x, 1e-6);
    EXPECT_NEAR(xyz.y / sum, y, 1e-6);
}

// Truth: the authors' own five-digit program (as ported to Mitsuba). Where the paper's zenith luminance is negative we
// are black instead.
TEST(Preetham, ZenithIsThatOfTheAuthorsProgram) {
    const auto path = test_data("reference/preetham_zenith.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 30u);
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id"));
        const PreethamSky sky = preetham_sky(row.number("turbidity"), direction(row.number("sun_zenith_deg"), 0.0));
        ASSERT_LE(row.number("turbidity"), kPreethamMostTurbidity);
        expect_colour(sky, {0.0, 0.0, 1.0}, std::max(row.number("Yz_kcd_m2_utah"), 0.0), row.number("xz_utah"),
                      row.number("yz_utah"));
    }
}

TEST(Preetham, SkyIsThatOfTheAuthorsProgram) {
    const auto path = test_data("reference/preetham_sky.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 60u);
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id"));
        const PreethamSky sky = preetham_sky(row.number("turbidity"), direction(row.number("sun_zenith_deg"), 0.0));
        expect_colour(sky, direction(row.number("view_zenith_deg"), row.number("rel_azimuth_deg")),
                      row.number("Y_kcd_m2_utah"), row.number("x_utah"), row.number("y_utah"));
    }
}

// Truth: quadrature of the authors' function with 120 × 180 points.
TEST(Preetham, IntegralsAgreeWithTheReference) {
    const auto path = test_data("reference/preetham_integrals.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 20u);
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id"));
        const PreethamSky sky = preetham_sky(row.number("turbidity"), direction(row.number("sun_zenith_deg"), 0.0));
        const double expected = row.number("Eh_diffuse_lux");
        EXPECT_NEAR(horizontal_illuminance(sky), expected, 5e-4 * expected);
        EXPECT_NEAR(luminance(horizontal_diffuse(sky).illuminance), expected, 6e-4 * expected);
        // Vertical planes: the cosine about the plane's normal, midpoint rule over the dome.
        const double facing[3] = {0.0, 90.0, 180.0};
        const char* columns[3] = {"Ev_facing_sun_lux", "Ev_perpendicular_lux", "Ev_opposite_lux"};
        for (int plane = 0; plane < 3; ++plane) {
            const Vec3d normal = direction(90.0, facing[plane]);
            double sum = 0.0;
            constexpr int kRings = 120;
            constexpr int kSectors = 180;
            for (int ring = 0; ring < kRings; ++ring) {
                const double zenith_deg = 90.0 * (ring + 0.5) / kRings;
                for (int sector = 0; sector < kSectors; ++sector) {
                    const Vec3d view = direction(zenith_deg, 360.0 * (sector + 0.5) / kSectors);
                    sum += sky_xyz(sky, view).y * std::max(0.0, glm::dot(view, normal)) *
                           std::sin(radians_from_degrees(zenith_deg));
                }
            }
            const double illuminance = sum * (kPi / 2.0 / kRings) * (2.0 * kPi / kSectors);
            EXPECT_NEAR(illuminance, row.number(columns[plane]), 5e-4 * row.number(columns[plane])) << columns[plane];
        }
    }
}

// Truth: by definition of the level.
TEST(Preetham, ScalingSetsTheHorizontalIlluminance) {
    for (const double zenith_deg : {0.0, 45.0, 89.0}) {
        const PreethamSky published = preetham_sky(3.0, direction(zenith_deg, 0.0));
        const PreethamSky scaled = scaled_to(published, 12345.0);
        EXPECT_NEAR(horizontal_illuminance(scaled), 12345.0, 1e-6);
        const Xyz a = sky_xyz(published, direction(70.0, 40.0));
        const Xyz b = sky_xyz(scaled, direction(70.0, 40.0));
        EXPECT_NEAR(a.x / a.y, b.x / b.y, 1e-12) << "the colour stays";
    }
}

// Truth: the contract of sky_luminance, over every turbidity that is accepted and every sun, also below the horizon.
TEST(Preetham, IsFiniteAndNeverNegativeAnywhere) {
    for (double turbidity = 1.0; turbidity <= 60.0; turbidity += turbidity < 16.0 ? 0.25 : 4.0) {
        for (double sun_zenith = 0.0; sun_zenith <= 180.0; sun_zenith += 7.5) {
            const PreethamSky published = preetham_sky(turbidity, direction(sun_zenith, 0.0));
            for (const SkyModel& sky : {SkyModel(published), SkyModel(scaled_to(published, 10000.0))}) {
                for (double zenith = 0.0; zenith <= 90.0; zenith += 6.0) {
                    for (double azimuth = 0.0; azimuth <= 180.0; azimuth += 15.0) {
                        Vec3f view(direction(zenith, azimuth));
                        view.z = std::max(view.z, 0.0f);
                        const Rgb rgb = sky_luminance(sky, view);
                        ASSERT_TRUE(std::isfinite(rgb.x) && std::isfinite(rgb.y) && std::isfinite(rgb.z))
                            << turbidity << ' ' << sun_zenith;
                        ASSERT_TRUE(rgb.x >= 0.0f && rgb.y >= 0.0f && rgb.z >= 0.0f) << turbidity << ' ' << sun_zenith;
                        ASSERT_GE(sky_radiance(sky, view), 0.0f);
                    }
                }
            }
        }
    }
    EXPECT_EQ(sky_luminance(SkyModel(preetham_sky(3.0, direction(30.0, 0.0))), Vec3f(0.6f, 0.0f, -0.8f)), Rgb(0.0f))
        << "black below the horizon";
}

// Truth: 709's primaries are reached only by mixing, so a sky in its domain is inside it and RGB gives the model's
// chromaticity back.
TEST(Preetham, RgbKeepsLuminanceAndChromaticity) {
    const SkyModel sky = preetham_sky(3.0, direction(50.0, 0.0));
    for (double zenith = 0.0; zenith < 90.0; zenith += 10.0) {
        const Vec3d view = direction(zenith, 75.0);
        const Xyz exact = sky_xyz(sky, view);
        const Rgb rgb = sky_luminance(sky, Vec3f(view));
        const Xyz back = xyz_from_rgb(rgb);
        EXPECT_NEAR(luminance(rgb), exact.y, 1e-5 * exact.y);
        EXPECT_NEAR(back.x / (back.x + back.y + back.z), exact.x / (exact.x + exact.y + exact.z), 1e-4);
        EXPECT_NEAR(back.y / (back.x + back.y + back.z), exact.y / (exact.x + exact.y + exact.z), 1e-4);
    }
}

// Truth: E = πL of the uniform dome; a grey stays exactly grey.
TEST(UniformSky, GivesPiTimesLuminance) {
    const SkyModel sky = UniformSky{1000.0f};
    EXPECT_EQ(sky_luminance(sky, Vec3f(0.0f, 0.6f, 0.8f)), Rgb(1000.0f));
    EXPECT_NEAR(luminance(horizontal_diffuse(sky).illuminance), 1000.0 * kPi, 0.01);
    EXPECT_NEAR(horizontal_diffuse(sky).irradiance_w_m2 * 115.0, 1000.0 * kPi, 0.01);
    EXPECT_EQ(sky_luminance(SkyModel(NoSky{}), Vec3f(0.0f, 0.0f, 1.0f)), Rgb(0.0f));
}

// Truth: the places that the panorama's contract names: brightest at the sun's column and row.
TEST(SkyPanorama, PutsTheSunsGlowWhereTheSunIs) {
    const SkyModel sky =
        preetham_sky(3.0, world_direction(radians_from_degrees(90.0), radians_from_degrees(30.0), 0.0));
    constexpr int kWidth = 72;
    constexpr int kHeight = 31;
    const std::vector<Rgb> pixels = sky_panorama(sky, kWidth, kHeight);
    ASSERT_EQ(pixels.size(), static_cast<std::size_t>(kWidth * kHeight));
    EXPECT_EQ(pixels[0], sky_luminance(sky, Vec3f(0.0f, 0.0f, 1.0f))) << "row 0 is the zenith";
    const int row = 20;  // zenith angle 60° of 90° in 30 steps
    int brightest = 0;
    for (int column = 0; column < kWidth; ++column) {
        if (luminance(pixels[row * kWidth + column]) > luminance(pixels[row * kWidth + brightest])) brightest = column;
    }
    EXPECT_TRUE(brightest == 17 || brightest == 18) << "east is a quarter of the way round, got column " << brightest;
    const Vec3f horizon(Vec3d(std::sin(kPi / kWidth), std::cos(kPi / kWidth), 0.0));
    EXPECT_NEAR(luminance(pixels[(kHeight - 1) * kWidth]), luminance(sky_luminance(sky, horizon)), 1.0)
        << "the last row is the horizon, north first";
}

}  // namespace
}  // namespace skybake
