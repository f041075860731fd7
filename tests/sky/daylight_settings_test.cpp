#include "sky/daylight_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "sky/clear_sky.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

using ::testing::HasSubstr;

template <typename Action>
std::string refusal(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string sky_refusal(const std::string& text) {
    return refusal([&] { parse_sky(text); });
}

DaylightSettings with_sun(const std::string& sky, double elevation_deg) {
    DaylightSettings settings;
    settings.sky = parse_sky(sky);
    settings.sun_direction = SunDirection{radians_from_degrees(180.0), radians_from_degrees(elevation_deg)};
    return settings;
}

Daylight only(const DaylightSettings& settings, FindingLog& findings, double convergence_rad = 0.0) {
    const std::vector<Daylight> daylights = make_daylights(settings, std::nullopt, convergence_rad, findings);
    EXPECT_EQ(daylights.size(), 1u);
    return daylights.at(0);
}

TEST(ParseSky, ReadsEveryForm) {
    EXPECT_EQ(to_text(parse_sky("preetham")), "preetham:turbidity=3,level=clearsky");
    EXPECT_EQ(to_text(parse_sky("preetham:turbidity=2.5,level=published")), "preetham:turbidity=2.5,level=published");
    EXPECT_EQ(to_text(parse_sky("preetham:level=dhi=120.5")), "preetham:turbidity=3,level=dhi=120.5");
    EXPECT_EQ(to_text(parse_sky("preetham:dhi=120.5")), "preetham:turbidity=3,level=dhi=120.5");
    EXPECT_EQ(to_text(parse_sky("uniform:luminance=2000")), "uniform:luminance=2000,turbidity=3");
    EXPECT_EQ(to_text(parse_sky("none")), "none:turbidity=3");
    for (const char* text :
         {"preetham:turbidity=4,level=dhi=50", "uniform:luminance=1.5,turbidity=2", "none:turbidity=2",
          "perez:dni=700,dhi=90.5,water=1.5", "cie:type=3", "cie:type=12,dhi=80,turbidity=2", "cie:type=7,zenith=4000",
          "cie1994:turbid,dhi=70", "cie1994:intermediate,turbidity=3,level=gensky", "cie1994:overcast,zenith=5000",
          "image:sky/a b.exr,sun=cut,rotate=-90,scale=179,turbidity=3",
          "image:a.hdr,sun=keep,rotate=0,dhi=60,turbidity=3"}) {
        EXPECT_EQ(to_text(parse_sky(text)), text) << "what is written is what is read";
    }
}

TEST(ParseSky, SaysWhatIsWrong) {
    EXPECT_THAT(sky_refusal("prethan"), HasSubstr("did you mean 'preetham'?"));
    EXPECT_THAT(sky_refusal("peres:dni=500"), HasSubstr("did you mean 'perez'? Available are preetham:turbidity=T"));
    EXPECT_THAT(sky_refusal("perez:dni=500"), HasSubstr("dhi is missing. The Perez sky is made from a measured"));
    EXPECT_THAT(sky_refusal("perez:dni=500,dhi=-1"), HasSubstr("dhi=-1 is not a number in 0…1500 W/m²"));
    EXPECT_THAT(sky_refusal("perez:dni=500,dhi=1,turbidity=3"), HasSubstr("there is no key 'turbidity'; did you mean"));
    EXPECT_THAT(sky_refusal("cie"), HasSubstr("type is missing. The CIE general sky has 15 types"));
    EXPECT_THAT(sky_refusal("cie:type=16"), HasSubstr("type=16 is not a number in 1…15"));
    EXPECT_THAT(sky_refusal("cie:type=2.5"), HasSubstr("type=2.5 is not a whole number in 1…15"));
    EXPECT_THAT(sky_refusal("cie:type=12,dhi=1,zenith=2"), HasSubstr("dhi and zenith exclude each other"));
    EXPECT_THAT(sky_refusal("cie:type=1,turbidity=3"), HasSubstr("hides the sun and has no blue"));
    EXPECT_THAT(sky_refusal("cie:tipe=1"), HasSubstr("there is no key 'tipe'; did you mean 'type'?"));
    EXPECT_THAT(sky_refusal("cie:type=1,dhy=4"), HasSubstr("there is no key 'dhy'; did you mean 'dhi'?"));
    EXPECT_THAT(sky_refusal("cie1994"), HasSubstr("which one? It is cie1994:clear, turbid, intermediate or overcast"));
    EXPECT_THAT(sky_refusal("cie1994:cleer"), HasSubstr("did you mean 'clear'? Known skies: clear, turbid"));
    EXPECT_THAT(sky_refusal("cie1994:clear,level=gensky,dhi=1"), HasSubstr("level excludes dhi and zenith"));
    EXPECT_THAT(sky_refusal("image"), HasSubstr("the file is missing. It is image:FILE"));
    EXPECT_THAT(sky_refusal("image:a.exr,sun=out"), HasSubstr("sun=out is neither keep nor cut"));
    EXPECT_THAT(sky_refusal("image:a.exr,scale=1,dhi=3"), HasSubstr("scale and dhi exclude each other"));
    EXPECT_THAT(sky_refusal("preetham:turbidty=3"), HasSubstr("there is no key 'turbidty'; did you mean 'turbidity'?"));
    EXPECT_THAT(sky_refusal("preetham:turbidity=0.5"), HasSubstr("turbidity=0.5 is not a number in 1…60"));
    EXPECT_THAT(sky_refusal("preetham:turbidity=nan"), HasSubstr("is not a number"));
    EXPECT_THAT(sky_refusal("preetham:turbidity=3x"), HasSubstr("is not a number"));
    EXPECT_THAT(sky_refusal("preetham:level=bright"), HasSubstr("known levels: clearsky, published, dhi=W"));
    EXPECT_THAT(sky_refusal("preetham:level=published,dhi=3"), HasSubstr("exclude each other"));
    EXPECT_THAT(sky_refusal("preetham:turbidity=3,turbidity=4"), HasSubstr("given twice"));
    EXPECT_THAT(sky_refusal("preetham:turbidity"), HasSubstr("is not KEY=VALUE"));
    EXPECT_THAT(sky_refusal("uniform:luminance=-1"), HasSubstr("is not a number in 0…1e+09 cd/m²"));
    EXPECT_THAT(sky_refusal(""), HasSubstr("there is no sky model ''"));
}

TEST(ParseAngles, ReadsAndRefuses) {
    EXPECT_NEAR(parse_site("-33.9,151.2").latitude_rad, radians_from_degrees(-33.9), 1e-12);
    EXPECT_NEAR(parse_site("47.07, 15.44").longitude_rad, radians_from_degrees(15.44), 1e-12);
    EXPECT_THAT(refusal([] { parse_site("151.2,-33.9"); }), HasSubstr("LATITUDE,LONGITUDE"));
    EXPECT_THAT(refusal([] { parse_site("47"); }), HasSubstr("LATITUDE,LONGITUDE"));
    EXPECT_NEAR(parse_sun_direction("180,45").elevation_rad, kPi / 4.0, 1e-12);
    EXPECT_THAT(refusal([] { parse_sun_direction("180,95"); }), HasSubstr("AZIMUTH,ELEVATION"));
    EXPECT_THAT(refusal([] { parse_sun_shape("round"); }), HasSubstr("point, disc or none"));
}

// Truth: what is not said is asked for, never guessed.
TEST(MakeDaylights, AsksForWhatIsMissing) {
    FindingLog findings;
    DaylightSettings settings;
    EXPECT_THAT(refusal([&] { make_daylights(settings, Site{}, 0.0, findings); }), HasSubstr("give --at TIME"));
    settings.instants = {parse_instant("2026-06-21T12:00Z", std::nullopt)};
    EXPECT_THAT(refusal([&] { make_daylights(settings, std::nullopt, 0.0, findings); }),
                HasSubstr("give --site LAT,LON"));
    settings.sun_direction = SunDirection{};
    EXPECT_THAT(refusal([&] { make_daylights(settings, Site{}, 0.0, findings); }), HasSubstr("give one of them"));
}

TEST(MakeDaylights, UniformAndNoneNeedNoSun) {
    FindingLog findings;
    DaylightSettings settings;
    settings.sky = parse_sky("uniform:luminance=500");
    const Daylight uniform = only(settings, findings);
    EXPECT_EQ(uniform.sun.shape, SunShape::none);
    EXPECT_EQ(sky_luminance(uniform.sky, Vec3f(0.0f, 0.0f, 1.0f)), Rgb(500.0f));
    EXPECT_TRUE(findings.empty());
    settings.sky = parse_sky("none");
    only(settings, findings);
    EXPECT_EQ(findings.count("SB604"), 1u) << "no light at all is worth a word";
}

// Truth: by definition of the levels (horizontal illuminance from Bird & Hulstrom times Perez's efficacy; the user's
// own W/m²).
TEST(MakeDaylights, LevelsOfThePreethamSky) {
    FindingLog findings;
    const double zenith = radians_from_degrees(50.0);
    const ClearSkyIrradiance clear = clear_sky_irradiance(3.0, zenith, 1.0);
    const HorizontalDiffuse by_clear_sky = horizontal_diffuse(only(with_sun("preetham", 40.0), findings).sky);
    EXPECT_NEAR(by_clear_sky.irradiance_w_m2, clear.dhi, 1e-3 * clear.dhi);
    const double lux = clear.dhi * smooth_diffuse_luminous_efficacy(clear.dni, clear.dhi, zenith, kSolarConstant, 2.0);
    EXPECT_NEAR(luminance(by_clear_sky.illuminance), lux, 1e-3 * lux);

    const HorizontalDiffuse by_dhi = horizontal_diffuse(only(with_sun("preetham:level=dhi=77", 40.0), findings).sky);
    EXPECT_NEAR(by_dhi.irradiance_w_m2, 77.0, 0.1);
    EXPECT_EQ(luminance(horizontal_diffuse(only(with_sun("preetham:dhi=0", 40.0), findings).sky).illuminance), 0.0f);
    EXPECT_TRUE(findings.empty());

    const double published =
        luminance(horizontal_diffuse(only(with_sun("preetham:level=published", 40.0), findings).sky).illuminance);
    EXPECT_GT(published, lux);
    EXPECT_EQ(findings.count("SB603"), 1u);
}

constexpr const char* kEveryModel[] = {"perez:dni=800,dhi=90",
                                       "perez:dni=300,dhi=250",
                                       "perez:dni=0,dhi=150",
                                       "cie:type=1",
                                       "cie:type=2",
                                       "cie:type=3",
                                       "cie:type=4",
                                       "cie:type=5",
                                       "cie:type=6",
                                       "cie:type=7",
                                       "cie:type=8",
                                       "cie:type=9",
                                       "cie:type=10",
                                       "cie:type=11",
                                       "cie:type=12",
                                       "cie:type=13",
                                       "cie:type=14",
                                       "cie:type=15",
                                       "cie1994:clear",
                                       "cie1994:turbid",
                                       "cie1994:intermediate",
                                       "cie1994:overcast",
                                       "cie1994:clear,level=gensky",
                                       "cie1994:intermediate,level=gensky"};

// Truth: by definition of dhi=, zenith= and Perez's own numbers.
TEST(MakeDaylights, LevelsAreThoseAskedFor) {
    FindingLog findings;
    for (const char* sky : {"perez:dni=500,dhi=77", "cie:type=1,dhi=77", "cie:type=8,dhi=77", "cie:type=13,dhi=77",
                            "cie1994:clear,dhi=77", "cie1994:intermediate,dhi=77", "cie1994:overcast,dhi=77"}) {
        EXPECT_NEAR(horizontal_diffuse(only(with_sun(sky, 40.0), findings).sky).irradiance_w_m2, 77.0, 0.02) << sky;
    }
    for (const char* sky : {"cie:type=4,zenith=3000", "cie:type=15,zenith=3000", "cie1994:turbid,zenith=3000"})
        EXPECT_NEAR(sky_xyz(only(with_sun(sky, 40.0), findings).sky, {0.0, 0.0, 1.0}).y, 3000.0, 1e-6) << sky;
    const Daylight perez = only(with_sun("perez:dni=500,dhi=77", 40.0), findings);
    EXPECT_EQ(perez.sun.dni_w_m2, 500.0f);
    EXPECT_NEAR(luminance(perez.sun.normal_illuminance) / 500.0, 104.0, 4.0) << "lm/W of a beam, Perez 1990";
    EXPECT_TRUE(findings.empty());
}

// Truth: Krochmann & Seidl 1974 for the overcast sky; a clear sky's level is that of the Preetham sky of its
// turbidity, so that a change of model does not change the light of a clear day.
TEST(MakeDaylights, DefaultLevelsOfTheCieSkies) {
    FindingLog findings;
    const auto lux = [&](const char* sky) {
        return luminance(horizontal_diffuse(only(with_sun(sky, 30.0), findings).sky).illuminance);
    };
    for (const char* sky : {"cie:type=1", "cie:type=4", "cie1994:overcast"}) EXPECT_NEAR(lux(sky), 10800.0, 5.0) << sky;
    EXPECT_NEAR(lux("cie:type=12"), lux("preetham:turbidity=2.5"), 10.0);
    EXPECT_NEAR(lux("cie1994:clear,turbidity=4"), lux("preetham:turbidity=4"), 10.0);
    EXPECT_NEAR(lux("cie:type=7"), 0.4 * 133100.0 * 0.5, 10.0);
    EXPECT_EQ(only(with_sun("cie:type=3", 30.0), findings).sun.dni_w_m2, 0.0f) << "overcast skies hide the sun";
    EXPECT_GT(only(with_sun("cie:type=12", 30.0), findings).sun.dni_w_m2, 700.0f);
}

// Truth: the contract of Daylight, for every model and sun, also below the horizon.
TEST(MakeDaylights, EveryModelIsFiniteAndNeverNegative) {
    for (const char* sky : kEveryModel) {
        for (double elevation = -30.0; elevation <= 90.0;
             elevation += elevation > -1.0 && elevation < 1.0 ? 0.25 : 7.25) {
            FindingLog findings;
            const Daylight light = only(with_sun(sky, elevation), findings);
            ASSERT_TRUE(std::isfinite(light.sun.dni_w_m2) && light.sun.dni_w_m2 >= 0.0f) << sky << ' ' << elevation;
            EXPECT_TRUE(elevation > 0.0 || light.sun.normal_illuminance == Rgb(0.0f)) << sky << ' ' << elevation;
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(light.sun.normal_illuminance[c] >= 0.0f && light.sun.normal_illuminance[c] < 2e5f)
                    << sky << ' ' << elevation;
            }
            for (int i = 0; i < 200; ++i) {
                const double z = (i + 0.5) / 200.0, azimuth = 2.4 * i, r = std::sqrt(1.0 - z * z);
                const Rgb rgb = sky_luminance(light.sky, Vec3f(Vec3d(r * std::sin(azimuth), r * std::cos(azimuth), z)));
                ASSERT_TRUE(rgb.x >= 0.0f && rgb.y >= 0.0f && rgb.z >= 0.0f && luminance(rgb) < 1e7f)
                    << sky << ' ' << elevation << ' ' << rgb.x << ' ' << rgb.y << ' ' << rgb.z;
            }
        }
    }
}

// Truth: the model's own words: an ε beyond 12, a Δ beyond 0.6, more beam than there is sun.
TEST(MakeDaylights, FindsWeatherThatPerezDoesNotKnow) {
    for (const auto& [sky, count] : {std::pair{"perez:dni=800,dhi=90", 0u},
                                     {"perez:dni=1450,dhi=200", 1u},
                                     {"perez:dni=900,dhi=20", 1u},
                                     {"perez:dni=0,dhi=900", 1u},
                                     {"perez:dni=1450,dhi=5", 3u}}) {
        FindingLog findings;
        only(with_sun(sky, 40.0), findings);
        EXPECT_EQ(findings.count("SB605"), count) << sky;
    }
    FindingLog findings;
    const Daylight dark = only(with_sun("perez:dni=0,dhi=0", 40.0), findings);
    EXPECT_EQ(findings.count("SB604"), 1u);
    EXPECT_EQ(luminance(sky_luminance(dark.sky, Vec3f(0.0f, 0.6f, 0.8f))), 0.0f);
    EXPECT_EQ(only(with_sun("perez:dni=300,dhi=50", -2.0), findings).sun.dni_w_m2, 0.0f);
    EXPECT_EQ(findings.count("SB602"), 1u);
}

// Truth: a sky that is round about the zenith, at a given level, needs no sun; the others ask for one.
TEST(MakeDaylights, OnlyRoundSkiesOfAKnownLevelNeedNoSun) {
    DaylightSettings settings;
    FindingLog findings;
    for (const char* sky : {"cie:type=1,dhi=50", "cie:type=5,zenith=1000", "cie1994:overcast,dhi=50"}) {
        settings.sky = parse_sky(sky);
        EXPECT_GT(luminance(sky_luminance(only(settings, findings).sky, Vec3f(0.0f, 0.6f, 0.8f))), 0.0f) << sky;
    }
    for (const char* sky : {"cie:type=1", "cie:type=2,dhi=50", "cie1994:clear,dhi=50", "perez:dni=1,dhi=50"}) {
        settings.sky = parse_sky(sky);
        EXPECT_THAT(refusal([&] { only(settings, findings); }), HasSubstr("needs to know where the sun is")) << sky;
    }
}

// Truth: continuity. A sun that rises by a quarter of a degree changes the sky by a little, without the jumps of
// Perez's bins.
TEST(MakeDaylights, LevelHasNoSteps) {
    for (const char* sky : {"preetham:turbidity=3", "preetham:turbidity=6"}) {
        FindingLog findings;
        double last = 0.0;
        for (double elevation = 8.0; elevation < 85.0; elevation += 0.25) {
            const double lux = luminance(horizontal_diffuse(only(with_sun(sky, elevation), findings).sky).illuminance);
            if (last > 0.0) {
                EXPECT_LT(std::abs(lux / last - 1.0), 0.02 * std::max(1.0, 20.0 / elevation))
                    << sky << ' ' << elevation;
            }
            last = lux;
        }
    }
}

// Truth: continuity. The sky's illuminance falls steadily through sunset, and stays finite and non-negative.
TEST(MakeDaylights, DuskIsSmoothAndFound) {
    FindingLog findings;
    double last = 1e9;
    for (double elevation = 8.0; elevation > -20.0; elevation -= 0.25) {
        const Daylight light = only(with_sun("preetham", elevation), findings);
        const double lux = luminance(horizontal_diffuse(light.sky).illuminance);
        ASSERT_TRUE(std::isfinite(lux));
        EXPECT_LT(lux, last * 1.0001) << elevation;
        EXPECT_GT(lux, 0.0) << elevation;
        if (elevation <= 0.0) {
            EXPECT_EQ(light.sun.dni_w_m2, 0.0f) << elevation;
            EXPECT_EQ(light.sun.normal_illuminance, Rgb(0.0f)) << elevation;
        }
        last = lux;
    }
    EXPECT_EQ(findings.count("SB602"), 80u);
}

TEST(MakeDaylights, FindsTurbiditiesThatAreNotTrusted) {
    for (const auto& [sky, count] : {std::pair{"preetham:turbidity=1.5", 1u},
                                     {"preetham:turbidity=2", 0u},
                                     {"preetham:turbidity=10", 0u},
                                     {"preetham:turbidity=20", 1u}}) {
        FindingLog findings;
        const Daylight light = only(with_sun(sky, 30.0), findings);
        EXPECT_EQ(findings.count("SB601"), count) << sky;
        EXPECT_GT(luminance(sky_luminance(light.sky, Vec3f(0.0f, 0.0f, 1.0f))), 0.0f);
    }
}

// Truth: SPA's own example, and geometry: the sun of the grid stands at azimuth − convergence.
TEST(MakeDaylights, PutsTheSunWhereItIsSeen) {
    FindingLog findings;
    DaylightSettings settings;
    settings.instants = {parse_instant("2026-06-21T12:00+02:00", std::nullopt)};
    const Site graz = parse_site("47.0707,15.4395");
    const SolarPosition position = solar_position(settings.instants[0].utc, graz);
    const double convergence = radians_from_degrees(-0.7);
    const Daylight light = make_daylights(settings, graz, convergence, findings).at(0);
    EXPECT_EQ(light.label, "2026-06-21T12:00:00+02:00");
    EXPECT_NEAR(light.sun.direction.z, std::sin(position.apparent_elevation_rad), 1e-6);
    EXPECT_NEAR(std::atan2(light.sun.direction.x, light.sun.direction.y) + convergence, position.azimuth_rad, 1e-5);
    EXPECT_NEAR(light.sun.angular_radius_rad, 0.00465 / 1.0163, 1e-5) << "small in June";
    EXPECT_GT(luminance(light.sun.normal_illuminance), 70000.0f);
    EXPECT_GT(light.sun.dni_w_m2, 600.0f);
}

TEST(MakeDaylights, SunNoneLeavesTheSkyAsItIs) {
    FindingLog findings;
    DaylightSettings settings = with_sun("preetham", 40.0);
    const Daylight with = only(settings, findings);
    settings.sun = SunShape::none;
    const Daylight without = only(settings, findings);
    EXPECT_EQ(without.sun.normal_illuminance, Rgb(0.0f));
    EXPECT_EQ(without.sun.dni_w_m2, 0.0f);
    const Vec3f view(0.6f, 0.0f, 0.8f);
    EXPECT_EQ(sky_luminance(with.sky, view), sky_luminance(without.sky, view));
    EXPECT_EQ(with.label, "sun 180,40");
}

}  // namespace
}  // namespace skybake
