#include "weather_option.h"

#include <fmt/format.h>

#include "base/vec.h"
#include "io/epw/read_epw.h"

namespace skybake::cli {

void put_weather(DaylightSettings& settings, const std::string& file) {
    settings.weather = io::read_epw(file, settings.weather_findings);
    settle_weather(*settings.weather, settings.weather_findings);
}

nlohmann::json weather_json(const Weather& weather) {
    const WeatherStation& station = weather.station;
    const HourCentre& centre = weather.centre;
    const WeatherSums sums = sums_of(weather);
    return {{"file", weather.name()},
            {"city", station.city},
            {"region", station.region},
            {"country", station.country},
            {"source", station.source},
            {"wmo", station.wmo},
            {"latitude_deg", degrees_from_radians(station.site.latitude_rad)},
            {"longitude_deg", degrees_from_radians(station.site.longitude_rad)},
            {"elevation_m", station.site.elevation_m},
            {"utc_offset_h", station.utc_offset_h},
            {"records_per_hour", weather.records_per_hour},
            {"rows", weather.rows.size()},
            {"rows_left_out", weather.rows_left_out},
            {"rows_expected", expected_rows(weather)},
            {"years", years_of(weather)},
            {"has_leap_day", weather.has_leap_day},
            {"hour_centre_h", centre.offset_h},
            {"hour_centre_detected", centre.is_detected},
            {"hour_centre_confidence", centre.confidence},
            {"residual_w_m2", centre.residual_w_m2},
            {"standard_residual_w_m2", centre.standard_residual_w_m2},
            {"sums_kwh_m2",
             {{"global_horizontal", sums.ghi}, {"direct_normal", sums.dni}, {"diffuse_horizontal", sums.dhi}}}};
}

void print_weather(const Weather& weather) {
    const WeatherStation& station = weather.station;
    const HourCentre& centre = weather.centre;
    const WeatherSums sums = sums_of(weather);
    const std::vector<int> years = years_of(weather);
    fmt::print("{}: {}, {}, {} ({}, {})\n", weather.name(), station.city, station.region, station.country,
               station.source, station.wmo);
    const auto row = [](const char* name, const std::string& value) { fmt::print("{:<28} {}\n", name, value); };
    row("site",
        fmt::format("{:.4f},{:.4f}, {:.0f} m, UTC{:+g} h", degrees_from_radians(station.site.latitude_rad),
                    degrees_from_radians(station.site.longitude_rad), station.site.elevation_m, station.utc_offset_h));
    row("rows", fmt::format("{} of {}, {} an hour, {} left out", weather.rows.size(), expected_rows(weather),
                            weather.records_per_hour, weather.rows_left_out));
    row("years", years.size() == 1 ? fmt::format("{}", years.front())
                                   : fmt::format("{} of {}…{}", years.size(), years.front(), years.back()));
    row("middle of the hours",
        fmt::format("label {:+g} h ({})", centre.offset_h,
                    centre.is_detected ? fmt::format("detected, confidence {:.2f}", centre.confidence)
                                       : "as the format says; not detected"));
    row("GHI - DHI - DNI sin h",
        fmt::format("{:.2f} W/m2 on average, {:.2f} W/m2 at the format's label {:+g} h", centre.residual_w_m2,
                    centre.standard_residual_w_m2, -0.5 * weather.interval_h()));
    row("global horizontal", fmt::format("{:>8.1f} kWh/m2", sums.ghi));
    row("direct normal", fmt::format("{:>8.1f} kWh/m2", sums.dni));
    row("diffuse horizontal", fmt::format("{:>8.1f} kWh/m2", sums.dhi));
}

}  // namespace skybake::cli
