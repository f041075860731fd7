#include "sky/daylight_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/nearest_word.h"
#include "sky/clear_sky.h"
#include "sky/solar_position.h"
#include "sky/sun_beam.h"
#include "sky/weather_light.h"

namespace skybake {

namespace {

constexpr double kPrecipitableWaterCm = 2.0;  // of the beam and of clear_sky_irradiance

std::optional<double> number_of(std::string_view text) {
    double value = 0.0;
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

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

/// The k=v pairs behind a sky's name.
class SkyOptions {
  public:
    SkyOptions(std::string_view whole, std::string_view options) : whole_(whole) {
        while (!options.empty()) {
            const std::size_t comma = options.find(',');
            const std::string_view option = options.substr(0, comma);
            const std::size_t equals = option.find('=');
            if (equals == std::string_view::npos) refuse(fmt::format("'{}' is not KEY=VALUE", option));
            const std::string key(option.substr(0, equals));
            if (find(key)) refuse(fmt::format("'{}' is given twice", key));
            pairs_.emplace_back(key, option.substr(equals + 1));
            if (comma == std::string_view::npos) break;
            options.remove_prefix(comma + 1);
            if (options.empty()) refuse("it ends in a comma");
        }
    }
    void allow(const std::vector<std::string>& known) const {
        for (const auto& [key, value] : pairs_) {
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            refuse(fmt::format("there is no key '{}'; did you mean '{}'? Known keys: {}", key, nearest_word(key, known),
                               fmt::join(known, ", ")));
        }
    }
    std::optional<std::string_view> find(std::string_view key) const {
        for (const auto& [k, value] : pairs_) {
            if (k == key) return value;
        }
        return std::nullopt;
    }
    double number(std::string_view key, double low, double high, double otherwise, const char* unit) const {
        const auto text = find(key);
        return text ? checked_number(key, *text, low, high, unit) : otherwise;
    }
    double checked_number(std::string_view key, std::string_view text, double low, double high,
                          const char* unit) const {
        const auto value = number_of(text);
        if (!value || *value < low || *value > high) {
            refuse(fmt::format("{}={} is not a number in {:g}…{:g}{}", key, text, low, high, unit));
        }
        return *value;
    }
    [[noreturn]] void refuse(const std::string& why) const {
        throw InputError(fmt::format("--sky '{}': {}.", whole_, why));
    }

  private:
    std::string_view whole_;
    std::vector<std::pair<std::string, std::string_view>> pairs_;
};

double turbidity_of(const SkyOptions& options) {
    return options.number("turbidity", 1.0, 60.0, kDefaultTurbidity, "");
}

PreethamSettings preetham_settings(const SkyOptions& options) {
    options.allow({"turbidity", "level", "dhi"});
    PreethamSettings settings;
    settings.turbidity = turbidity_of(options);
    // "level=dhi=150" and plain "dhi=150" mean the same.
    std::optional<std::string_view> dhi = options.find("dhi");
    if (const auto level = options.find("level")) {
        if (dhi) options.refuse("level and dhi exclude each other");
        if (level->starts_with("dhi=")) {
            dhi = level->substr(4);
        } else if (*level == "published") {
            settings.level = SkyLevel::published;
        } else if (*level != "clearsky") {
            options.refuse(fmt::format("there is no level '{}'; known levels: clearsky, published, dhi=W", *level));
        }
    }
    if (dhi) {
        settings.level = SkyLevel::dhi;
        settings.dhi_w_m2 = options.checked_number("dhi", *dhi, 0.0, 1500.0, " W/m²");
    }
    return settings;
}

double turbidity_of(const SkySettings& sky) {
    return std::visit([](const auto& settings) { return settings.turbidity; }, sky);
}

/// The sun as all models need it: where it is seen, and how far away it is.
struct SeenSun {
    std::string label;
    std::string where;  // the option that placed it, for findings
    double azimuth_rad = 0.0;
    double elevation_rad = 0.0;  // apparent
    double distance_au = 1.0;
    double zenith_rad() const { return kPi / 2.0 - elevation_rad; }
};

PreethamSky levelled_sky(const PreethamSettings& settings, const SeenSun& sun, const Vec3d& direction) {
    const double day_zenith =
        std::min(sun.zenith_rad(), radians_from_degrees(87.0));  // where all the formulas for daytime still hold
    const ClearSkyIrradiance day = clear_sky_irradiance(settings.turbidity, day_zenith, sun.distance_au);
    const double dhi = settings.level == SkyLevel::dhi && settings.dhi_w_m2 > 0.0 ? settings.dhi_w_m2 : day.dhi;
    const double extraterrestrial = kSolarConstant / (sun.distance_au * sun.distance_au);
    const double efficacy =
        smooth_diffuse_luminous_efficacy(day.dni, dhi, day_zenith, extraterrestrial, kPrecipitableWaterCm);

    PreethamSky sky = preetham_sky(settings.turbidity, direction);
    const double dusk = twilight_illuminance(std::min(sun.elevation_rad, 0.0));
    switch (settings.level) {
        case SkyLevel::clearsky: {
            const double clear =
                clear_sky_irradiance(settings.turbidity, sun.zenith_rad(), sun.distance_au).dhi * efficacy;
            sky = scaled_to(sky, std::max(clear, dusk));
            break;
        }
        case SkyLevel::published:
            sky.luminance.scale *= dusk / twilight_illuminance(0.0);
            break;
        case SkyLevel::dhi:
            sky = scaled_to(sky, settings.dhi_w_m2 * efficacy);
            break;
    }
    sky.efficacy_lm_w = efficacy;
    return sky;
}

SkyModel sky_of(const SkySettings& settings, const SeenSun& sun, const Vec3d& direction) {
    if (const auto* preetham = std::get_if<PreethamSettings>(&settings)) return levelled_sky(*preetham, sun, direction);
    if (const auto* uniform = std::get_if<UniformSkySettings>(&settings))
        return UniformSky{static_cast<float>(uniform->luminance_cd_m2)};
    return NoSky{};
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

void find_low_sun(const SeenSun& sun, bool has_model_sky, FindingLog& findings) {
    if (sun.elevation_rad > 0.0) return;
    const double below_deg = -degrees_from_radians(sun.elevation_rad);
    findings.add(
        {"SB602", Severity::warning, sun.where,
         fmt::format("the sun is {:.2f}° below the horizon: it gives no direct light{}.", below_deg,
                     has_model_sky ? ", and the sky is that of sunset, faded to the twilight's illuminance" : ""),
         "Choose a time between sunrise and sunset."});
}

Daylight daylight_of(const DaylightSettings& settings, const SkySettings& sky, const SeenSun& sun,
                     double convergence_rad, FindingLog& findings) {
    find_low_sun(sun, std::holds_alternative<PreethamSettings>(sky), findings);
    const Vec3d direction = world_direction(sun.azimuth_rad, sun.elevation_rad, convergence_rad);
    const double turbidity = turbidity_of(sky);
    Daylight daylight;
    daylight.label = sun.label;
    daylight.sky = sky_of(sky, sun, direction);
    daylight.sun.direction = Vec3f(direction);
    daylight.sun.shape = settings.sun;
    daylight.sun.angular_radius_rad = static_cast<float>(kSunAngularRadiusRad / sun.distance_au);
    if (settings.sun != SunShape::none) {
        daylight.sun.normal_illuminance =
            rgb_from_xyz(sun_normal_illuminance(turbidity, sun.zenith_rad(), sun.distance_au));
        daylight.sun.dni_w_m2 =
            static_cast<float>(clear_sky_irradiance(turbidity, sun.zenith_rad(), sun.distance_au).dni);
    }
    return daylight;
}

}  // namespace

SkySettings parse_sky(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string model(text.substr(0, colon));
    const SkyOptions options(text, colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1));
    if (model == "preetham") return preetham_settings(options);
    if (model == "uniform") {
        options.allow({"luminance", "turbidity"});
        return UniformSkySettings{options.number("luminance", 0.0, 1e9, UniformSkySettings{}.luminance_cd_m2, " cd/m²"),
                                  turbidity_of(options)};
    }
    if (model == "none") {
        options.allow({"turbidity"});
        return NoSkySettings{turbidity_of(options)};
    }
    const std::vector<std::string> planned = {"perez", "cie", "cie1994", "image"};
    const char* available =
        "Available are preetham:turbidity=3,level=clearsky|published|dhi=W; uniform:luminance=CD_PER_M2; none";
    if (std::find(planned.begin(), planned.end(), model) != planned.end()) {
        options.refuse(fmt::format("this version has no {} sky yet. {}", model, available));
    }
    const std::vector<std::string> known = {"preetham", "uniform", "none"};
    options.refuse(
        fmt::format("there is no sky model '{}'; did you mean '{}'? {}", model, nearest_word(model, known), available));
}

std::string to_text(const SkySettings& sky) {
    if (const auto* preetham = std::get_if<PreethamSettings>(&sky)) {
        const std::string level = preetham->level == SkyLevel::clearsky    ? "clearsky"
                                  : preetham->level == SkyLevel::published ? "published"
                                                                           : fmt::format("dhi={}", preetham->dhi_w_m2);
        return fmt::format("preetham:turbidity={},level={}", preetham->turbidity, level);
    }
    if (const auto* uniform = std::get_if<UniformSkySettings>(&sky)) {
        return fmt::format("uniform:luminance={},turbidity={}", uniform->luminance_cd_m2, uniform->turbidity);
    }
    return fmt::format("none:turbidity={}", std::get<NoSkySettings>(sky).turbidity);
}

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
    const bool is_preetham = std::holds_alternative<PreethamSettings>(settings.sky);
    const bool has_sun = !settings.instants.empty() || settings.sun_direction.has_value();
    if (!has_sun && is_preetham) {
        throw InputError(
            "the Preetham sky needs to know where the sun is: give --at TIME (for example --at 2026-06-21T12:00+02:00) "
            "or --sun-direction "
            "AZIMUTH,ELEVATION; or take --sky uniform.");
    }
    if (!settings.instants.empty() && !site) {
        throw InputError(
            "--at needs to know where on Earth the city is, and its coordinate reference system does not tell: give "
            "--site LAT,LON in degrees, "
            "for example --site 47.07,15.44, or --sun-direction AZIMUTH,ELEVATION instead of --at.");
    }
    if (settings.weather) find_weather(settings, known_site, findings);
    if (is_preetham) {
        find_turbidity(turbidity_of(settings.sky), findings);
        if (!settings.weather && std::get<PreethamSettings>(settings.sky).level == SkyLevel::published) {
            findings.add({"SB603", Severity::info, "--sky",
                          "the published level of the Preetham sky is up to 1.7 times too bright.",
                          "Take level=clearsky for numbers that are to be relied on."});
        }
    }
    if (std::holds_alternative<NoSkySettings>(settings.sky) && (!has_sun || settings.sun == SunShape::none)) {
        findings.add({"SB604", Severity::warning, "--sky none", "there is neither sky nor sun: all is dark.",
                      "Give --at, --sun-direction or another --sky."});
    }

    std::vector<Daylight> daylights;
    if (settings.sun_direction) {
        const auto [azimuth, elevation] = *settings.sun_direction;
        const std::string label =
            fmt::format("sun {:.6g},{:.6g}", degrees_from_radians(azimuth), degrees_from_radians(elevation));
        daylights.push_back(daylight_of(settings, settings.sky, {label, "--sun-direction", azimuth, elevation, 1.0},
                                        convergence_rad, findings));
        return daylights;
    }
    if (!has_sun) {
        Daylight daylight;
        daylight.label = "no sun";
        daylight.sky = sky_of(settings.sky, {}, Vec3d(0.0, 0.0, 1.0));
        daylight.sun.shape = SunShape::none;
        daylights.push_back(daylight);
        return daylights;
    }
    daylights.reserve(settings.instants.size());
    for (std::size_t i = 0; i < settings.instants.size(); ++i) {
        const Instant& instant = settings.instants[i];
        const SolarPosition position = solar_position(instant.utc, *site);
        const std::string label = to_iso8601(instant);
        const SeenSun sun{label, "--at " + label, position.azimuth_rad, position.apparent_elevation_rad,
                          position.distance_au};
        daylights.push_back(daylight_of(settings, sky_at(settings, i), sun, convergence_rad, findings));
        if (settings.weather) {
            set_beam(daylights.back().sun, weather_of(*settings.weather, instant), turbidity_of(settings.sky),
                     sun.zenith_rad(), sun.distance_au);
        }
    }
    return daylights;
}

}  // namespace skybake
