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
    Daylight furnace = grey_daylight(1000.0f);
    furnace.turbidity = 5.0;
    // The land is dark, so the level views alone are a furnace: the horizon is what they are brought to.
    const Air air = air_under(furnace);
    for (const double distance : {10.0, 1000.0, 30'000.0, 500'000.0}) {
        for (const double azimuth : {0.0, 1.0, 2.5, 5.0}) {
            const AerialView view = view_through(air, 0.0, {std::sin(azimuth), std::cos(azimuth), 0.0}, distance);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(1000.0f * view.transmittance[c] + view.inscatter[c], 1000.0f, 10.0f) << distance;
        }
    }
}

// Truth: Beer-Lambert along a level path, and its sum for one that rises: the column of an exponential density.
TEST(AerialPerspective, TransmittanceIsThatOfTheColumn) {
    const AirScattering s = air_scattering(3.0);
    const Air air = air_under(grey_daylight(1000.0f), 8, 8);
    const float level = view_through(air, 0.0, {1.0, 0.0, 0.0}, 8000.0).transmittance.y;
    EXPECT_NEAR(level, std::exp(-8000.0 * (s.molecules.y + s.haze.y)), 1e-5);
    const float zenith = view_through(air, 0.0, {0.0, 0.0, 1.0}, 1e6).transmittance.y;
    EXPECT_NEAR(zenith, std::exp(-s.molecules.y * kMoleculeHeight - s.haze.y * kHazeHeight), 1e-5);
    const AerialView none = view_through(air, 0.0, {1.0, 0.0, 0.0}, 0.0);
    EXPECT_EQ(none.transmittance, Rgb(1.0f));
    EXPECT_EQ(none.inscatter, Rgb(0.0f));
}

Daylight day_of(const char* sky, double sun_elevation_deg) {
    FindingLog unheard;
    DaylightSettings settings;
    settings.sky = parse_sky(sky);
    settings.sun_direction = SunDirection{radians_from_degrees(180.0), radians_from_degrees(sun_elevation_deg)};
    return make_daylights(settings, std::nullopt, 0.0, unheard).at(0);
}

// Truth: Koschmieder. An endless level view shows the sky's own horizon, so that land and sky meet without a seam; the
// table is bilinear, so within 2 % away from the sun's aureole.
TEST(AerialPerspective, EndsInTheSkysHorizon) {
    for (const char* sky : {"preetham:turbidity=2", "preetham:turbidity=8", "perez:dni=700,dhi=90", "cie:type=7",
                            "cie1994:overcast", "uniform:luminance=3000"}) {
        for (const double elevation : {60.0, 10.0}) {
            const Daylight day = day_of(sky, elevation);
            const Air air = air_under(day);
            for (int i = 0; i < 36; ++i) {
                const double azimuth = radians_from_degrees(10.0 * i + 5.0);
                const Vec3d level(std::sin(azimuth), std::cos(azimuth), 0.0);
                const Rgb seen = view_through(air, 0.0, level, 1e7).inscatter;
                const Rgb horizon = sky_luminance(day.sky, Vec3f(level));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c], horizon[c], 0.02f * horizon[c]) << sky << ' ' << elevation << ' ' << i;
            }
        }
    }
}

// Truth: the same integral in a hundred times as many pieces: with a path of n pieces cut in two, the second half is
// seen through the first. From a tower, a hill and an aeroplane, down to the ground.
TEST(AerialPerspective, FourPiecesAreEnough) {
    const Air air = air_under(day_of("preetham:turbidity=3", 20.0), 16, 32);
    for (const double height : {2.0, 100.0, 500.0, 2000.0}) {
        for (const double distance : {100.0, 1000.0, 10'000.0, 50'000.0}) {
            const double z = -std::min(1.0, height / distance);
            const Vec3d direction(0.6 * std::sqrt(1.0 - z * z), 0.8 * std::sqrt(1.0 - z * z), z);
            const double length = std::min(distance, height / -z);
            const AerialView view = view_through(air, height, direction, length);
            constexpr int kParts = 100;
            Vec3d transmittance(1.0);
            Vec3d inscatter(0.0);
            for (int i = 0; i < kParts; ++i) {
                const AerialView part = view_through(air, height + z * length * i / kParts, direction, length / kParts);
                inscatter += transmittance * Vec3d(part.inscatter);
                transmittance *= Vec3d(part.transmittance);
            }
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(view.transmittance[c], transmittance[c], 1e-5) << height << ' ' << distance;
                EXPECT_NEAR(view.inscatter[c], inscatter[c], 5e-3 * inscatter[c]) << height << ' ' << distance;
            }
        }
    }
}

// Truth: what everyone has seen: a dark hill turns blue and then bright with the distance, a white wall loses blue
// first, and haze glows towards the sun.
TEST(AerialPerspective, LooksLikeADayInTheHills) {
    const Daylight day = day_of("preetham:turbidity=2.5", 30.0);
    const Air air = air_under(day);
    const Vec3d north(0.0, 1.0, 0.0);
    float last = 0.0f;
    for (const double distance : {100.0, 1000.0, 5000.0, 20'000.0, 100'000.0}) {
        const AerialView view = view_through(air, 200.0, north, distance);
        EXPECT_GT(luminance(view.inscatter), last);
        EXPECT_GT(view.transmittance.x, view.transmittance.z);
        if (distance < 10'000.0) {
            EXPECT_GT(view.inscatter.z, 1.2f * view.inscatter.x) << distance;
        }
        last = luminance(view.inscatter);
    }
    EXPECT_GT(luminance(view_through(air, 200.0, -north, 5000.0).inscatter),
              luminance(view_through(air, 200.0, north, 5000.0).inscatter));
}

// Truth: the rule of docs/physics.md for whose turbidity the air has.
TEST(AerialPerspective, TakesItsTurbidityFromTheSky) {
    EXPECT_EQ(day_of("preetham:turbidity=6", 30.0).turbidity, 6.0);
    EXPECT_EQ(day_of("cie:type=12", 30.0).turbidity, 2.5);
    EXPECT_EQ(day_of("cie1994:clear,level=gensky,turbidity=4", 30.0).turbidity, 2.5);
    EXPECT_EQ(day_of("cie:type=1", 30.0).turbidity, kDefaultTurbidity);
    EXPECT_EQ(day_of("cie:type=8,turbidity=5", 30.0).turbidity, 5.0);
    EXPECT_EQ(day_of("uniform:luminance=1000", 30.0).turbidity, kDefaultTurbidity);
    EXPECT_GT(day_of("perez:dni=300,dhi=200", 30.0).turbidity, day_of("perez:dni=850,dhi=60", 30.0).turbidity);
}

}  // namespace
}  // namespace skybake
