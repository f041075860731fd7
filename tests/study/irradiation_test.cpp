// Energy of a year by real weather files: open ground and free walls against sums over the files' own hours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/epw/read_epw.h"
#include "sky/solar_position.h"
#include "study/sky_shares.h"
#include "study/study_scenes.h"
#include "study/year_light.h"
#include "test_data.h"

namespace skybake {
namespace {

struct Place {
    const char* file;
    double latitude_deg, longitude_deg;
    double global_kwh_m2, beam_kwh_m2, diffuse_kwh_m2;  // found with other programs (the data sets' own notes)
};
void PrintTo(const Place& place, std::ostream* out) {
    *out << place.file;
}

class Irradiation : public testing::TestWithParam<Place> {};
INSTANTIATE_TEST_SUITE_P(RealWeather, Irradiation,
                         testing::Values(Place{"AUT_ST_Graz.Univ.112900_TMYx.2015-2019.derived.epw", 47.08, 15.45, 1583,
                                               1686, 566},
                                         Place{"855740_Santiago_CHL_TMYx.epw", -33.38, -70.79, 1910, 1894, 654},
                                         Place{"Singapore-Changi_1990_2010_TMY.epw", 1.37, 103.98, 1638, 1004, 939}));

TEST_P(Irradiation, OfFreeSurfacesIsTheSumOfTheFilesHours) {
    const Place& place = GetParam();
    const std::filesystem::path file = test_data(std::string("data/weather/") + place.file);
    SKYBAKE_NEEDS_DATA(file);
    FindingLog findings;
    Weather weather = io::read_epw(file, findings);
    settle_weather(weather, findings);
    const Site site{radians_from_degrees(place.latitude_deg), radians_from_degrees(place.longitude_deg), 0.0};
    const YearLight year = year_light(weather, site, 0.0, {});

    const Scene scene = QuadScene().ground(1, -500).scene();
    const RayScene rays(scene);
    std::vector<Sample> samples{sample_at({0, 0, 0}, {0, 0, 1}), sample_at({0, 0, 0}, {0, -1, 0}),
                                sample_at({0, 0, 0}, {1, 0, 0}), sample_at({0, 0, 0}, {0, 1, 0}),
                                sample_at({0, 0, 0}, {-1, 0, 0})};
    SilentProgress silent;
    const SkyShares sky = sky_shares(samples, scene.origin, rays, 4096, &year, silent);
    const YearSun sun = year_sun(samples, scene.origin, rays, year, silent);

    // Beam: each hour in twelve parts, without the study's lattice. Its four parts of an hour and its nodes at the
    // horizon may differ by 1 % of the beam on open ground.
    std::vector<double> beam(samples.size());
    double seen_dni = 0.0;
    for (const WeatherRow& row : weather.rows) {
        if (!row.dni || !(*row.dni > 0.0)) continue;
        const double centre =
            static_cast<double>(label_time(weather, row).milliseconds) + weather.centre.offset_h * 3600e3;
        std::vector<Vec3d> directions;
        for (int k = 0; k < 12; ++k) {
            const double time = centre + ((k + 0.5) / 12.0 - 0.5) * weather.interval_h() * 3600e3;
            const SolarPosition at = solar_position({std::llround(time)}, site);
            if (at.apparent_elevation_rad > 0.0)
                directions.push_back(world_direction(at.azimuth_rad, at.apparent_elevation_rad, 0.0));
        }
        for (const Vec3d& direction : directions) {
            const double part = 1e-3 * *row.dni * weather.interval_h() / static_cast<double>(directions.size());
            seen_dni += part;
            for (std::size_t i = 0; i < samples.size(); ++i)
                beam[i] += part * std::max(0.0, glm::dot(direction, Vec3d(samples[i].normal)));
        }
    }
    EXPECT_NEAR(seen_dni, place.beam_kwh_m2, 0.01 * place.beam_kwh_m2);
    for (std::size_t i = 0; i < samples.size(); ++i)
        EXPECT_NEAR(static_cast<double>(sun.beam_kwh_m2[i]), beam[i], 0.01 * beam[0]) << i;

    // Sky: all of the diffuse on open ground; on walls the picture of the year's sky, pixel by pixel.
    EXPECT_NEAR(static_cast<double>(sky.sky_irradiation_kwh_m2[0]), place.diffuse_kwh_m2, 0.01 * place.diffuse_kwh_m2);
    EXPECT_NEAR(static_cast<double>(sky.sky_irradiation_kwh_m2[0] + sun.beam_kwh_m2[0]), place.global_kwh_m2,
                0.02 * place.global_kwh_m2);
    const auto sum_of_picture = [&](const SkyImage& image, const Vec3f& normal) {
        double sum = 0.0;
        for (int row = 0; row < image.sky_rows(); ++row) {
            const double zenith = kPi * (row + 0.5) / image.height;
            const double solid_angle =
                2.0 * kPi / image.width * 2.0 * std::sin(zenith) * std::sin(kPi / 2 / image.height);
            for (int column = 0; column < image.width; ++column) {
                const double azimuth = 2.0 * kPi * (column + 0.5) / image.width;
                const Vec3d direction(std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth),
                                      std::cos(zenith));
                sum +=
                    static_cast<double>(luminance(image.pixels[static_cast<std::size_t>(row) * image.width + column])) *
                    solid_angle * std::max(0.0, glm::dot(direction, Vec3d(normal)));
            }
        }
        return sum;
    };
    // The picture for reflected light has the sun in it: a beam that is moved by less than a pixel, to all sides alike.
    const Daylight all = daylight_of(year);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const double sky_sum = sum_of_picture(*year.sky.image, samples[i].normal);
        EXPECT_NEAR(static_cast<double>(sky.sky_irradiation_kwh_m2[i]), sky_sum, 0.01 * sky_sum) << i;
        const double with_sun = sum_of_picture(*std::get<ImageSky>(all.sky).image, samples[i].normal);
        EXPECT_NEAR(with_sun, sky_sum + beam[i], 0.01 * place.global_kwh_m2) << i;
    }
    EXPECT_NEAR(static_cast<double>(luminance(horizontal_diffuse(all.sky).illuminance)), place.global_kwh_m2,
                0.02 * place.global_kwh_m2);
}

/// Half a year and the other half are the year.
TEST(IrradiationOfMonths, AddUp) {
    const std::filesystem::path file = test_data("data/weather/855740_Santiago_CHL_TMYx.epw");
    SKYBAKE_NEEDS_DATA(file);
    FindingLog findings;
    Weather weather = io::read_epw(file, findings);
    settle_weather(weather, findings);
    const Site site{radians_from_degrees(-33.38), radians_from_degrees(-70.79), 0.0};
    const YearLight all = year_light(weather, site, 0.0, {});
    const YearLight summer = year_light(weather, site, 0.0, {{1, 2, 3, 10, 11, 12}});
    const YearLight winter = year_light(weather, site, 0.0, {{4, 5, 6, 7, 8, 9}});
    EXPECT_NEAR(summer.global_kwh_m2 + winter.global_kwh_m2, all.global_kwh_m2, 1e-6);
    EXPECT_NEAR(summer.sunshine_h + winter.sunshine_h, all.sunshine_h, 1e-6);
    EXPECT_GT(summer.global_kwh_m2, winter.global_kwh_m2);
}

}  // namespace
}  // namespace skybake
