#include "sky/perez_sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sky/daylight.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

Vec3d sun_at(double elevation_deg) {
    return world_direction(2.0, radians_from_degrees(elevation_deg), 0.0);
}

double horizontal_of(const PerezSky& sky) {
    return horizontal_integral(sky.luminance, sky.sun_direction.z);
}

// Truth: energy. Whatever the weather, the dome brings its DHI, finite and non-negative: no clamp may lose it.
TEST(PerezSky, EveryWeatherKeepsItsLight) {
    for (const double elevation : {-5.0, 0.0, 0.5, 3.0, 10.0, 30.0, 50.0, 70.0, 87.0, 90.0}) {
        for (const double dhi : {0.1, 3.0, 20.0, 60.0, 150.0, 300.0, 600.0, 1200.0}) {
            for (const double dni : {0.0, 0.5, 20.0, 100.0, 300.0, 600.0, 1000.0, 1500.0}) {
                const PerezSky sky = perez_sky({dni, dhi}, sun_at(elevation));
                const double lux = dhi * sky.efficacy_lm_w;
                ASSERT_GT(sky.efficacy_lm_w, 50.0) << elevation << ' ' << dhi << ' ' << dni;
                ASSERT_NEAR(horizontal_of(sky), lux, 1e-9 * lux) << elevation << ' ' << dhi << ' ' << dni;
                ASSERT_TRUE(std::isfinite(sky_luminance_cd_m2(sky, {1.0, 0.0, 0.0})));
            }
        }
    }
}

// Truth: without diffuse light there is no sky.
TEST(PerezSky, IsBlackWithoutDiffuseLight) {
    const PerezSky sky = perez_sky({700.0, 0.0}, sun_at(40.0));
    EXPECT_EQ(sky_luminance_cd_m2(sky, {0.0, 0.6, 0.8}), 0.0);
    EXPECT_NEAR(perez_state({700.0, 0.0}, 0.9).direct_efficacy_lm_w, 101.0, 5.0);
}

// Truth: the colour changes nothing of the luminance; clouds are white, a clear sky is blue away from the sun.
TEST(PerezSky, ColourFollowsTheWeather) {
    const Vec3d view(world_direction(2.0 + kPi, radians_from_degrees(50.0), 0.0));
    const auto blue_over_red = [&](const PerezWeather& weather) {
        const PerezSky sky = perez_sky(weather, sun_at(40.0));
        const Xyz xyz = sky_xyz(sky, view);
        EXPECT_EQ(xyz.y, sky_luminance_cd_m2(sky, view));
        const Rgb rgb = rgb_from_xyz(xyz);
        return rgb.z / rgb.x;
    };
    const float overcast = blue_over_red({0.0, 200.0});
    const float broken = blue_over_red({300.0, 250.0});
    const float clear = blue_over_red({850.0, 80.0});
    EXPECT_NEAR(overcast, 1.0f, 0.01f);
    EXPECT_GT(broken, 1.1f * overcast);
    EXPECT_GT(clear, 1.5f * broken);
}

// Truth: by its definition.
TEST(SkyColour, TurbidityIsThatOfTheBeam) {
    for (const double turbidity : {2.5, 4.0, 8.0})
        EXPECT_NEAR(turbidity_of_beam(clear_sky_irradiance(turbidity, 0.8, 1.01).dni, 0.8, 1.01), turbidity, 1e-3);
    EXPECT_NEAR(turbidity_of_beam(1400.0, 0.8, 1.0), 2.0, 1e-3);
    EXPECT_NEAR(turbidity_of_beam(0.0, 0.8, 1.0), 10.0, 1e-3);
}

}  // namespace
}  // namespace skybake
