// Where the sun stands. Based on: Reda & Andreas, "Solar position algorithm for solar radiation applications", Solar
// Energy 76 (2004) and NREL/TP-560-34302 (revised 2008); the algorithm whole, in double precision.
#pragma once

#include <optional>

#include "base/site.h"
#include "base/vec.h"
#include "sky/utc_time.h"

namespace skybake {

struct SolarPositionOptions {
    std::optional<double> delta_t_s = std::nullopt;  // TT − UT1; default: delta_t_s(year)
    std::optional<double> pressure_hpa =
        std::nullopt;             // for the refraction; default: the standard atmosphere at the site's elevation
    double temperature_c = 12.0;  // for the refraction; a year's mean of mid latitudes
};

/// Angles in radians; azimuth clockwise from true north in [0, 2π).
struct SolarPosition {
    double azimuth_rad = 0.0;
    double elevation_rad = 0.0;  // geometric: topocentric, without refraction
    double apparent_elevation_rad =
        0.0;  // with refraction, where the light comes from; equal to the geometric one below −0.8334°
    double distance_au = 1.0;
    double equation_of_time_min = 0.0;      // apparent minus mean solar time
    double declination_rad = 0.0;           // geocentric
    double hour_angle_rad = 0.0;            // geocentric, of the site, in (−π, π]; 0 at the upper transit
    double geocentric_elevation_rad = 0.0;  // from the Earth's centre, without parallax: what sunrise tables use
};

/// The sun's place for an instant and a site. Error of the algorithm 0.0003° for the years −2000…6000; UTC stands for
/// UT1 (off by less than 0.9 s, which is 0.004°). Costs about 5 µs. Thread-safe.
SolarPosition solar_position(UtcTime time, const Site& site, const SolarPositionOptions& options = {});

/// Terrestrial time minus universal time, seconds, for a (decimal) year: linear between observed values from 1600 to
/// 2026 (error below 3 s, which moves the sun by 0.00004°), the parabola of Morrison & Stephenson 2004 outside, joined
/// linearly until 2150.
double delta_t_s(double year);

/// The geocentric quantities of SPA for one Julian day; only tests and solar_position need them apart. Angles in
/// radians.
struct GeocentricSun {
    double heliocentric_longitude_rad = 0.0;  // L
    double heliocentric_latitude_rad = 0.0;   // B
    double distance_au = 1.0;                 // R
    double nutation_longitude_rad = 0.0;      // Δψ
    double nutation_obliquity_rad = 0.0;      // Δε
    double obliquity_rad = 0.0;               // ε
    double right_ascension_rad = 0.0;
    double declination_rad = 0.0;
    double sidereal_time_rad = 0.0;  // apparent, Greenwich
    double equation_of_time_min = 0.0;
};
GeocentricSun geocentric_sun(double julian_day, double delta_t_s);

/// The unit vector towards azimuth (clockwise from true north) and elevation, in the world frame (x grid east, y grid
/// north, z up). The true azimuth of grid north is `convergence_rad`: azimuth_true = azimuth_grid + convergence.
Vec3d world_direction(double true_azimuth_rad, double elevation_rad, double convergence_rad);

}  // namespace skybake
