#include "api/study_city.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_set>

#include "base/error.h"
#include "base/nearest_word.h"
#include "io/geodata/geodata.h"
#include "scene/scene.h"

namespace skybake {
namespace {

using Ids = std::unordered_set<std::string>;

Ids ids_of(const CityModel& city) {
    Ids ids;
    for (const CityObject& object : city.objects) ids.insert(object.id);
    return ids;
}

void check_known(const std::vector<std::string>& wanted, const Ids& known, const char* option) {
    for (const std::string& id : wanted) {
        if (known.contains(id)) continue;
        const std::vector<std::string> list(known.begin(), known.end());
        throw InputError(fmt::format("{} {}: the city has no object of that id; did you mean '{}'?", option, id,
                                     nearest_word(id, list)));
    }
}

/// The ids with those of all objects below them.
Ids with_parts(const CityModel& city, Ids ids) {
    for (std::size_t size = 0; size != ids.size();) {
        size = ids.size();
        for (const CityObject& object : city.objects) {
            if (ids.contains(object.parent_id)) ids.insert(object.id);
        }
    }
    return ids;
}

CityModel without(const CityModel& city, const Ids& ids) {
    CityModel rest = city;
    std::erase_if(rest.objects, [&](const CityObject& object) { return ids.contains(object.id); });
    return rest;
}

CityModel only(const CityModel& city, const Ids& ids) {
    CityModel part = city;
    std::erase_if(part.objects, [&](const CityObject& object) { return !ids.contains(object.id); });
    return part;
}

/// One state of the city, ready for rays.
struct State {
    explicit State(const CityModel& city, FindingLog& findings)
        : scene(build_scene(city, {}, findings)), rays(std::make_unique<RayScene>(scene)) {}
    Scene scene;
    std::unique_ptr<RayScene> rays;
    StudyCity view() const { return {&scene, rays.get()}; }
};

bool wants(const Rule& rule, std::initializer_list<Metric> some) {
    const std::vector<Metric> all = rule.all_metrics();
    return std::any_of(some.begin(), some.end(),
                       [&](Metric m) { return std::find(all.begin(), all.end(), m) != all.end(); });
}

void check_rule_has_its_data(const StudyRequest& request) {
    const Rule& rule = request.rule;
    const bool has_plan = !request.added.empty() || !request.plan.empty();
    const bool has_before = has_plan || !request.removed.empty() || !request.before.empty();
    if (rule.needs_before && !has_before) {
        throw InputError(fmt::format(
            "rule {}: compares with the former state. Pass the plan by --add FILE, --plan ID or --remove ID, or the "
            "former city by --before CITY.",
            rule.id));
    }
    if (rule.occluders == Occluders::plan && !has_plan) {
        throw InputError(fmt::format(
            "rule {}: looks at the shadow of the plan alone. Say what the plan is by --add FILE or --plan ID.",
            rule.id));
    }
    const bool needs_weather =
        rule.needs_weather || wants(rule, {Metric::irradiation_kwh_m2, Metric::reflected_kwh_m2});
    if (needs_weather && !request.weather)
        throw InputError(fmt::format("rule {}: needs weather. Pass --weather FILE.epw.", rule.id));
}

void check_days_have_sun(const Rule& rule, const std::vector<SunDay>& days, const StudySettings& settings) {
    for (const SunDay& day : days) {
        if (day.hours() > 0.0) continue;
        throw InputError(fmt::format(
            "rule {}: on {:04}-{:02}-{:02} the sun does not come above {}° in the rule's window at latitude {:.2f}°. "
            "Choose other days with --days.",
            rule.id, day.year(), day.day().month, day.day().day, rule.min_elevation_deg,
            degrees_from_radians(settings.site.latitude_rad)));
    }
}

void check_receivers(const ReceiverSet& set, const StudyRequest& request) {
    std::vector<std::string> kinds;
    for (const ReceiverKind kind : request.receivers.kinds) kinds.emplace_back(name_of(kind));
    if (set.samples.empty()) {
        throw InputError(
            fmt::format("there is no receiver: the city has nothing of {} to look at{}. Choose others with "
                        "--receivers, give --points "
                        "or --polygons, or ground with --ground draped.",
                        fmt::join(kinds, ", "),
                        set.enclosed > 0 ? fmt::format(" ({} cells lie inside bodies)", set.enclosed) : ""));
    }
    for (const Receiver& receiver : set.receivers) {
        if (receiver.sample_begin == receiver.sample_end) {
            throw InputError(
                fmt::format("polygon '{}' holds no cell of open ground: it is smaller than --cell, lies outside the "
                            "city, or there is "
                            "no ground (--ground draped).",
                            receiver.id));
        }
    }
}

}  // namespace

StudyResult study_city(StudyRequest request, Progress& progress) {
    check_rule_has_its_data(request);
    StudyResult result;
    std::vector<std::filesystem::path> files = request.city;
    files.insert(files.end(), request.added.begin(), request.added.end());
    LoadedCity loaded = load_city(files, request.load, progress);
    if (loaded.city.objects.empty()) throw InputError("the city is empty: there is nothing to study.");
    const Ids known = ids_of(loaded.city);
    check_known(request.removed, known, "--remove");
    check_known(request.plan, known, "--plan");

    // What the plan brings and what it takes away.
    Ids planned(request.plan.begin(), request.plan.end());
    Ids removed(request.removed.begin(), request.removed.end());
    std::optional<LoadedCity> former;
    if (!request.added.empty()) {
        const Ids old = ids_of(load_city(request.city, request.load, progress).city);
        for (const std::string& id : known) {
            if (!old.contains(id)) planned.insert(id);
        }
    }
    if (!request.before.empty()) {
        former = load_city(request.before, request.load, progress);
        if (former->georeference.coordinate_crs != loaded.georeference.coordinate_crs) {
            throw InputError(fmt::format(
                "--before: the former city is in '{}', the city in '{}'. Bring both into one reference system.",
                former->georeference.coordinate_crs, loaded.georeference.coordinate_crs));
        }
        const Ids old = ids_of(former->city);
        for (const std::string& id : known) {
            if (!old.contains(id)) planned.insert(id);
        }
    }
    planned = with_parts(loaded.city, std::move(planned));
    removed = with_parts(loaded.city, std::move(removed));
    const bool has_before = former || !planned.empty() || !removed.empty();

    StudySettings& settings = request.settings;
    const std::optional<Site> site = request.site ? request.site : loaded.georeference.site;
    if (!site)
        throw InputError(
            "it is not known where on Earth the city lies: its file names no reference system that is known. Pass "
            "--site "
            "LAT,LON.");
    settings.site = *site;
    settings.convergence_rad = loaded.georeference.convergence_rad;
    std::vector<SunDay> days = days_of(request.rule, settings);
    check_days_have_sun(request.rule, days, settings);

    result.findings = loaded.findings;
    const State after(without(loaded.city, removed), result.findings);
    FindingLog told_already;
    std::optional<State> before, plan;
    if (has_before) before.emplace(former ? former->city : without(loaded.city, planned), told_already);
    if (request.rule.occluders == Occluders::plan) plan.emplace(only(loaded.city, planned), told_already);

    ReceiverOptions& receivers = request.receivers;
    if (receivers.kinds.empty()) {
        for (const ReceiverKind kind : request.rule.kinds) {
            // Kinds that live by a file are there when the file is.
            if (kind == ReceiverKind::polygon && !request.polygons) continue;
            if (kind == ReceiverKind::point && receivers.points.empty()) continue;
            receivers.kinds.push_back(kind);
        }
    }
    if (request.polygons) {
        const Box3d extent = extent_of(loaded.city);
        receivers.polygons = io::read_polygons(*request.polygons, loaded.georeference.coordinate_crs, Vec2d(extent.lo),
                                               Vec2d(extent.hi));
    }
    receivers.excluded_objects.assign(planned.begin(), planned.end());
    ReceiverSet set = make_receivers(after.scene, *after.rays, receivers);
    check_receivers(set, request);

    std::optional<YearLight> year;
    if (wants(request.rule, {Metric::sunshine_pct, Metric::winter_sunshine_pct, Metric::irradiation_kwh_m2,
                             Metric::reflected_kwh_m2})) {
        year = request.weather ? year_light(*request.weather, settings.site, settings.convergence_rad, request.period)
                               : cloudless_year(settings.year, settings.site, settings.convergence_rad);
        settings.year_light = &*year;
    }
    const StudyCity city = plan ? plan->view() : after.view();
    // The plan's own shadow has no former state.
    const std::optional<StudyCity> former_city =
        before && !plan ? std::optional<StudyCity>(before->view()) : std::nullopt;
    result.study = run_study(request.rule, std::move(set), std::move(days), city, former_city, settings, progress);
    for (const Level level : {Level::kind, Level::building, Level::storey, Level::facade, Level::receiver}) {
        std::vector<Group> groups = rolled_up(request.rule, result.study, level);
        result.groups.insert(result.groups.end(), std::make_move_iterator(groups.begin()),
                             std::make_move_iterator(groups.end()));
    }

    io::StudyFacts& facts = result.facts;
    facts.embree_isa = after.rays->isa();
    facts.rule_file = request.rule_file.string();
    facts.inputs = files;
    facts.inputs.insert(facts.inputs.end(), request.before.begin(), request.before.end());
    if (request.polygons) facts.inputs.push_back(*request.polygons);
    if (request.weather) facts.inputs.push_back(request.weather->file);
    facts.crs = loaded.georeference.coordinate_crs;
    facts.settings = settings;
    facts.settings.year_light = nullptr;
    facts.receivers = receivers;
    if (year) facts.weather = request.weather ? request.weather->name() : "none: every moment with the sun up";
    facts.plan.assign(planned.begin(), planned.end());
    facts.removed.assign(removed.begin(), removed.end());
    std::sort(facts.plan.begin(), facts.plan.end());
    std::sort(facts.removed.begin(), facts.removed.end());
    facts.has_before = former_city.has_value();
    return result;
}

std::vector<std::string> shipped_rules(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::filesystem::path rule_file_of(const std::string& name, const std::filesystem::path& folder) {
    if (const std::filesystem::path shipped = folder / (name + ".json"); std::filesystem::exists(shipped))
        return shipped;
    if (std::filesystem::exists(name)) return name;
    const std::vector<std::string> names = shipped_rules(folder);
    throw InputError(
        fmt::format("--rule '{}' is neither a file nor a shipped rule; did you mean '{}'? Shipped are: {}.", name,
                    nearest_word(name, names), fmt::join(names, ", ")));
}

}  // namespace skybake
