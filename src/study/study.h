// A study: a rule's metrics at all samples, and its verdicts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/site.h"
#include "light/path_reference.h"
#include "study/new_shadow.h"
#include "study/receivers.h"
#include "study/rule.h"
#include "study/year_light.h"

namespace skybake {

/// One value a sample.
struct Column {
    Metric metric = Metric::sun_hours;
    std::optional<std::size_t> day;      // index into Study::days, for metrics of days
    std::optional<std::size_t> instant;  // index into Study::instants, for metrics of instants
    bool is_before = false;              // of the former state
    std::vector<float> values;
    /// "sun_hours_03-21", "before_sky_view_factor", "sun_lx_2026-06-21T12:00+02:00".
    std::string name;
};

/// What a criterion says of each sample.
struct CriterionResult {
    std::vector<float> value;  // over the days, as the criterion combines them
    std::vector<float> margin;
    std::vector<Verdict> verdict;         // none where the criterion is not asked of the sample's kind
    std::vector<Verdict> verdict_before;  // of the former state by the threshold alone; empty without one
};

struct Study {
    ReceiverSet receivers;
    std::vector<SunDay> days;
    std::vector<std::string> instants;  // as Daylight::label
    std::vector<Column> columns;
    std::vector<CriterionResult> criteria;  // one a criterion of the rule
    std::vector<NewShadow> new_shadows;     // with a former state
    std::uint64_t rays = 0;                 // without those of reflected light
    double sun_seconds = 0.0;               // time spent with intervals, and their rays: for rates
    std::uint64_t sun_rays = 0;
};

/// The index of the column of the former state that a column is compared with, where there is one.
std::optional<std::size_t> former_column(const Study& study, std::size_t column);

/// What stands there: triangles and their hierarchy.
struct StudyCity {
    const Scene* scene = nullptr;
    const RayScene* rays = nullptr;
};

struct StudySettings {
    Site site;
    double convergence_rad = 0.0;
    int year = 2026;
    std::optional<std::string> timezone;
    double scan_s = 60.0;
    int sky_directions = 4096;
    double ground_albedo = 0.2;             // of reflected_kwh_m2
    const YearLight* year_light = nullptr;  // for sunshine and irradiation
    std::vector<Daylight> instants;         // for illuminance
    PathOptions paths{64, 8, 0};            // of reflected light
};

/// The rule's days as the sun goes at the site.
std::vector<SunDay> days_of(const Rule& rule, const StudySettings& settings);

/// What the rule's criteria say of the columns: Study::criteria.
std::vector<CriterionResult> judged(const Rule& rule, const Study& study);

/// All metrics of the rule at the samples, in `city` and, where given, in `before`. A rule that looks at the plan's own
/// shadow gets the plan as `city`. `settings.year_light` must be there for metrics of the year, and `before` for
/// new_shadow_hours; metrics of instants have a column for each of `settings.instants`. Reflected light is that of
/// PathReference, under the year's light as a picture (`daylight_of`) or the instant's.
Study run_study(const Rule& rule, ReceiverSet receivers, std::vector<SunDay> days, const StudyCity& city,
                const std::optional<StudyCity>& before, const StudySettings& settings, Progress& progress);

}  // namespace skybake
