// skybake study: sun and shadow by a rule, with verdicts, tables and maps.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <map>
#include <memory>

#include "api/study_city.h"
#include "base/error.h"
#include "base/threads.h"
#include "city_options.h"
#include "io/epw/read_epw.h"
#include "io/file/replace_file.h"
#include "io/points/points_csv.h"
#include "io/rules/read_rule.h"
#include "program.h"
#include "sky/daylight_settings.h"

namespace skybake::cli {

namespace {

namespace fs = std::filesystem;

struct Options {
    CityOptions city;
    std::string rule = "shadow-study";
    bool lists_rules = false;
    fs::path output;
    std::vector<std::string> receivers;
    fs::path points, polygons, weather;
    double cell_m = 1.0, storey_height_m = 3.0;
    std::optional<double> height_m, min_elevation_deg;
    std::string days, step, site, timezone;
    int year = 2026;
    double scan_s = 60.0;
    int sky_directions = 4096;
    double ground_albedo = 0.2;
    std::vector<fs::path> added, before;
    std::vector<std::string> plan, removed;
    bool leaves_out_cells = false;
};

fs::path rules_folder() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    return program.parent_path().parent_path() / "share" / "skybake" / "rules";
}

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

StudyRequest request_of(const Options& options, FindingLog& weather_findings) {
    StudyRequest request;
    request.rule_file = rule_file_of(options.rule, rules_folder());
    request.rule = io::read_rule(request.rule_file);
    Rule& rule = request.rule;
    if (!options.days.empty()) rule.days = parse_days(options.days);
    if (!options.step.empty()) rule.sampled = parse_step(options.step);
    if (options.min_elevation_deg) rule.min_elevation_deg = *options.min_elevation_deg;

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
    return request;
}

void write_outputs(const Options& options, const Rule& rule, const StudyResult& result, const nlohmann::json& report) {
    std::error_code error;
    fs::create_directories(options.output, error);
    if (error) throw InputError(fmt::format("-o {}: cannot be made: {}.", options.output.string(), error.message()));
    const Study& study = result.study;
    const fs::path& folder = options.output;
    if (!options.leaves_out_cells) {
        io::write_cells_csv(folder / "cells.csv", rule, study);
        io::write_cells_gpkg(folder / "cells.gpkg", rule, study, result.facts.crs);
    }
    io::write_ground_tiff(folder / "ground.tif", study, result.facts.crs);
    io::write_groups_csv(folder / "groups.csv", rule, study, result.groups);
    if (result.facts.has_before) io::write_new_shadow_csv(folder / "new_shadow.csv", study);
    // Last, so that a folder with a report is whole.
    const std::string text = report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    io::write_file(folder / "report.json", std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void print_verdicts(const Rule& rule, const StudyResult& result) {
    fmt::print("{} ({} {})\n", rule.title, rule.id, rule.version);
    for (const Group& group : result.groups) {
        if (group.level != Level::kind) continue;
        fmt::print("{}: {} cells, {:.0f} m2\n", group.id, group.samples, group.area_m2);
        for (std::size_t c = 0; c < result.study.columns.size(); ++c) {
            const GroupColumn& g = group.columns[c];
            fmt::print("  {:<34} {:8.2f} {} on average, {:.2f} to {:.2f}\n", result.study.columns[c].name, g.mean,
                       io::unit_of(result.study.columns[c].metric), g.least, g.greatest);
        }
        for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
            const GroupCriterion& g = group.criteria[c];
            if (g.verdict == Verdict::none) continue;
            fmt::print("  {:<34} {}: {:.1f} % of the area pass, {:.1f} % borderline, {:.1f} % fail\n",
                       rule.criteria[c].id, name_of(g.verdict), 100 * g.area_pass, 100 * g.area_borderline,
                       100 * g.area_fail);
        }
    }
    for (const std::string& note : rule.to_check) fmt::print("to check: {}\n", note);
}

int run(const CommonOptions& common, const Options& options) {
    if (options.lists_rules) {
        for (const std::string& name : shipped_rules(rules_folder())) {
            const Rule rule = io::read_rule(rule_file_of(name, rules_folder()));
            fmt::print("{:<24} {} ({})\n", name, rule.title, rule.source_date);
        }
        return kDone;
    }
    if (options.city.files.empty()) throw InputError("study needs a CITY: city files (or --list-rules).");
    const ThreadLimit threads(common.threads);
    const auto begin = std::chrono::steady_clock::now();
    FindingLog weather_findings;
    StudyRequest request = request_of(options, weather_findings);
    const Rule rule = request.rule;
    ConsoleProgress progress(common);
    StudyResult result = study_city(std::move(request), progress);
    result.findings.merge(weather_findings);
    result.facts.program_version = SKYBAKE_VERSION;
    nlohmann::json report = io::study_report(rule, result.study, result.groups, result.facts);
    if (!options.output.empty()) write_outputs(options, rule, result, report);
    const int exit_code = report_findings(common, result.findings);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Study& study = result.study;
    const double rate = study.sun_seconds > 0.0 ? static_cast<double>(study.sun_rays) / study.sun_seconds : 0.0;
    say(common, fmt::format("{} cells, {:.3g} rays, sun {:.1f} s at {:.1f} million rays/s, {:.1f} s in all",
                            study.receivers.samples.size(), static_cast<double>(study.rays), study.sun_seconds,
                            1e-6 * rate, seconds));
    if (common.wants_json) {
        report["seconds"] = {{"sun", study.sun_seconds}, {"total", seconds}};
        report["rays_per_second"] = rate;
        report["findings"] = to_json(result.findings);
        print_json(report);
    } else {
        print_verdicts(rule, result);
    }
    return exit_code;
}

void add_receiver_options(CLI::App* verb, Options& options) {
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

void add_time_options(CLI::App* verb, Options& options) {
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
    verb->add_option("--ground-albedo", options.ground_albedo, "of the open ground of reflected_kwh_m2")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    verb->add_option("--sky-samples", options.sky_directions, "directions to the sky for each normal")
        ->capture_default_str()
        ->check(CLI::Range(16, 65536));
}

}  // namespace

void add_study(CLI::App& app, Program& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* verb = add_verb(
        app, program, "study", "Sun and shadow by a rule: exact intervals, sky, energy, verdicts, before and after.",
        "  skybake study --list-rules\n"
        "  skybake study town.city.json --rule en17037-sunlight --days 03-21 -o study\n"
        "  skybake study town.city.json --rule nyc-ceqr --add tower.city.json --polygons parks.geojson -o study",
        [&program, options] { return run(program.common, *options); });
    add_city_options(verb, options->city, false);
    verb->add_option("--rule", options->rule, "a shipped rule's name, or a file")->capture_default_str();
    verb->add_flag("--list-rules", options->lists_rules, "print the shipped rules");
    verb->add_option("-o,--output", options->output, "folder for tables, maps and report");
    add_receiver_options(verb, *options);
    add_time_options(verb, *options);
    verb->add_option("--add", options->added, "files of the plan: after is the city with them");
    verb->add_option("--plan", options->plan, "ids of objects of the city that are the plan: before is without them");
    verb->add_option("--remove", options->removed, "ids of objects that the plan takes away");
    verb->add_option("--before", options->before, "files of the former city");
    verb->add_flag("--no-cells", options->leaves_out_cells, "write no cells.csv and cells.gpkg");
}

}  // namespace skybake::cli
