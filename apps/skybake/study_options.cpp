#include "study_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "base/nearest_word.h"
#include "io/epw/read_epw.h"
#include "io/manifest/sha256.h"
#include "io/points/points_csv.h"
#include "io/rules/read_rule.h"
#include "program.h"
#include "sky/daylight_settings.h"

namespace skybake::cli {

namespace {

namespace fs = std::filesystem;

/// "MM-DD,MM-DD" of --days.
std::vector<CalendarDay> parse_days(const std::string& text) {
    std::vector<CalendarDay> days;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string word = text.substr(at, end - at);
        CalendarDay day{0, 0};
        char rest = 0;
        if (std::sscanf(word.c_str(), "%2d-%2d%c", &day.month, &day.day, &rest) != 2 || day.month < 1 ||
            day.month > 12 || day.day < 1 || day.day > 31)
            throw InputError(fmt::format("--days '{}': '{}' is no day; write MM-DD, such as 03-21,12-21.", text, word));
        days.push_back(day);
        at = end + 1;
    }
    return days;
}

SampledConstruction parse_step(const std::string& text) {
    double number = 0.0;
    char unit[4] = {};
    if (std::sscanf(text.c_str(), "%lf%3s", &number, unit) == 2 && number > 0.0) {
        const std::string name = unit;
        const double seconds = number * (name == "h" ? 3600.0 : name == "min" ? 60.0 : name == "s" ? 1.0 : 0.0);
        if (seconds >= 1.0 && seconds <= 86400.0) return {seconds, BetweenSamples::nearest};
    }
    throw InputError(fmt::format("--step '{}': write a length with s, min or h, such as 60min.", text));
}

ReceiverKind parse_kind(const std::string& name) {
    static const std::map<std::string, ReceiverKind> kKinds{
        {"ground", ReceiverKind::ground},  {"polygons", ReceiverKind::polygon}, {"roofs", ReceiverKind::roof},
        {"facades", ReceiverKind::facade}, {"windows", ReceiverKind::window},   {"points", ReceiverKind::point}};
    const auto found = kKinds.find(name);
    if (found != kKinds.end()) return found->second;
    throw InputError(
        fmt::format("--receivers '{}': is none of ground, polygons, roofs, facades, windows, points.", name));
}

/// "4-9", "10-3" (over the new year) or "1,2,12" of --months.
Period parse_months(const std::string& text) {
    Period period{{}};
    const auto fail = [&] {
        throw InputError(fmt::format("--months '{}': write months 1 to 12, such as 4-9, 10-3 or 1,2,12.", text));
    };
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string word = text.substr(at, end - at);
        int first = 0, last = 0;
        char rest = 0;
        const int read = std::sscanf(word.c_str(), "%2d-%2d%c", &first, &last, &rest);
        if (read == 1 && word.find_first_not_of("0123456789") == std::string::npos)
            last = first;
        else if (read != 2)
            fail();
        if (first < 1 || first > 12 || last < 1 || last > 12) fail();
        for (int month = first;; month = month % 12 + 1) {
            if (std::find(period.months.begin(), period.months.end(), month) == period.months.end())
                period.months.push_back(month);
            if (month == last) break;
        }
        at = end + 1;
    }
    std::sort(period.months.begin(), period.months.end());
    return period;
}

/// The files of the options, with what they are for, in a fixed order; `--rule` only where it is a file of the user's.
std::vector<std::pair<const char*, fs::path*>> files_of(StudyOptions& options) {
    std::vector<std::pair<const char*, fs::path*>> files;
    for (fs::path& file : options.city.files) files.emplace_back("city", &file);
    for (fs::path& file : options.added) files.emplace_back("plan", &file);
    for (fs::path& file : options.before) files.emplace_back("before", &file);
    for (const auto& [role, file] :
         {std::pair{"polygons", &options.polygons}, {"points", &options.points}, {"weather", &options.weather}}) {
        if (!file->empty()) files.emplace_back(role, file);
    }
    return files;
}

bool is_shipped(const std::string& rule) {
    return fs::exists(rules_folder() / (rule + ".json"));
}

/// By the paths as they were typed: what links point to is nobody's business.
std::string seen_from(const fs::path& file, const fs::path& folder) {
    return fs::absolute(file)
        .lexically_normal()
        .lexically_relative(fs::absolute(folder / "").lexically_normal())
        .generic_string();
}

void add_receiver_options(CLI::App* verb, StudyOptions& options) {
    verb->add_option("--receivers", options.receivers,
                     "ground, polygons, roofs, facades, windows, points (default: what the rule names)")
        ->delimiter(',');
    verb->add_option("--points", options.points, "CSV with points: id,x,y,z,nx,ny,nz in map coordinates");
    verb->add_option("--polygons", options.polygons, "GeoJSON or GeoPackage with areas on the ground: parks, squares");
    verb->add_option("--cell", options.cell_m, "length of a cell, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.05, 100.0));
    verb->add_option("--height", options.height_m,
                     "height of ground cells above the ground, metres (default: the rule's)")
        ->check(CLI::Range(0.0, 100.0));
    verb->add_option("--storey-height", options.storey_height_m, "height of a storey, metres")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 20.0));
}

void add_time_options(CLI::App* verb, StudyOptions& options) {
    verb->add_option("--days", options.days, "days MM-DD,… instead of the rule's");
    verb->add_option("--year", options.year, "calendar year of the days")
        ->capture_default_str()
        ->check(CLI::Range(1600, 3000));
    verb->add_option("--timezone", options.timezone, "IANA time zone, for rules that go by the clock");
    verb->add_option("--site", options.site, "LAT,LON in degrees (default: from the city's CRS)");
    verb->add_option("--min-elevation", options.min_elevation_deg, "the sun counts from this elevation on, degrees")
        ->check(CLI::Range(0.0, 60.0));
    verb->add_option("--step", options.step, "sampled construction, such as 60min, instead of exact intervals");
    verb->add_option("--scan", options.scan_s, "step in which crossings are looked for, seconds")
        ->capture_default_str()
        ->check(CLI::Range(2.0, 3600.0));
    verb->add_option("--weather", options.weather, "EPW file, for irradiation and probable sunlight");
    verb->add_option("--months", options.months,
                     "months of probable sunlight and energy, such as 4-9 or 12,1,2 (default: the year)");
    verb->add_option("--ground-albedo", options.ground_albedo, "of the open ground of reflected_kwh_m2")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    verb->add_option("--sky-samples", options.sky_directions, "directions to the sky for each normal")
        ->capture_default_str()
        ->check(CLI::Range(16, 65536));
}

void add_reflection_options(CLI::App* verb, StudyOptions& options) {
    verb->add_option("--at", options.at, "illuminance at these instants, as in skybake probe");
    verb->add_option("--sky", options.sky, "sky at those instants, as in skybake probe")->capture_default_str();
    verb->add_option("--albedo", options.albedo, "of surfaces without material, as in skybake probe");
    verb->add_option("--paths", options.paths, "paths per cell, for reflected light")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 30));
    verb->add_option("--bounces", options.bounces, "reflections at most")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
}

/// What --at asks of the light, by the words of skybake probe.
LightOptions light_of(const StudyOptions& options) {
    LightOptions light;
    light.at = options.at;
    light.timezone = options.timezone;
    light.site = options.site;
    light.sky = options.sky;
    light.weather = options.weather.string();
    light.albedo = options.albedo;
    return light;
}

void add_metrics(const StudyOptions& options, Rule& rule) {
    for (const std::string& name : options.metrics) {
        const std::optional<Metric> metric = metric_of(name);
        if (!metric) {
            std::vector<std::string> names;
            for (int m = 0; m < kMetricCount; ++m) names.emplace_back(name_of(static_cast<Metric>(m)));
            throw InputError(
                fmt::format("--metrics '{}': is no metric; did you mean '{}'?", name, nearest_word(name, names)));
        }
        if (is_of_days(*metric) && rule.days.empty())
            throw InputError(fmt::format("--metrics {}: the rule has no days. Pass --days.", name));
        rule.metrics.push_back(*metric);
    }
    if (options.at.empty()) return;
    for (const Metric metric : {Metric::sun_lx, Metric::sky_lx, Metric::indirect_lx, Metric::illuminance_lx})
        rule.metrics.push_back(metric);
}

}  // namespace

fs::path rules_folder() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    return program.parent_path().parent_path() / "share" / "skybake" / "rules";
}

StudyRequest study_request(const StudyOptions& options, std::uint64_t seed, FindingLog& weather_findings) {
    StudyRequest request;
    request.rule_file = rule_file_of(options.rule, rules_folder());
    request.rule = io::read_rule(request.rule_file);
    Rule& rule = request.rule;
    if (!options.days.empty()) rule.days = parse_days(options.days);
    if (!options.step.empty()) rule.sampled = parse_step(options.step);
    if (options.min_elevation_deg) rule.min_elevation_deg = *options.min_elevation_deg;
    add_metrics(options, rule);

    request.city = options.city.files;
    request.load = options.city.load_options();
    request.added = options.added;
    request.before = options.before;
    request.plan = options.plan;
    request.removed = options.removed;
    ReceiverOptions& receivers = request.receivers;
    for (const std::string& name : options.receivers) receivers.kinds.push_back(parse_kind(name));
    receivers.cell_m = options.cell_m;
    receivers.height_m = options.height_m.value_or(rule.height_m);
    receivers.storey_height_m = options.storey_height_m;
    if (!options.points.empty()) {
        for (const io::ProbePoint& point : io::read_points(options.points))
            receivers.points.push_back({point.id, point.position, point.normal});
        if (receivers.points.empty()) throw InputError(options.points.string() + ": has no points.");
    }
    if (!options.polygons.empty()) request.polygons = options.polygons;
    if (!options.months.empty()) request.period = parse_months(options.months);
    if (!options.site.empty()) request.site = parse_site(options.site);
    if (!options.weather.empty()) {
        request.weather = io::read_epw(options.weather, weather_findings);
        settle_weather(*request.weather, weather_findings);
    }
    request.settings.year = options.year;
    if (!options.timezone.empty()) request.settings.timezone = options.timezone;
    request.settings.scan_s = options.scan_s;
    request.settings.sky_directions = options.sky_directions;
    request.settings.ground_albedo = options.ground_albedo;
    request.settings.paths = {options.paths, options.bounces, seed};
    request.albedo = parse_albedo(options.albedo);
    if (!options.at.empty()) request.instants = daylight_settings_of(light_of(options));
    return request;
}

void add_study_options(CLI::App* verb, StudyOptions& options) {
    static const std::map<std::string, io::Language> kLanguages{{"en", io::Language::english},
                                                                {"de", io::Language::german}};
    add_city_options(verb, options.city, false);
    verb->add_option("--rule", options.rule, "a shipped rule's name, or a file")->capture_default_str();
    verb->add_flag("--list-rules", options.lists_rules, "print the shipped rules");
    verb->add_option("-o,--output", options.output,
                     "folder for report.html, tables, maps, and the city as CityJSON with the results as attributes");
    verb->add_option("--texels", options.texels,
                     "folder of a bake of the city: the metrics at its texels, as layers of its walkthrough");
    verb->add_option("--lang", options.language, "language of report.html: en or de (default en)")
        ->transform(CLI::CheckedTransformer(kLanguages, CLI::ignore_case).description(""));
    verb->add_option("--verify", options.verified, "a report.json: compute a sample of its rows anew and compare");
    add_receiver_options(verb, options);
    add_time_options(verb, options);
    verb->add_option("--metrics", options.metrics, "metrics besides those of the rule, such as indirect_kwh_m2")
        ->delimiter(',');
    add_reflection_options(verb, options);
    verb->add_option("--add", options.added, "files of the plan: after is the city with them");
    verb->add_option("--plan", options.plan, "ids of objects of the city that are the plan: before is without them");
    verb->add_option("--remove", options.removed, "ids of objects that the plan takes away");
    verb->add_option("--before", options.before, "files of the former city");
    verb->add_flag("--no-cells", options.leaves_out_cells, "write no cells.csv, cells.gpkg and city.city.json");
}

std::vector<io::StudyInput> study_inputs(const StudyOptions& options, const fs::path& folder) {
    StudyOptions copy = options;
    std::vector<io::StudyInput> inputs;
    const auto add = [&](const char* role, const fs::path& file, const std::string& name) {
        const io::FileHash hash = io::hash_file(file);
        inputs.push_back({role, name, hash.bytes, hash.sha256});
    };
    const fs::path rule = rule_file_of(options.rule, rules_folder());
    add("rule", rule, is_shipped(options.rule) ? rule.filename().string() : seen_from(rule, folder));
    for (const auto& [role, file] : files_of(copy)) add(role, *file, seen_from(*file, folder));
    return inputs;
}

std::vector<std::string> study_arguments(const CLI::App& verb, const StudyOptions& options, const fs::path& folder) {
    static const std::set<std::string> kElsewhere{"--output",  "--lang",   "--verify", "--json",       "--quiet",
                                                  "--threads", "--strict", "--help",   "--list-rules", "--no-cells"};
    static const std::set<std::string> kFiles{"--add", "--before", "--points", "--polygons", "--weather"};
    std::vector<std::string> words;
    for (const fs::path& file : options.city.files) words.push_back(seen_from(file, folder));
    for (const CLI::Option* option : verb.get_options()) {
        if (option->count() == 0 || option->get_positional() || option->get_lnames().empty()) continue;
        const std::string name = "--" + option->get_lnames().front();
        if (kElsewhere.contains(name)) continue;
        for (const std::string& value : option->results()) {
            const bool is_file = kFiles.contains(name) || (name == "--rule" && !is_shipped(value));
            words.push_back(name + "=" + (is_file ? seen_from(value, folder) : value));
        }
    }
    return words;
}

void parse_study_arguments(const std::vector<std::string>& arguments, const fs::path& folder, StudyOptions& options,
                           std::uint64_t& seed) {
    CLI::App app;
    app.add_option("--seed", seed);
    add_study_options(&app, options);
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::ParseError& error) {
        throw InputError(fmt::format("its arguments are not those of this version: {}", error.what()));
    }
    for (const auto& [role, file] : files_of(options)) *file = folder / *file;
    if (!is_shipped(options.rule)) options.rule = (folder / options.rule).string();
}

}  // namespace skybake::cli
