#include "sky/weather_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sky/clear_sky.h"
#include "sky/sun_beam.h"

namespace skybake {

namespace {

constexpr double kFarKm = 100.0;

/// Great-circle distance, km.
double distance_km(const Site& a, const Site& b) {
    const double sine_latitude = std::sin((b.latitude_rad - a.latitude_rad) / 2.0);
    const double sine_longitude = std::sin((b.longitude_rad - a.longitude_rad) / 2.0);
    const double h = sine_latitude * sine_latitude +
                     std::cos(a.latitude_rad) * std::cos(b.latitude_rad) * sine_longitude * sine_longitude;
    return 2.0 * 6371.0 * std::asin(std::min(1.0, std::sqrt(h)));
}

}  // namespace

WeatherHour weather_of(const Weather& weather, const Instant& instant) {
    if (const std::optional<WeatherHour> hour = weather_at(weather, instant.utc)) return *hour;
    const std::vector<int> years = years_of(weather);
    throw InputError(fmt::format(
        "{}: there is no radiation for {}{}. Choose another instant of --at, or fill the gap in the file.",
        weather.file.string(), to_iso8601(instant),
        weather.spans_years ? fmt::format(" (the file goes from {} to {})", years.front(), years.back()) : ""));
}

SkySettings sky_of_weather(const SkySettings& asked, const WeatherHour& hour) {
    if (const auto* preetham = std::get_if<PreethamSettings>(&asked))
        return PreethamSettings{preetham->turbidity, SkyLevel::dhi, hour.dhi_w_m2};
    return asked;
}

void set_beam(SunBeam& beam, const WeatherHour& hour, double turbidity, double sun_zenith_rad, double distance_au) {
    const double clear_lx = static_cast<double>(luminance(beam.normal_illuminance));
    if (!(clear_lx > 0.0)) return;  // on and below the horizon, and without a sun
    const double zenith = std::min(sun_zenith_rad, radians_from_degrees(85.0));
    const double efficacy_lm_w = sun_normal_illuminance(turbidity, zenith, distance_au).y /
                                 clear_sky_irradiance(turbidity, zenith, distance_au).dni;
    beam.normal_illuminance *= static_cast<float>(hour.dni_w_m2 * efficacy_lm_w / clear_lx);
    beam.dni_w_m2 = static_cast<float>(hour.dni_w_m2);
}

void find_weather(const DaylightSettings& settings, const std::optional<Site>& site, FindingLog& findings) {
    const Weather& weather = *settings.weather;
    findings.merge(settings.weather_findings);
    const Site& station = weather.station.site;
    const std::string place = fmt::format("{:.4f},{:.4f}", degrees_from_radians(station.latitude_rad),
                                          degrees_from_radians(station.longitude_rad));
    if (!site) {
        findings.add(
            {"SB711", Severity::info, weather.name(),
             fmt::format("neither --site nor the city says where on Earth it is: it is taken to be at {} ({}).", place,
                         weather.station.city),
             "Pass --site LAT,LON where the city stands elsewhere."});
    } else if (const double km = distance_km(*site, station); km > kFarKm) {
        findings.add(
            {"SB712", Severity::warning, weather.name(),
             fmt::format("the weather is that of {} ({}), {:.0f} km from the site.", place, weather.station.city, km),
             "Take the weather file of a nearer place."});
    }
    for (const Instant& instant : settings.instants) {
        if (!weather_of(weather, instant).is_leap_day_replaced) continue;
        findings.add({"SB713", Severity::info, weather.name(),
                      fmt::format("{} is 29 February, which the file does not have.", to_iso8601(instant)),
                      "Nothing to do: the weather is that of 28 February."});
    }
}

}  // namespace skybake
