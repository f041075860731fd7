// Light that a study gets by reflection, against a sunlit wall in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "light/polygon_irradiance.h"
#include "study/study.h"
#include "study/study_scenes.h"

namespace skybake {
namespace {

/// A wall of 20 × 20 m, 10 m north of a point that looks at it. It faces south, and is all that stands there.
constexpr double kAlbedo = 0.8;
Scene white_wall() {
    Scene scene = QuadScene().quad({-10, 10, 0}, {10, 10, 0}, {10, 10, 20}, {-10, 10, 20}).scene();
    scene.materials[0].albedo = Rgb(static_cast<float>(kAlbedo));
    return scene;
}
const Vec3d kPoint{2, 0, 7};

/// The wall sees nothing but the sky, so that all of it has the irradiance E and the radiosity ρE: Lambert's formula.
double from_wall(double irradiance) {
    return polygon_irradiance({{-10, 10, 0}, {10, 10, 0}, {10, 10, 20}, {-10, 10, 20}}, kPoint, {0, 1, 0},
                              kAlbedo * irradiance / kPi);
}

Study study_of(const Scene& scene, const std::vector<Metric>& metrics, const StudySettings& settings) {
    const RayScene rays(scene);
    Rule rule;
    rule.metrics = metrics;
    SilentProgress silent;
    return run_study(rule, point_at_origin({0, 1, 0}, kPoint), {}, {&scene, &rays}, std::nullopt, settings, silent);
}

/// What a path gives scatters between 0 and ρE: with n paths the standard error is below ρE/(2√n). Five of them.
double tolerance(double irradiance, int paths) {
    return 5.0 * kAlbedo * irradiance / (2.0 * std::sqrt(static_cast<double>(paths)));
}

TEST(ReflectedLight, OfAYearFromASunlitWall) {
    constexpr double kRadiance = 150.0, kBeam = 900.0;
    auto picture = std::make_shared<SkyImage>();
    picture->width = 144;
    picture->height = 72;
    picture->pixels.assign(144 * 72, Rgb(static_cast<float>(kRadiance)));
    YearLight year;
    year.sky = ImageSky{picture, 0.0};
    year.diffuse_kwh_m2 = kPi * kRadiance;
    year.global_kwh_m2 = year.diffuse_kwh_m2;
    double on_wall = kPi * kRadiance / 2.0;
    // Two suns at middles of pixels: the spread over neighbouring pixels takes less than σ² = (2.5°)²/6 of the cosine,
    // 0.0003 of it, and its energy on level ground is kept.
    for (const auto& [azimuth_deg, zenith_deg] : {std::pair{181.25, 53.75}, std::pair{121.25, 61.25}}) {
        const double azimuth = radians_from_degrees(azimuth_deg), zenith = radians_from_degrees(zenith_deg);
        SunMoment moment;
        moment.direction =
            Vec3f(Vec3d(std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)));
        moment.beam_wh_m2 = static_cast<float>(1e3 * kBeam);
        year.moments.push_back(moment);
        year.global_kwh_m2 += kBeam * std::cos(zenith);
        on_wall += kBeam * -static_cast<double>(moment.direction.y);
    }
    StudySettings settings;
    settings.year_light = &year;
    settings.paths = {400000, 8, 3};
    const Study study = study_of(white_wall(), {Metric::indirect_kwh_m2}, settings);
    const double found = static_cast<double>(study.columns.at(0).values.at(0)), truth = from_wall(on_wall);
    std::printf("%.2f kWh/m2 from a wall of %.1f, in closed form %.2f\n", found, on_wall, truth);
    EXPECT_NEAR(found, truth, tolerance(on_wall, settings.paths.paths) + 0.001 * truth);
}

TEST(ReflectedLight, OfAnInstantFromASunlitWall) {
    Daylight daylight{"noon", NoSky{}, {}};
    daylight.sun.direction = glm::normalize(Vec3f(0.3f, -1.0f, 0.8f));
    daylight.sun.normal_illuminance = Rgb(90000.0f);
    const double on_wall = 90000.0 * -static_cast<double>(daylight.sun.direction.y);
    StudySettings settings;
    settings.instants = {daylight};
    settings.paths = {100000, 8, 3};
    const Study study = study_of(white_wall(), {Metric::sun_lx, Metric::indirect_lx, Metric::illuminance_lx}, settings);
    ASSERT_EQ(study.columns.size(), 3u);
    for (const Column& column : study.columns) {
        // The point looks away from the sun.
        const double truth = column.metric == Metric::sun_lx ? 0.0 : from_wall(on_wall);
        EXPECT_NEAR(static_cast<double>(column.values.at(0)), truth, tolerance(on_wall, settings.paths.paths))
            << column.name;
        EXPECT_EQ(column.instant, 0u);
    }
    EXPECT_EQ(study.columns[0].name, "indirect_lx_noon");
}

}  // namespace
}  // namespace skybake
