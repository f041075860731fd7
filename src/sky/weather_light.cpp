#include "sky/weather_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

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

PerezSettings weather_sky(const WeatherHour& hour) {
    PerezSettings perez{hour.dni_w_m2, hour.dhi_w_m2};
    if (hour.dew_point_c) perez.precipitable_water_cm = std::exp(0.07 * *hour.dew_point_c - 0.075);
    return perez;
}

SkySettings sky_of_weather(const SkySettings& asked, const WeatherHour& hour) {
    if (std::holds_alternative<PerezSettings>(asked)) return weather_sky(hour);
    SkySettings sky = asked;
    if (auto* preetham = std::get_if<PreethamSettings>(&sky)) {
        preetham->level = SkyLevel::dhi;
        preetham->dhi_w_m2 = hour.dhi_w_m2;
    }
    if (auto* cie = std::get_if<CieSettings>(&sky); cie && !cie->zenith_cd_m2) cie->dhi_w_m2 = hour.dhi_w_m2;
    if (auto* cie = std::get_if<Cie1994Settings>(&sky); cie && !cie->zenith_cd_m2) cie->dhi_w_m2 = hour.dhi_w_m2;
    return sky;
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
