// skybake sun: where the sun stands, and what its beam brings.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "light_options.h"
#include "program.h"
#include "sky/solar_events.h"
#include "sky/solar_position.h"
#include "sky/sun_path.h"
#include "sun_path_diagram.h"

namespace skybake::cli {

namespace {

struct SunOptions {
    LightOptions light;
    DiagramOptions diagram;
};

const char* name_of(SolarDayKind kind) {
    switch (kind) {
        case SolarDayKind::normal:
            return "normal";
        case SolarDayKind::midnight_sun:
            return "midnight_sun";
        case SolarDayKind::polar_night:
            return "polar_night";
    }
    return "normal";
}

nlohmann::json time_json(const std::optional<UtcTime>& time, int utc_offset_min) {
    if (!time) return nullptr;
    const UtcTime whole_second{std::llround(seconds_since_1970(*time)) * 1000};
    return to_iso8601({whole_second, utc_offset_min});
}

/// Hours of a day as HH:MM:SS.
std::string clock_text(double hours) {
    const long seconds = std::lround(hours * 3600.0) % 86400;
    return fmt::format("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

/// What does not hang on the clock: the beam.
void put_beam(nlohmann::json& entry, const SunBeam& sun) {
    entry["dni_w_m2"] = sun.dni_w_m2;
    entry["direct_normal_lx"] = luminance(sun.normal_illuminance);
    entry["beam_rgb"] = {sun.normal_illuminance.x, sun.normal_illuminance.y, sun.normal_illuminance.z};
}

std::vector<nlohmann::json> entries_at(const DaylightSettings& settings, const std::vector<Daylight>& daylights,
                                       const Site& site) {
    std::vector<nlohmann::json> entries;
    std::optional<std::int64_t> events_day;
    SolarEvents events;
    for (std::size_t i = 0; i < settings.instants.size(); ++i) {
        const Instant& instant = settings.instants[i];
        const SolarPosition position = solar_position(instant.utc, site);
        nlohmann::json entry = {{"time", to_iso8601(instant)},
                                {"azimuth_deg", degrees_from_radians(position.azimuth_rad)},
                                {"elevation_deg", degrees_from_radians(position.elevation_rad)},
                                {"apparent_elevation_deg", degrees_from_radians(position.apparent_elevation_rad)},
                                {"distance_au", position.distance_au},
                                {"equation_of_time_min", position.equation_of_time_min},
                                {"solar_time", clock_text(true_solar_time_h(instant.utc, site))},
                                {"declination_deg", degrees_from_radians(position.declination_rad)}};
        put_beam(entry, daylights[i].sun);
        if (const std::int64_t day = local_solar_day(instant.utc, site); events_day != day) {
            events = solar_events(instant.utc, site);
            events_day = day;
        }
        entry["day"] = name_of(events.kind);
        entry["sunrise"] = time_json(events.sunrise, instant.utc_offset_min);
        entry["transit"] = time_json(events.transit, instant.utc_offset_min);
        entry["sunset"] = time_json(events.sunset, instant.utc_offset_min);
        entries.push_back(std::move(entry));
    }
    return entries;
}

nlohmann::json entry_of_direction(const SunDirection& direction, const Daylight& daylight) {
    nlohmann::json entry = {{"time", nullptr},
                            {"azimuth_deg", degrees_from_radians(direction.azimuth_rad)},
                            {"elevation_deg", degrees_from_radians(direction.elevation_rad)},
                            {"apparent_elevation_deg", degrees_from_radians(direction.elevation_rad)},
                            {"distance_au", 1.0},
                            {"equation_of_time_min", nullptr},
                            {"solar_time", nullptr},
                            {"declination_deg", nullptr}};
    put_beam(entry, daylight.sun);
    return entry;
}

void print_table(const std::vector<nlohmann::json>& entries) {
    fmt::print("{:<29} {:>9} {:>10} {:>9} {:>9} {:>8} {:>10}\n", "time", "solar", "azimuth", "elevation", "apparent",
               "DNI", "normal");
    fmt::print("{:<29} {:>9} {:>10} {:>9} {:>9} {:>8} {:>10}\n", "", "time", "deg", "deg", "deg", "W/m2", "lx");
    std::string last_events;
    for (const nlohmann::json& entry : entries) {
        const std::string time = entry["time"].is_null() ? "(given direction)" : entry["time"].get<std::string>();
        if (entry.contains("day")) {
            const auto text_of = [&](const char* key) {
                return entry[key].is_null() ? "none" : entry[key].get<std::string>();
            };
            const std::string events = fmt::format("# sunrise {}, noon {}, sunset {}", text_of("sunrise"),
                                                   text_of("transit"), text_of("sunset"));
            if (events != last_events) fmt::print("{}\n", events);
            last_events = events;
        }
        fmt::print("{:<29} {:>9} {:>10.4f} {:>9.4f} {:>9.4f} {:>8.1f} {:>10.0f}\n", time,
                   entry["solar_time"].is_null() ? "" : entry["solar_time"].get<std::string>(),
                   entry["azimuth_deg"].get<double>(), entry["elevation_deg"].get<double>(),
                   entry["apparent_elevation_deg"].get<double>(), entry["dni_w_m2"].get<double>(),
                   entry["direct_normal_lx"].get<double>());
    }
}

void check_diagram(const SunOptions& options) {
    if (options.diagram.file.empty()) return;
    if (std::filesystem::path(options.diagram.file).extension() != ".svg")
        throw InputError(fmt::format("--diagram {}: the diagram is a .svg.", options.diagram.file));
    if (!options.light.sun_direction.empty())
        throw InputError(
            "--diagram shows the sun of a site through the year: give --site and --at, not --sun-direction.");
}

int run_sun(const SunOptions& options, const CommonOptions& common) {
    check_diagram(options);
    FindingLog findings;
    const DaylightSettings settings = daylight_settings_of(options.light);
    const bool has_diagram = !options.diagram.file.empty();
    if (settings.instants.empty() && !settings.sun_direction && !has_diagram) {
        throw InputError(
            "the sun needs a time: give --at TIME and --site LAT,LON, for example --at 2026-06-21T12:00+02:00 --site "
            "47.07,15.44.");
    }
    const std::optional<Site> known_site = site_of(options.light, std::nullopt);
    const std::optional<Site> site = site_of_light(settings, known_site);
    if (!settings.sun_direction && !site) {
        throw InputError(
            fmt::format("{} needs a place: give --site LAT,LON in degrees, for example --site 47.07,15.44.",
                        settings.instants.empty() ? "--diagram" : "--at"));
    }
    std::vector<nlohmann::json> entries;
    if (settings.sun_direction || !settings.instants.empty()) {
        const std::vector<Daylight> daylights = make_daylights(settings, known_site, 0.0, findings);
        entries = settings.sun_direction ? std::vector{entry_of_direction(*settings.sun_direction, daylights.at(0))}
                                         : entries_at(settings, daylights, *site);
    }
    if (has_diagram) {
        io::write_sun_diagram(options.diagram.file,
                              sun_path_diagram(options.diagram, settings, options.light.timezone, *site));
        say(common, fmt::format("wrote {}", options.diagram.file));
    }
    if (common.wants_json) {
        nlohmann::json object = entries.size() == 1 ? entries.front() : nlohmann::json::object();
        object["instants"] = entries;
        object["sky"] = to_text(settings.sky);
        object["site"] = nullptr;
        if (site)
            object["site"] = {{"latitude_deg", degrees_from_radians(site->latitude_rad)},
                              {"longitude_deg", degrees_from_radians(site->longitude_rad)}};
        if (has_diagram) object["diagram"] = options.diagram.file;
        object["findings"] = to_json(findings);
        print_json(object);
    } else if (!entries.empty()) {
        print_table(entries);
    }
    return report_findings(common, findings);
}

}  // namespace

void add_sun(CLI::App& app, Program& program) {
    const auto options = std::make_shared<SunOptions>();
    CLI::App* verb = add_verb(
        app, program, "sun", "Where the sun stands, and what its direct beam brings.",
        "  skybake sun --site 47.07,15.44 --at 2026-06-21T12:00+02:00\n"
        "  skybake sun --site 47.07,15.44 --timezone Europe/Vienna --at 2026-03-21T06:00/2026-03-21T18:00/1h --json\n"
        "  skybake sun --site 47.07,15.44 --timezone Europe/Vienna --at 2026-06-21T09:00 --diagram graz.svg",
        [options, &program] { return run_sun(*options, program.common); });
    add_daylight_options(verb, options->light);
    verb->add_option("--diagram", options->diagram.file, "sun-path diagram of the site, with the instants marked")
        ->type_name("SVG");
    verb->add_option("--projection", options->diagram.projection,
                     "of the diagram: stereographic, equidistant or orthographic")
        ->type_name("NAME")
        ->capture_default_str();
    verb->add_option("--diagram-hours", options->diagram.hours,
                     "hours of the diagram: clock or solar; default: clock where an offset from UTC is known")
        ->type_name("KIND");
}

}  // namespace skybake::cli
