#include "sky/daylight_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sky/sky_level.h"
#include "sky/solar_position.h"
#include "sky/sun_beam.h"
#include "sky/text_numbers.h"
#include "sky/weather_light.h"

namespace skybake {

namespace {

/// "A,B" as two numbers.
std::optional<std::pair<double, double>> pair_of(std::string_view text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    std::string_view second = text.substr(comma + 1);
    while (!second.empty() && second.front() == ' ') second.remove_prefix(1);
    const auto a = number_of(text.substr(0, comma));
    const auto b = number_of(second);
    if (!a || !b) return std::nullopt;
    return std::pair{*a, *b};
}

void find_turbidity(double turbidity, FindingLog& findings) {
    if (turbidity >= 2.0 && turbidity <= 10.0) return;
    const double used = std::clamp(turbidity, kPreethamLeastTurbidity, kPreethamMostTurbidity);
    findings.add(
        {"SB601", Severity::warning, "--sky",
         fmt::format(
             "a turbidity of {:g} is outside 2…10, where the Preetham sky is trusted{}.", turbidity,
             used == turbidity ? "" : fmt::format("; its distribution and colour are those of turbidity {:g}", used)),
         "Take 2 for very clear, 3 for clear, 6 for hazy air."});
}

void find_low_sun(const SkySettings& sky, const SeenSun& sun, const std::string& where, FindingLog& findings) {
    if (sun.elevation_rad > 0.0) return;
    const double below_deg = -degrees_from_radians(sun.elevation_rad);
    const char* sky_then = !needs_sun(sky)                              ? ""
                           : std::holds_alternative<PerezSettings>(sky) ? ", and the sky is that of a sun on it"
                                                                        : ", and the sky is that of sunset, faded to "
                                                                          "the twilight's illuminance";
    findings.add({"SB602", Severity::warning, where,
                  fmt::format("the sun is {:.2f}° below the horizon: it gives no direct light{}.", below_deg, sky_then),
                  "Choose a time between sunrise and sunset."});
}

void find_odd_weather(const PerezSettings& perez, const SeenSun& sun, const std::string& where, FindingLog& findings) {
    const auto add = [&](std::string what) {
        findings.add({"SB605", Severity::warning, where, std::move(what),
                      "Check the irradiances against the hour of the day (W/m²)."});
    };
    const double outside = kPerezSolarConstant / (sun.distance_au * sun.distance_au);
    if (perez.dni_w_m2 > outside)
        add(fmt::format("a DNI of {:g} W/m² is more than the {:.0f} W/m² that arrive outside the atmosphere.",
                        perez.dni_w_m2, outside));
    if (perez.dhi_w_m2 <= 0.0 || sun.elevation_rad <= 0.0) return;
    const PerezClass state = perez_state({perez.dni_w_m2, perez.dhi_w_m2, sun.distance_au}, sun.zenith_rad()).sky;
    if (state.clearness > kPerezMostClearness)
        add(fmt::format("DNI and DHI make a clearness ε = {:.1f}; the Perez sky knows skies up to {:g} and takes that.",
                        state.clearness, kPerezMostClearness));
    if (state.brightness < kPerezLeastBrightness || state.brightness > kPerezMostBrightness)
        add(fmt::format("the DHI makes a brightness Δ = {:.3f}; the Perez sky knows {:g}…{:g} and takes the nearer.",
                        state.brightness, kPerezLeastBrightness, kPerezMostBrightness));
}

/// An instant's sun, named for the user.
struct NamedSun {
    std::string label;
    std::string where;  // the option that placed it, for findings
    double azimuth_rad = 0.0;
    double elevation_rad = 0.0;  // apparent
    double distance_au = 1.0;
};

Daylight daylight_of(const DaylightSettings& settings, const SkySettings& sky, const std::optional<WeatherHour>& hour,
                     const NamedSun& named, double convergence_rad, FindingLog& findings) {
    const SeenSun sun{named.elevation_rad, named.distance_au,
                      world_direction(named.azimuth_rad, named.elevation_rad, convergence_rad)};
    find_low_sun(sky, sun, named.where, findings);
    if (const auto* perez = std::get_if<PerezSettings>(&sky)) find_odd_weather(*perez, sun, named.where, findings);
    Daylight daylight;
    daylight.label = named.label;
    daylight.sky = sky_model(sky, sun, convergence_rad);
    daylight.turbidity = air_turbidity(sky, sun);
    daylight.sun.direction = Vec3f(sun.direction);
    daylight.sun.shape = settings.sun;
    daylight.sun.angular_radius_rad = static_cast<float>(kSunAngularRadiusRad / sun.distance_au);
    if (settings.sun != SunShape::none) {
        const Beam beam = sun_beam(hour ? SkySettings(weather_sky(*hour)) : sky, sun);
        daylight.sun.normal_illuminance = rgb_from_xyz(beam.normal_illuminance);
        daylight.sun.dni_w_m2 = static_cast<float>(beam.dni_w_m2);
    }
    return daylight;
}

/// The name of a model in messages.
const char* name_of(const SkySettings& sky) {
    constexpr const char* kNames[] = {"Preetham", "uniform", "missing", "Perez", "CIE", "CIE", "image"};
    return kNames[sky.index()];
}

bool is_dark(const SkySettings& sky, bool has_beam) {
    if (const auto* perez = std::get_if<PerezSettings>(&sky))
        return perez->dhi_w_m2 <= 0.0 && (!has_beam || perez->dni_w_m2 <= 0.0);
    return std::holds_alternative<NoSkySettings>(sky) && !has_beam;
}

}  // namespace

SunShape parse_sun_shape(std::string_view text) {
    if (text == "point") return SunShape::point;
    if (text == "disc") return SunShape::disc;
    if (text == "none") return SunShape::none;
    throw InputError(fmt::format("--sun '{}': it is point, disc or none.", text));
}

SunDirection parse_sun_direction(std::string_view text) {
    const auto angles = pair_of(text);
    if (!angles || std::abs(angles->first) > 360.0 || std::abs(angles->second) > 90.0) {
        throw InputError(
            fmt::format("--sun-direction '{}': it is AZIMUTH,ELEVATION in degrees: the azimuth clockwise from true "
                        "north (-360…360), the "
                        "elevation above the horizon (-90…90). For example 180,45 for a sun in the south.",
                        text));
    }
    return {radians_from_degrees(angles->first), radians_from_degrees(angles->second)};
}

Site parse_site(std::string_view text) {
    const auto degrees = pair_of(text);
    if (!degrees || std::abs(degrees->first) > 90.0 || std::abs(degrees->second) > 180.0) {
        throw InputError(fmt::format(
            "--site '{}': it is LATITUDE,LONGITUDE in degrees, north and east positive (-90…90, -180…180). For example "
            "47.07,15.44 for Graz.",
            text));
    }
    return {radians_from_degrees(degrees->first), radians_from_degrees(degrees->second), 0.0};
}

SkySettings sky_at(const DaylightSettings& settings, std::size_t instant) {
    if (!settings.weather) return settings.sky;
    return sky_of_weather(settings.sky, weather_of(*settings.weather, settings.instants.at(instant)));
}

std::optional<Site> site_of_light(const DaylightSettings& settings, const std::optional<Site>& site) {
    return site || !settings.weather ? site : settings.weather->station.site;
}

std::vector<Daylight> make_daylights(const DaylightSettings& settings, const std::optional<Site>& known_site,
                                     double convergence_rad, FindingLog& findings) {
    const std::optional<Site> site = site_of_light(settings, known_site);
    if (settings.weather && settings.instants.empty()) {
        throw InputError("--weather needs to know the hour: give --at TIME, for example --at 2026-06-21T12:00+02:00.");
    }
    if (!settings.instants.empty() && settings.sun_direction) {
        throw InputError("--at and --sun-direction both place the sun; give one of them.");
    }
    const bool has_sun = !settings.instants.empty() || settings.sun_direction.has_value();
    if (!has_sun && needs_sun(settings.sky)) {
        throw InputError(fmt::format(
            "the {} sky needs to know where the sun is: give --at TIME (for example --at 2026-06-21T12:00+02:00) "
            "or --sun-direction AZIMUTH,ELEVATION; or take --sky uniform.",
            name_of(settings.sky)));
    }
    if (!settings.instants.empty() && !site) {
        throw InputError(
            "--at needs to know where on Earth the city is, and its coordinate reference system does not tell: give "
            "--site LAT,LON in degrees, "
            "for example --site 47.07,15.44, or --sun-direction AZIMUTH,ELEVATION instead of --at.");
    }
    if (settings.weather) find_weather(settings, known_site, findings);
    if (const auto* preetham = std::get_if<PreethamSettings>(&settings.sky)) {
        find_turbidity(preetham->turbidity, findings);
        if (!settings.weather && preetham->level == SkyLevel::published) {
            findings.add({"SB603", Severity::info, "--sky",
                          "the published level of the Preetham sky is up to 1.7 times too bright.",
                          "Take level=clearsky for numbers that are to be relied on."});
        }
    }
    if (const auto* image = std::get_if<ImageSettings>(&settings.sky)) {
        for (const Finding& finding : image->findings) findings.add(finding);
    }
    if (!settings.weather && is_dark(settings.sky, has_sun && settings.sun != SunShape::none)) {
        findings.add({"SB604", Severity::warning, "--sky " + to_text(settings.sky),
                      "there is neither sky nor sun: all is dark.", "Give --at, --sun-direction or another --sky."});
    }

    std::vector<Daylight> daylights;
    if (settings.sun_direction) {
        const auto [azimuth, elevation] = *settings.sun_direction;
        const std::string label =
            fmt::format("sun {:.6g},{:.6g}", degrees_from_radians(azimuth), degrees_from_radians(elevation));
        daylights.push_back(daylight_of(settings, settings.sky, std::nullopt,
                                        {label, "--sun-direction", azimuth, elevation, 1.0}, convergence_rad,
                                        findings));
        return daylights;
    }
    if (!has_sun) {
        Daylight daylight;
        daylight.label = "no sun";
        daylight.sky = sky_model(settings.sky, {}, convergence_rad);
        daylight.turbidity = air_turbidity(settings.sky, {});
        daylight.sun.shape = SunShape::none;
        daylights.push_back(daylight);
        return daylights;
    }
    daylights.reserve(settings.instants.size());
    for (std::size_t i = 0; i < settings.instants.size(); ++i) {
        const Instant& instant = settings.instants[i];
        const SolarPosition position = solar_position(instant.utc, *site);
        const std::string label = to_iso8601(instant);
        const NamedSun sun{label, "--at " + label, position.azimuth_rad, position.apparent_elevation_rad,
                           position.distance_au};
        std::optional<WeatherHour> hour;
        if (settings.weather) hour = weather_of(*settings.weather, instant);
        daylights.push_back(daylight_of(settings, sky_at(settings, i), hour, sun, convergence_rad, findings));
    }
    return daylights;
}

}  // namespace skybake
