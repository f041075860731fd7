#include "api/prepared_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_set>

#include "api/bake_city.h"
#include "api/load_albedo.h"
#include "base/error.h"
#include "base/nearest_word.h"
#include "io/gdal/read_areas.h"
#include "io/gdal/write_maps.h"

namespace skybake {
namespace {

using Ids = std::unordered_set<std::string>;

/// Of texels that a study does not have: faces are cut into pieces as a bake of half a metre does.
constexpr float kPieceTexelM = 0.5f;
constexpr std::int64_t kMostRasterPixels = 100'000'000;  // of ground.tif: 400 MB a band

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

bool wants(const Rule& rule, bool (*is_such)(Metric)) {
    const std::vector<Metric> all = rule.all_metrics();
    return std::any_of(all.begin(), all.end(), is_such);
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
    const bool needs_weather = rule.needs_weather || wants(rule, is_energy);
    if (needs_weather && !request.weather)
        throw InputError(fmt::format("rule {}: needs weather. Pass --weather FILE.epw.", rule.id));
    if (wants(rule, is_of_instants) && !request.instants)
        throw InputError(fmt::format("rule {}: illuminance is that of instants. Pass --at TIME.", rule.id));
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

void check_receivers(const ReceiverSet& set, const ReceiverOptions& options) {
    std::vector<std::string> kinds;
    for (const ReceiverKind kind : options.kinds) kinds.emplace_back(name_of(kind));
    if (set.samples.empty()) {
        throw InputError(
            fmt::format("there is no receiver: the city has nothing of {} to look at{}. Choose others with "
                        "--receivers, give --points "
                        "or --polygons, or ground with --ground draped.",
                        fmt::join(kinds, ", "),
                        set.enclosed > 0 ? fmt::format(" ({} cells lie inside bodies)", set.enclosed) : ""));
    }
    const std::optional<io::RasterExtent> raster = io::raster_extent(set);
    if (raster && raster->width * raster->height > kMostRasterPixels) {
        throw InputError(
            fmt::format("a raster of the ground cells would have {} × {} pixels: the areas lie far apart. Study them "
                        "one by one, or use a larger --cell.",
                        raster->width, raster->height));
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

/// What the plan brings: named objects, and those that a file of the plan or a former city does not have.
Ids planned_objects(const StudyRequest& request, const Ids& known, const std::optional<LoadedCity>& former,
                    Progress& progress) {
    Ids planned(request.plan.begin(), request.plan.end());
    std::optional<Ids> old;
    if (!request.added.empty()) old = ids_of(load_city(request.city, request.load, progress).city);
    if (former) old = ids_of(former->city);
    for (const std::string& id : known) {
        if (old && !old->contains(id)) planned.insert(id);
    }
    return planned;
}

/// The former city, in the reference system of the new one.
std::optional<LoadedCity> former_city(const StudyRequest& request, const Georeference& georeference,
                                      Progress& progress) {
    if (request.before.empty()) return std::nullopt;
    LoadedCity former = load_city(request.before, request.load, progress);
    if (former.georeference.coordinate_crs != georeference.coordinate_crs) {
        throw InputError(
            fmt::format("--before: the former city is in '{}', the city in '{}'. Bring both into one reference system.",
                        former.georeference.coordinate_crs, georeference.coordinate_crs));
    }
    return former;
}

void place_on_earth(const StudyRequest& request, const Georeference& georeference, StudySettings& settings) {
    const std::optional<Site> site = request.site ? request.site : georeference.site;
    if (!site)
        throw InputError(
            "it is not known where on Earth the city lies: its file names no reference system that is known. Pass "
            "--site LAT,LON.");
    settings.site = *site;
    settings.convergence_rad = georeference.convergence_rad;
}

/// The request's receivers, or the rule's: kinds that live by a file are there when the file is.
void choose_receivers(const StudyRequest& request, const LoadedCity& loaded, ReceiverOptions& receivers) {
    for (const ReceiverKind kind : request.rule.kinds) {
        if (!request.receivers.kinds.empty()) break;
        if (kind == ReceiverKind::polygon && !request.polygons) continue;
        if (kind == ReceiverKind::point && receivers.points.empty()) continue;
        receivers.kinds.push_back(kind);
    }
    if (!request.polygons) return;
    const Box3d extent = extent_of(loaded.city);
    receivers.polygons =
        io::read_polygons(*request.polygons, loaded.georeference.coordinate_crs, Vec2d(extent.lo), Vec2d(extent.hi));
}

}  // namespace

LoadedCity load_study_city(const StudyRequest& request, Progress& progress) {
    check_rule_has_its_data(request);
    LoadedCity loaded = load_city(city_files(request), request.load, progress);
    if (loaded.city.objects.empty()) throw InputError("the city is empty: there is nothing to study.");
    return loaded;
}

std::vector<std::filesystem::path> city_files(const StudyRequest& request) {
    std::vector<std::filesystem::path> files = request.city;
    files.insert(files.end(), request.added.begin(), request.added.end());
    return files;
}

PreparedStudy prepare_states(const StudyRequest& request, const LoadedCity& loaded, Progress& progress) {
    PreparedStudy study;
    study.city_files = city_files(request);
    const Ids known = ids_of(loaded.city);
    check_known(request.removed, known, "--remove");
    check_known(request.plan, known, "--plan");
    const std::optional<LoadedCity> former = former_city(request, loaded.georeference, progress);
    const Ids planned = with_parts(loaded.city, planned_objects(request, known, former, progress));
    const Ids removed = with_parts(loaded.city, {request.removed.begin(), request.removed.end()});
    study.plan.assign(planned.begin(), planned.end());
    study.removed.assign(removed.begin(), removed.end());
    std::sort(study.plan.begin(), study.plan.end());
    std::sort(study.removed.begin(), study.removed.end());
    study.crs = loaded.georeference.coordinate_crs;

    study.settings = request.settings;
    place_on_earth(request, loaded.georeference, study.settings);
    study.days = days_of(request.rule, study.settings);
    check_days_have_sun(request.rule, study.days, study.settings);

    study.findings = loaded.findings;
    FindingLog told_already;
    const SceneOptions options = scene_options(request.albedo, kPieceTexelM);
    study.after = std::make_unique<CityState>(without(loaded.city, removed), options, study.findings);
    if (former || !planned.empty() || !removed.empty())
        study.before =
            std::make_unique<CityState>(former ? former->city : without(loaded.city, planned), options, told_already);
    if (!planned.empty())
        study.planned = std::make_unique<CityState>(only(loaded.city, planned), options, told_already);
    if (wants(request.rule, is_reflected)) {
        for (CityState* state : {study.after.get(), study.before.get(), study.planned.get()}) {
            if (state)
                load_albedo_images(state->scene, state == study.after.get() ? study.findings : told_already, progress);
        }
    }

    const StudySettings& s = study.settings;
    if (wants(request.rule, is_of_year)) {
        study.year = std::make_unique<YearLight>(
            request.weather ? year_light(*request.weather, s.site, s.convergence_rad, request.period)
                            : cloudless_year(s.year, s.site, s.convergence_rad, request.period));
        study.settings.year_light = study.year.get();
    }
    if (request.instants)
        study.settings.instants = make_daylights(*request.instants, s.site, s.convergence_rad, study.findings);
    study.looks_at_plan_alone = request.rule.occluders == Occluders::plan;
    return study;
}

PreparedStudy prepare_study(const StudyRequest& request, Progress& progress) {
    const LoadedCity loaded = load_study_city(request, progress);
    PreparedStudy study = prepare_states(request, loaded, progress);
    study.receiver_options = request.receivers;
    choose_receivers(request, loaded, study.receiver_options);
    study.receiver_options.excluded_objects = study.plan;
    study.receivers = make_receivers(study.after->scene, study.after->rays, study.receiver_options);
    check_receivers(study.receivers, study.receiver_options);
    if (request.wants_city) {
        study.city_model = without(loaded.city, Ids(study.removed.begin(), study.removed.end()));
        to_named_system(*study.city_model, loaded.georeference);
    }
    return study;
}

}  // namespace skybake
