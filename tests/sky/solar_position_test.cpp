#include "sky/solar_position.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "base/error.h"
#include "sky/reference_table.h"
#include "sky/solar_events.h"
#include "sky/solar_terms.h"
#include "test_data.h"

namespace skybake {
namespace {

double degrees_apart(double a, double b) {
    return std::abs(std::remainder(a - b, 360.0));
}

Site site_of(double latitude_deg, double longitude_deg, double elevation_m) {
    return {radians_from_degrees(latitude_deg), radians_from_degrees(longitude_deg), elevation_m};
}

// Truth: the worked example of Reda & Andreas (NREL/TP-560-34302, appendix A5), with its intermediate results.
TEST(SolarPosition, GivesThePublishedExample) {
    const UtcTime time = parse_instant("2003-10-17T12:30:30-07:00", std::nullopt).utc;
    const double julian_day = seconds_since_1970(time) / 86400.0 + 2440587.5;
    EXPECT_NEAR(julian_day, 2452930.312847, 5e-7);
    const GeocentricSun sun = geocentric_sun(julian_day, 67.0);
    EXPECT_NEAR(degrees_from_radians(sun.heliocentric_longitude_rad), 24.0182616917, 1e-9);
    EXPECT_NEAR(degrees_from_radians(sun.heliocentric_latitude_rad), -0.0001011219, 1e-10);
    EXPECT_NEAR(sun.distance_au, 0.9965422974, 1e-10);
    EXPECT_NEAR(degrees_from_radians(sun.nutation_longitude_rad), -0.00399840, 1e-8);
    EXPECT_NEAR(degrees_from_radians(sun.nutation_obliquity_rad), 0.00166657, 1e-8);
    EXPECT_NEAR(degrees_from_radians(sun.obliquity_rad), 23.440465, 5e-7);
    EXPECT_NEAR(degrees_from_radians(sun.declination_rad), -9.31434, 5e-6);
    const SolarPosition position = solar_position(time, site_of(39.742476, -105.1786, 1830.14),
                                                  {.delta_t_s = 67.0, .pressure_hpa = 820.0, .temperature_c = 11.0});
    EXPECT_NEAR(degrees_from_radians(position.hour_angle_rad), 11.10590, 1e-5);
    EXPECT_NEAR(90.0 - degrees_from_radians(position.apparent_elevation_rad), 50.11162, 5e-6);
    EXPECT_NEAR(degrees_from_radians(position.azimuth_rad), 194.34024, 5e-6);
}

/// The largest of a column's errors, printed as a row of a table.
class MaxError {
  public:
    MaxError(std::string what, std::string unit, double tolerance)
        : what_(std::move(what)), unit_(std::move(unit)), tolerance_(tolerance) {}
    ~MaxError() {
        fmt::print("| {} | {} values | max error {:.2g} {} | tolerance {:g} |\n", what_, count_, worst_, unit_,
                   tolerance_);
    }
    MaxError(const MaxError&) = delete;
    MaxError& operator=(const MaxError&) = delete;
    void add(double error) {
        worst_ = std::max(worst_, std::abs(error));
        ++count_;
        EXPECT_LE(std::abs(error), tolerance_) << what_;
    }

  private:
    std::string what_;
    std::string unit_;
    double tolerance_;
    double worst_ = 0.0;
    int count_ = 0;
};

// Truth: the tables A4.2 and A4.3 of the report, as pvlib and freespa have them: each number, none more and none less.
TEST(SolarTerms, AreThePublishedOnes) {
    const auto path = test_data("reference/spa_terms.csv");
    SKYBAKE_NEEDS_DATA(path);
    std::map<std::string, std::span<const PeriodicTerm>> series;
    const auto add = [&](const char* name, const auto& orders) {
        for (std::size_t n = 0; n < orders.size(); ++n) series[fmt::format("{}{}", name, n)] = orders[n];
    };
    add("L", heliocentric_longitude_terms());
    add("B", heliocentric_latitude_terms());
    add("R", sun_distance_terms());
    std::map<std::string, std::size_t> compared;
    MaxError error("SPA's terms", "(all units)", 0.0);
    for (const ReferenceRow& row : read_reference(path)) {
        const std::string& name = row.text("series");
        const auto i = static_cast<std::size_t>(row.number("i"));
        ++compared[name];
        SCOPED_TRACE(fmt::format("{} {}", name, i));
        if (name == "NUT") {
            ASSERT_LT(i, nutation_terms().size());
            const NutationTerm& term = nutation_terms()[i];
            constexpr const char* kColumns[] = {"A_or_Y0", "B_or_Y1", "C_or_Y2", "Y3", "Y4"};
            for (std::size_t k = 0; k < 5; ++k) error.add(term.y[k] - row.number(kColumns[k]));
            error.add(term.a - row.number("a"));
            error.add(term.b - row.number("b"));
            error.add(term.c - row.number("c"));
            error.add(term.d - row.number("d"));
        } else {
            ASSERT_TRUE(series.contains(name));
            ASSERT_LT(i, series[name].size());
            const PeriodicTerm& term = series[name][i];
            error.add(term.a - row.number("A_or_Y0"));
            error.add(term.b - row.number("B_or_Y1"));
            error.add(term.c - row.number("C_or_Y2"));
        }
    }
    for (const auto& [name, terms] : series) EXPECT_LE(compared[name], terms.size()) << name;
    std::size_t total = nutation_terms().size();
    for (const auto& [name, terms] : series) total += terms.size();
    EXPECT_EQ(total, 258u);
}

// Truth: pvlib's port of SPA, and ERFA (rigorous, no refraction) with SPA's own error.
TEST(SolarPosition, AgreesWithPvlibAndErfa) {
    const auto path = test_data("reference/solar_position.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 20u);
    MaxError spa_elevation("elevation against pvlib's SPA", "deg", 2e-6);
    MaxError spa_apparent("apparent elevation against pvlib's SPA", "deg", 2e-6);
    MaxError spa_azimuth("azimuth times cos(elevation) against pvlib's SPA", "deg", 2e-6);
    MaxError spa_equation("equation of time against pvlib's SPA", "min", 2e-5);
    MaxError erfa_elevation("elevation against ERFA", "deg", 0.0005);
    MaxError erfa_azimuth("azimuth times cos(elevation) against ERFA", "deg", 0.0005);
    MaxError erfa_declination("declination against ERFA", "deg", 0.0005);
    MaxError erfa_distance("distance against ERFA", "AU", 5e-6);
    MaxError defaults("elevation without being told ΔT and weather", "deg", 0.0001);  // what a second of ΔT does
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id"));
        const Site site = site_of(row.number("lat_deg"), row.number("lon_deg"), row.number("elev_m"));
        const UtcTime time = parse_instant(row.text("utc"), std::nullopt).utc;
        const SolarPosition sun = solar_position(time, site,
                                                 {.delta_t_s = row.number("delta_t_s"),
                                                  .pressure_hpa = row.number("pressure_hpa"),
                                                  .temperature_c = row.number("temp_c")});
        const double elevation = degrees_from_radians(sun.elevation_rad);
        const double azimuth = degrees_from_radians(sun.azimuth_rad);
        spa_elevation.add(elevation - row.number("spa_alt_true_deg"));
        erfa_elevation.add(elevation - row.number("erfa_alt_true_deg"));
        spa_apparent.add(degrees_from_radians(sun.apparent_elevation_rad) - row.number("spa_alt_apparent_deg"));
        erfa_declination.add(degrees_from_radians(sun.declination_rad) - row.number("erfa_declination_deg"));
        erfa_distance.add(sun.distance_au - row.number("erfa_distance_au"));
        spa_equation.add(sun.equation_of_time_min - row.number("spa_eqtime_min"));
        if (std::abs(row.number("lat_deg")) < 89.9) {  // at the pole an azimuth says nothing
            const double weight = std::cos(sun.elevation_rad);
            spa_azimuth.add(degrees_apart(azimuth, row.number("spa_azimuth_deg")) * weight);
            erfa_azimuth.add(degrees_apart(azimuth, row.number("erfa_azimuth_deg")) * weight);
        }
        defaults.add(degrees_from_radians(solar_position(time, site).elevation_rad) - elevation);
    }
}

// Truth: the values of ΔT that SKY_MODELS and the IERS give; and no jumps where the table meets the parabola.
TEST(SolarPosition, DeltaTFollowsTheObservations) {
    EXPECT_NEAR(delta_t_s(1985), 54.3, 0.5);
    EXPECT_NEAR(delta_t_s(2000), 63.8, 0.5);
    EXPECT_NEAR(delta_t_s(2010), 66.1, 0.5);
    EXPECT_NEAR(delta_t_s(2025.5), 69.2, 0.5);
    EXPECT_NEAR(delta_t_s(2149.999), delta_t_s(2150.001), 0.1);
}

// Truth: ERFA, bisection on the geocentric altitude −0.8333°.
TEST(SolarEvents, AgreeWithErfa) {
    const auto path = test_data("reference/solar_events.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 8u);
    std::array<MaxError, 3> errors{MaxError{"rise, transit, set to 60° latitude, against ERFA", "s", 3.0},
                                   MaxError{"rise, transit, set, 60° to 70° latitude", "s", 15.0},
                                   MaxError{"rise, transit, set beyond 70° latitude", "s", 60.0}};
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id") + " " + row.text("site"));
        const std::string& date = row.text("local_solar_date");
        const double latitude = row.number("lat_deg");
        const Site site = site_of(latitude, row.number("lon_deg"), 0.0);
        const UtcTime noon = local_mean_noon(std::stoi(date.substr(0, 4)), std::stoi(date.substr(5, 2)),
                                             std::stoi(date.substr(8, 2)), site);
        const SolarEvents events = solar_events(noon, site);
        EXPECT_EQ(solar_events(UtcTime{noon.milliseconds - 43'200'000}, site).transit, events.transit)
            << "the day begins at its midnight";
        const std::string& state = row.text("state");
        EXPECT_EQ(events.kind, state == "normal"         ? SolarDayKind::normal
                               : state == "midnight_sun" ? SolarDayKind::midnight_sun
                                                         : SolarDayKind::polar_night);
        MaxError& error = errors[std::abs(latitude) <= 60.0 ? 0 : std::abs(latitude) <= 70.0 ? 1 : 2];
        const auto expect_at = [&](const std::optional<UtcTime>& time, const char* column) {
            ASSERT_EQ(time.has_value(), row.has(column)) << column;
            if (!time) return;
            const double expected_s = seconds_since_1970(parse_instant(row.text(column), std::nullopt).utc);
            error.add(seconds_since_1970(*time) - expected_s);
        };
        expect_at(events.sunrise, "erfa_sunrise_utc");
        expect_at(events.sunset, "erfa_sunset_utc");
        if (row.has("erfa_transit_utc")) expect_at(events.transit, "erfa_transit_utc");
    }
}

// Truth: geometry. East is +x, north +y; a grid turned by the convergence sees the same sun at azimuth − convergence.
TEST(WorldDirection, AppliesTheConvergence) {
    const Vec3d east = world_direction(radians_from_degrees(90.0), 0.0, 0.0);
    EXPECT_NEAR(east.x, 1.0, 1e-12);
    EXPECT_NEAR(east.y, 0.0, 1e-12);
    const Vec3d along_grid_north =
        world_direction(radians_from_degrees(2.0), radians_from_degrees(30.0), radians_from_degrees(2.0));
    EXPECT_NEAR(along_grid_north.x, 0.0, 1e-12);
    EXPECT_NEAR(along_grid_north.y, std::cos(kPi / 6.0), 1e-12);
    EXPECT_NEAR(along_grid_north.z, 0.5, 1e-12);
}

}  // namespace
}  // namespace skybake
