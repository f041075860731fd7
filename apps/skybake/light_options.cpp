#include "light_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "api/load_sky_image.h"
#include "base/error.h"
#include "base/nearest_word.h"
#include "city/city_model.h"
#include "weather_option.h"

namespace skybake::cli {

namespace {

std::vector<std::string> surface_names() {
    std::vector<std::string> names = {"default"};
    for (int i = 0; i <= static_cast<int>(SurfaceType::other); ++i)
        names.emplace_back(name_of(static_cast<SurfaceType>(i)));
    return names;
}

[[noreturn]] void refuse_albedo(std::string_view text, const std::string& why) {
    throw InputError(
        fmt::format("--albedo '{}': {}. It is R,G,B or default=0.3,roof=0.4,ground=0.2 with values of 0…1, one or "
                    "three for each kind.",
                    text, why));
}

float albedo_value(std::string_view number, std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc{} || end != number.data() + number.size() || !(value >= 0.0 && value <= 1.0)) {
        refuse_albedo(text, fmt::format("'{}' is not a number in 0…1", number));
    }
    return static_cast<float>(value);
}

}  // namespace

void add_daylight_options(CLI::App* verb, LightOptions& options) {
    const char* group = "Light";
    verb->add_option("--at", options.at, "instant, comma list, or START/END/STEP; ISO 8601 with offset or Z")
        ->group(group)
        ->type_name("TIME");
    verb->add_option("--timezone", options.timezone, "IANA zone for times without offset, e.g. Europe/Vienna")
        ->group(group)
        ->type_name("NAME");
    verb->add_option("--site", options.site, "degrees north and east; default: from the city's CRS")
        ->group(group)
        ->type_name("LAT,LON");
    verb->add_option("--sun-direction", options.sun_direction,
                     "degrees, instead of --at: azimuth from true north, elevation")
        ->group(group)
        ->type_name("AZ,EL")
        ->excludes("--at");
    verb->add_option("--sky", options.sky, kSkyForms)->group(group)->type_name("MODEL")->capture_default_str();
    verb->add_option(
            "--weather", options.weather,
            "EPW weather file: its hour at --at sets the level of sky and sun, and the site if nothing else does")
        ->group(group)
        ->type_name("FILE")
        ->excludes("--sun-direction");
}

void add_light_options(CLI::App* verb, LightOptions& options) {
    const char* group = "Light";
    add_daylight_options(verb, options);
    verb->add_option("--sun", options.sun, "point, disc (0.53 degrees, with penumbra) or none")
        ->group(group)
        ->type_name("SHAPE")
        ->capture_default_str();
    verb->add_option("--sky-samples", options.sky_samples, "directions of the sky per texel")
        ->group(group)
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    verb->add_option("--albedo", options.albedo, "R,G,B or default=0.3,roof=0.4,ground=0.2 (linear, 0..1)")
        ->group(group)
        ->type_name("ALBEDO");
    verb->add_option("--crowns", options.crowns, "of trees: transparent (light passes by the way within) or opaque")
        ->group(group)
        ->type_name("HOW")
        ->check(CLI::IsMember({"transparent", "opaque"}))
        ->capture_default_str();
    verb->add_option("--leaves", options.leaves,
                     "on (3 % of light passes a crown) or off (46 %); default: by --at, on from May to October, in the "
                     "south from November to April")
        ->group(group)
        ->type_name("SEASON")
        ->check(CLI::IsMember({"on", "off"}));
    verb->add_option("--crown-transmissivity", options.crown_transmissivity,
                     "share of light that passes a crown along its mean chord, instead of that of --leaves")
        ->group(group)
        ->type_name("SHARE")
        ->check(CLI::Range(0.001, 0.999));
}

CrownSettings crown_settings_of(const LightOptions& options) {
    CrownSettings settings;
    if (options.crowns == "opaque") settings.treatment = CrownTreatment::opaque;
    if (!options.leaves.empty()) settings.is_in_leaf = options.leaves == "on";
    settings.transmissivity = options.crown_transmissivity;
    return settings;
}

namespace {

/// All but the picture of an image sky.
DaylightSettings parsed_settings(const LightOptions& options) {
    DaylightSettings settings;
    settings.sky = parse_sky(options.sky);
    settings.sun = parse_sun_shape(options.sun);
    const std::optional<std::string> timezone =
        options.timezone.empty() ? std::nullopt : std::optional(options.timezone);
    if (!options.at.empty()) settings.instants = parse_instants(options.at, timezone);
    if (!options.sun_direction.empty()) settings.sun_direction = parse_sun_direction(options.sun_direction);
    if (!options.weather.empty()) {
        put_weather(settings, options.weather);
        if (options.sky == kDefaultSky) settings.sky = PerezSettings{};
    }
    return settings;
}

}  // namespace

DaylightSettings daylight_settings_of(const LightOptions& options) {
    DaylightSettings settings = parsed_settings(options);
    load_sky_image(settings.sky);
    return settings;
}

std::optional<Site> site_of(const LightOptions& options, const std::optional<Site>& site_from_crs) {
    return options.site.empty() ? site_from_crs : parse_site(options.site);
}

void check_light_options(const LightOptions& options) {
    const DaylightSettings settings = parsed_settings(options);
    site_of(options, std::nullopt);
    parse_albedo(options.albedo);
    const bool has_sun = !settings.instants.empty() || settings.sun_direction.has_value();
    if (!has_sun && needs_sun(settings.sky)) {
        FindingLog unheard;  // only for the errors: what is found is reported when the daylight is made
        make_daylights(settings, std::nullopt, 0.0, unheard);
    }
}

std::vector<Daylight> daylights_of(const LightOptions& options, const std::optional<Site>& site_from_crs,
                                   double convergence_rad, FindingLog& findings) {
    check_light_options(options);
    return make_daylights(daylight_settings_of(options), site_of(options, site_from_crs), convergence_rad, findings);
}

std::vector<std::pair<std::string, Rgb>> parse_albedo(std::string_view text) {
    // Numbers after a name belong to it up to the next name: "roof=0.4,0.2,0.1,ground=0.2".
    std::vector<std::pair<std::string, std::vector<float>>> groups;
    const std::vector<std::string> known = surface_names();
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t comma = rest.find(',');
        std::string_view item = rest.substr(0, comma);
        rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
        const std::size_t equals = item.find('=');
        if (equals != std::string_view::npos) {
            const std::string name(item.substr(0, equals));
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                refuse_albedo(text, fmt::format("there is no surface kind '{}'; did you mean '{}'", name,
                                                nearest_word(name, known)));
            }
            const bool is_twice =
                std::any_of(groups.begin(), groups.end(), [&](const auto& group) { return group.first == name; });
            if (is_twice) refuse_albedo(text, fmt::format("'{}' is given twice", name));
            groups.emplace_back(name, std::vector<float>());
            item.remove_prefix(equals + 1);
        } else if (groups.empty()) {
            groups.emplace_back("default", std::vector<float>());
        }
        groups.back().second.push_back(albedo_value(item, text));
    }
    std::vector<std::pair<std::string, Rgb>> albedos;
    for (const auto& [name, values] : groups) {
        if (values.size() != 1 && values.size() != 3)
            refuse_albedo(text, fmt::format("'{}' has {} values", name, values.size()));
        albedos.emplace_back(name, values.size() == 1 ? Rgb(values[0]) : Rgb(values[0], values[1], values[2]));
    }
    return albedos;
}

}  // namespace skybake::cli
