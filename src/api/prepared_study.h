// A study's city in all its states, ready for rays: what study_city, its pictures and the check of a report start with.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/load_city.h"
#include "scene/scene.h"
#include "sky/daylight_settings.h"
#include "sky/weather.h"
#include "study/study.h"

namespace skybake {

struct StudyRequest {
    std::vector<std::filesystem::path> city;
    std::vector<std::filesystem::path> added;   // files of the plan
    std::vector<std::filesystem::path> before;  // another city as the former state
    std::vector<std::string> plan;              // objects of the city that are the plan
    std::vector<std::string> removed;           // objects that the plan takes away
    LoadOptions load;

    Rule rule;
    std::filesystem::path rule_file;
    ReceiverOptions receivers;  // without polygons, and without kinds: then the rule's
    std::optional<std::filesystem::path> polygons;
    std::optional<std::filesystem::path> points;  // where receivers.points come from
    std::optional<Site> site;                     // instead of the CRS's
    std::optional<Weather> weather;
    Period period;
    std::optional<DaylightSettings> instants;         // for illuminance
    std::vector<std::pair<std::string, Rgb>> albedo;  // of reflected light, by surface type (BakeCityOptions::albedo)
    StudySettings settings;                           // site, convergence, year_light and instants are filled in here
    bool wants_pictures = false;
    bool wants_city = false;  // StudyResult::city
};

/// One state of the city, ready for rays.
struct CityState {
    CityState(const CityModel& city, const SceneOptions& options, FindingLog& findings)
        : scene(build_scene(city, options, findings)), rays(scene) {}
    Scene scene;
    RayScene rays;
    StudyCity view() const { return {&scene, &rays}; }
};

struct PreparedStudy {
    std::optional<CityModel> city_model;            // what stands there after, where the request wants it, in the
                                                    // reference system that it names
    std::vector<std::filesystem::path> city_files;  // with those of the plan
    std::string crs;
    std::vector<std::string> plan, removed;  // objects with all below them; sorted
    FindingLog findings;
    std::unique_ptr<CityState> after;
    std::unique_ptr<CityState> before;   // none without a former state
    std::unique_ptr<CityState> planned;  // what the plan brings, alone; none without
    std::vector<SunDay> days;
    ReceiverOptions receiver_options;
    ReceiverSet receivers;
    std::unique_ptr<YearLight> year;  // none where the rule needs none
    StudySettings settings;
    bool looks_at_plan_alone = false;

    StudyCity city() const { return looks_at_plan_alone ? planned->view() : after->view(); }
    /// The plan's own shadow has no former state.
    std::optional<StudyCity> former() const {
        return before && !looks_at_plan_alone ? std::optional<StudyCity>(before->view()) : std::nullopt;
    }
};

/// The files of the city with those of the plan.
std::vector<std::filesystem::path> city_files(const StudyRequest& request);

/// The city with the plan. Throws InputError when it is empty, or when the rule lacks what it needs (former state,
/// weather, plan).
LoadedCity load_study_city(const StudyRequest& request, Progress& progress);

/// The states of the loaded city, without receivers. Throws InputError for what makes the study impossible: no place on
/// Earth, a day without sun, unknown objects, a former state in another reference system.
PreparedStudy prepare_states(const StudyRequest& request, const LoadedCity& loaded, Progress& progress);

/// Both of the above, and the receivers. Throws InputError where there are none.
PreparedStudy prepare_study(const StudyRequest& request, Progress& progress);

}  // namespace skybake
