#include "sky/aerial_perspective.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sky/daylight_settings.h"

namespace skybake {
namespace {

Daylight grey_daylight(float luminance) {
    Daylight daylight;
    daylight.sky = UniformSky{luminance};
    daylight.sun.shape = SunShape::none;
    return daylight;
}

// Truth: energy. A phase function sends out what comes in.
TEST(AerialPerspective, PhaseFunctionsIntegrateToOne) {
    constexpr int kSteps = 20'000;
    double molecules = 0.0;
    Vec3d haze(0.0);
    for (int i = 0; i < kSteps; ++i) {
        const double angle = kPi * (i + 0.5) / kSteps;
        const double weight = 2.0 * kPi * std::sin(angle) * kPi / kSteps;
        molecules += weight * molecule_phase(std::cos(angle));
        haze += weight * haze_phase(std::cos(angle));
    }
    EXPECT_NEAR(molecules, 1.0, 1e-6);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(haze[c], 1.0, 1e-5);
}

// Truth: the definition of the turbidity, (thickness of air and haze) over that of air, at 549 nm; and Rayleigh's own
// coefficient there, 1.2e-5 to 1.4e-5 per metre in every textbook.
TEST(AerialPerspective, ScatteringAgreesWithTheTurbidity) {
    EXPECT_NEAR(air_scattering(2.0).molecules.y, 1.3e-5, 0.1e-5);
    for (const double turbidity : {2.0, 3.0, 5.0, 10.0}) {
        const AirScattering air = air_scattering(turbidity);
        const double molecules = air.molecules.y * kMoleculeHeight;
        EXPECT_NEAR((molecules + air.haze.y * kHazeHeight) / molecules, turbidity, 0.2 * turbidity);
        EXPECT_GT(air.molecules.z, air.molecules.y) << "blue is scattered most";
    }
    EXPECT_EQ(air_scattering(0.9).haze.x, 0.0);
}

// Truth: furnace. Where the same luminance comes from everywhere, air that absorbs nothing cannot be seen, however far,
// steep or thick.
TEST(AerialPerspective, IsInvisibleInAFurnace) {
    const AerialPerspective air(grey_daylight(1000.0f), 5.0, Rgb(1000.0f));
    for (const double distance : {10.0, 1000.0, 30'000.0, 500'000.0}) {
        for (const double z : {-0.3, 0.0, 1e-9, 0.02, 0.9}) {
            const AerialView view = air.view(300.0, Vec3f(Vec3d(std::sqrt(1.0 - z * z), 0.0, z)), distance);
            for (int c = 0; c < 3; ++c) {
                if (300.0 + z * distance < 0.0) continue;  // below the sea
                // The sphere of lights has 768 directions: 1 % of the haze's peak.
                EXPECT_NEAR(1000.0f * view.transmittance[c] + view.inscatter[c], 1000.0f, 15.0f)
                    << distance << ' ' << z;
            }
        }
    }
}

// Truth: Beer-Lambert along a level path, and its sum for one that rises: the column of an exponential density.
TEST(AerialPerspective, TransmittanceIsThatOfTheColumn) {
    const AirScattering s = air_scattering(3.0);
    const AerialPerspective air(grey_daylight(1000.0f), 3.0, Rgb(0.0f));
    const float level = air.view(0.0, Vec3f(1.0f, 0.0f, 0.0f), 8000.0).transmittance.y;
    EXPECT_NEAR(level, std::exp(-8000.0 * (s.molecules.y + s.haze.y)), 1e-5);
    const float zenith = air.view(0.0, Vec3f(0.0f, 0.0f, 1.0f), 1e6).transmittance.y;
    EXPECT_NEAR(zenith, std::exp(-s.molecules.y * kMoleculeHeight - s.haze.y * kHazeHeight), 1e-5);
    const AerialView none = air.view(0.0, Vec3f(1.0f, 0.0f, 0.0f), 0.0);
    EXPECT_EQ(none.transmittance, Rgb(1.0f));
    EXPECT_EQ(none.inscatter, Rgb(0.0f));
}

// Truth: what everyone has seen: a dark hill turns blue and then bright with the distance, white rather towards the sun
// than away from it; a white wall loses blue first.
TEST(AerialPerspective, LooksLikeADayInTheHills) {
    FindingLog unheard;
    DaylightSettings settings;
    settings.sky = parse_sky("preetham:turbidity=2.5");
    settings.sun_direction = SunDirection{radians_from_degrees(180.0), radians_from_degrees(30.0)};
    const Daylight day = make_daylights(settings, std::nullopt, 0.0, unheard).at(0);
    const AerialPerspective air(day, 2.5, Rgb(4000.0f));
    float last = 0.0f;
    for (const double distance : {100.0, 1000.0, 5000.0, 20'000.0, 100'000.0}) {
        const AerialView view = air.view(200.0, Vec3f(0.0f, 1.0f, 0.0f), distance);
        EXPECT_GT(luminance(view.inscatter), last);
        EXPECT_GT(view.transmittance.x, view.transmittance.z);
        if (distance < 10'000.0) {
            EXPECT_GT(view.inscatter.z, 1.2f * view.inscatter.x) << distance;
        }
        last = luminance(view.inscatter);
    }
    const float horizon = luminance(sky_luminance(day.sky, Vec3f(0.0f, 0.9998f, 0.02f)));
    EXPECT_GT(last, 0.3f * horizon);
    EXPECT_LT(last, 3.0f * horizon);
    EXPECT_GT(luminance(air.view(200.0, Vec3f(0.0f, -1.0f, 0.0f), 5000.0).inscatter),
              luminance(air.view(200.0, Vec3f(0.0f, 1.0f, 0.0f), 5000.0).inscatter));
}

}  // namespace
}  // namespace skybake
