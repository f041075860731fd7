#include "sky/solar_position.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sky/solar_terms.h"

namespace skybake {

namespace {

double wrap_two_pi(double angle) {
    const double wrapped = std::fmod(angle, 2.0 * kPi);
    return wrapped < 0.0 ? wrapped + 2.0 * kPi : wrapped;
}

double wrap_pi(double angle) {
    const double wrapped = wrap_two_pi(angle);
    return wrapped > kPi ? wrapped - 2.0 * kPi : wrapped;
}

/// Eq. 9–11: Σ τⁿ Σ A cos(B + C τ), in 1 (rad or AU).
template <std::size_t N>
double periodic_sum(const std::array<std::span<const PeriodicTerm>, N>& series, double millennia) {
    double sum = 0.0;
    for (std::size_t n = N; n-- > 0;) {
        double order = 0.0;
        for (const PeriodicTerm& term : series[n]) order += term.a * std::cos(term.b + term.c * millennia);
        sum = sum * millennia + order;
    }
    return sum * 1e-8;
}

struct Nutation {
    double longitude_rad;
    double obliquity_rad;
};

/// §3.4, eq. 15–23.
Nutation nutation(double t) {
    const double t2 = t * t;
    const double t3 = t2 * t;
    const double x[5] = {radians_from_degrees(297.85036 + 445267.111480 * t - 0.0019142 * t2 + t3 / 189474.0),
                         radians_from_degrees(357.52772 + 35999.050340 * t - 0.0001603 * t2 - t3 / 300000.0),
                         radians_from_degrees(134.96298 + 477198.867398 * t + 0.0086972 * t2 + t3 / 56250.0),
                         radians_from_degrees(93.27191 + 483202.017538 * t - 0.0036825 * t2 + t3 / 327270.0),
                         radians_from_degrees(125.04452 - 1934.136261 * t + 0.0020708 * t2 + t3 / 450000.0)};
    double longitude = 0.0;
    double obliquity = 0.0;
    for (const NutationTerm& term : nutation_terms()) {
        double argument = 0.0;
        for (std::size_t j = 0; j < 5; ++j) argument += x[j] * term.y[j];
        longitude += (term.a + term.b * t) * std::sin(argument);
        obliquity += (term.c + term.d * t) * std::cos(argument);
    }
    return {radians_from_degrees(longitude / 36e6), radians_from_degrees(obliquity / 36e6)};
}

/// Eq. 24, arcseconds.
double mean_obliquity_arcsec(double millennia) {
    const double u = millennia / 10.0;
    constexpr double kCoefficients[] = {84381.448, -4680.93, -1.55, 1999.25, -51.38, -249.67,
                                        -39.05,    7.12,     27.87, 5.79,    2.45};
    double sum = 0.0;
    for (std::size_t i = std::size(kCoefficients); i-- > 0;) sum = sum * u + kCoefficients[i];
    return sum;
}

/// Pressure of the international standard atmosphere (ISO 2533), hPa.
double standard_pressure_hpa(double elevation_m) {
    return 1013.25 * std::pow(std::max(0.0, 1.0 - 2.25577e-5 * elevation_m), 5.25588);
}

/// Eq. 42; the lower limit is that of the published code: the sun's upper limb on the horizon.
double refraction_rad(double elevation_rad, double pressure_hpa, double temperature_c) {
    const double elevation_deg = degrees_from_radians(elevation_rad);
    if (elevation_deg < -(0.26667 + 0.5667)) return 0.0;
    const double refraction_deg =
        pressure_hpa / 1010.0 * 283.0 / (273.0 + temperature_c) * 1.02 /
        (60.0 * std::tan(radians_from_degrees(elevation_deg + 10.3 / (elevation_deg + 5.11))));
    return radians_from_degrees(refraction_deg);
}

struct DeltaT {
    double year;
    double seconds;
};
/// Observed values (Espenak & Meeus 2006, IERS since 1973), and the parabola where the table ends.
constexpr DeltaT kDeltaT[] = {
    {1600, 120},  {1620, 98},   {1640, 67},   {1660, 35},   {1680, 16},   {1700, 9},    {1720, 11},   {1740, 12},
    {1760, 15},   {1780, 17},   {1800, 13.7}, {1810, 12.5}, {1820, 12},   {1830, 7.5},  {1840, 5.7},  {1850, 7.1},
    {1860, 7.9},  {1870, 1.6},  {1880, -5.4}, {1890, -5.9}, {1900, -2.7}, {1910, 10.5}, {1920, 21.2}, {1930, 24},
    {1940, 24.3}, {1950, 29.1}, {1960, 33.2}, {1970, 40.2}, {1980, 50.5}, {1985, 54.3}, {1990, 56.9}, {1995, 60.8},
    {2000, 63.8}, {2005, 64.7}, {2010, 66.1}, {2015, 67.6}, {2020, 69.4}, {2024, 69.2}, {2026, 69.2}, {2150, 328.5}};

}  // namespace

double delta_t_s(double year) {
    if (year < kDeltaT[0].year || year >= std::end(kDeltaT)[-1].year) {
        const double centuries = (year - 1820.0) / 100.0;
        return -20.0 + 32.0 * centuries * centuries;
    }
    const DeltaT* after = std::upper_bound(std::begin(kDeltaT), std::end(kDeltaT), year,
                                           [](double y, const DeltaT& d) { return y < d.year; });
    const DeltaT* before = after - 1;
    return before->seconds + (after->seconds - before->seconds) * (year - before->year) / (after->year - before->year);
}

GeocentricSun geocentric_sun(double julian_day, double delta_t_s) {
    const double days = julian_day - 2451545.0;
    const double jc = days / 36525.0;
    const double jce = (days + delta_t_s / 86400.0) / 36525.0;
    const double jme = jce / 10.0;

    GeocentricSun sun;
    sun.heliocentric_longitude_rad = wrap_two_pi(periodic_sum(heliocentric_longitude_terms(), jme));
    sun.heliocentric_latitude_rad = periodic_sum(heliocentric_latitude_terms(), jme);
    sun.distance_au = periodic_sum(sun_distance_terms(), jme);
    const double theta = sun.heliocentric_longitude_rad + kPi;
    const double beta = -sun.heliocentric_latitude_rad;

    const auto [delta_psi, delta_epsilon] = nutation(jce);
    sun.nutation_longitude_rad = delta_psi;
    sun.nutation_obliquity_rad = delta_epsilon;
    sun.obliquity_rad = radians_from_degrees(mean_obliquity_arcsec(jme) / 3600.0) + delta_epsilon;

    const double aberration = radians_from_degrees(-20.4898 / (3600.0 * sun.distance_au));
    const double lambda = theta + delta_psi + aberration;
    const double sin_epsilon = std::sin(sun.obliquity_rad);
    const double cos_epsilon = std::cos(sun.obliquity_rad);
    sun.sidereal_time_rad = wrap_two_pi(radians_from_degrees(std::fmod(360.98564736629 * days, 360.0) + 280.46061837 +
                                                             0.000387933 * jc * jc - jc * jc * jc / 38710000.0) +
                                        delta_psi * cos_epsilon);
    sun.right_ascension_rad =
        wrap_two_pi(std::atan2(std::sin(lambda) * cos_epsilon - std::tan(beta) * sin_epsilon, std::cos(lambda)));
    sun.declination_rad = std::asin(std::sin(beta) * cos_epsilon + std::cos(beta) * sin_epsilon * std::sin(lambda));

    // Appendix A1.
    const double mean_longitude_deg = 280.4664567 + 360007.6982779 * jme + 0.03032028 * jme * jme +
                                      std::pow(jme, 3) / 49931.0 - std::pow(jme, 4) / 15300.0 - std::pow(jme, 5) / 2e6;
    const double equation_rad = wrap_pi(radians_from_degrees(std::fmod(mean_longitude_deg, 360.0) - 0.0057183) -
                                        sun.right_ascension_rad + delta_psi * cos_epsilon);
    sun.equation_of_time_min = 4.0 * degrees_from_radians(equation_rad);
    return sun;
}

SolarPosition solar_position(UtcTime time, const Site& site, const SolarPositionOptions& options) {
    const double julian_day = seconds_since_1970(time) / 86400.0 + 2440587.5;
    const double delta_t = options.delta_t_s.value_or(delta_t_s(decimal_year(time)));
    const GeocentricSun sun = geocentric_sun(julian_day, delta_t);
    const double hour_angle = wrap_pi(sun.sidereal_time_rad + site.longitude_rad - sun.right_ascension_rad);

    // §3.12: parallax.
    const double sin_latitude = std::sin(site.latitude_rad);
    const double cos_latitude = std::cos(site.latitude_rad);
    const double sin_xi = std::sin(radians_from_degrees(8.794 / (3600.0 * sun.distance_au)));
    const double u = std::atan(0.99664719 * std::tan(site.latitude_rad));
    const double x = std::cos(u) + site.elevation_m / 6378140.0 * cos_latitude;
    const double y = 0.99664719 * std::sin(u) + site.elevation_m / 6378140.0 * sin_latitude;
    const double sin_declination = std::sin(sun.declination_rad);
    const double cos_declination = std::cos(sun.declination_rad);
    const double shortened = cos_declination - x * sin_xi * std::cos(hour_angle);
    const double delta_alpha = std::atan2(-x * sin_xi * std::sin(hour_angle), shortened);
    const double topocentric_declination =
        std::atan2((sin_declination - y * sin_xi) * std::cos(delta_alpha), shortened);
    const double topocentric_hour_angle = hour_angle - delta_alpha;

    SolarPosition position;
    const double sin_elevation = sin_latitude * std::sin(topocentric_declination) +
                                 cos_latitude * std::cos(topocentric_declination) * std::cos(topocentric_hour_angle);
    position.elevation_rad = std::asin(std::clamp(sin_elevation, -1.0, 1.0));
    const double azimuth_from_south =
        std::atan2(std::sin(topocentric_hour_angle),
                   std::cos(topocentric_hour_angle) * sin_latitude - std::tan(topocentric_declination) * cos_latitude);
    position.azimuth_rad = wrap_two_pi(azimuth_from_south + kPi);
    const double pressure = options.pressure_hpa.value_or(standard_pressure_hpa(site.elevation_m));
    position.apparent_elevation_rad =
        position.elevation_rad + refraction_rad(position.elevation_rad, pressure, options.temperature_c);
    position.distance_au = sun.distance_au;
    position.equation_of_time_min = sun.equation_of_time_min;
    position.declination_rad = sun.declination_rad;
    position.hour_angle_rad = hour_angle;
    position.geocentric_elevation_rad = std::asin(
        std::clamp(sin_latitude * sin_declination + cos_latitude * cos_declination * std::cos(hour_angle), -1.0, 1.0));
    return position;
}

Vec3d world_direction(double true_azimuth_rad, double elevation_rad, double convergence_rad) {
    const double grid_azimuth = true_azimuth_rad - convergence_rad;
    return {std::sin(grid_azimuth) * std::cos(elevation_rad), std::cos(grid_azimuth) * std::cos(elevation_rad),
            std::sin(elevation_rad)};
}

}  // namespace skybake
