// A rule as data: what a standard, a bylaw or a study asks of sun and sky. Read from files by io/rules.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/metric.h"
#include "study/receivers.h"
#include "study/sun_day.h"
#include "study/sun_intervals.h"

namespace skybake {

/// How the values of several days become one.
enum class OverDays { each, any, mean };  // for a threshold "at least": the least, the greatest, the mean

struct Criterion {
    std::string id;
    std::string text;  // what it asks, for humans
    Metric metric = Metric::sun_hours;
    std::optional<double> at_least;  // exactly one of at_least and at_most, or none: then only reported
    std::optional<double> at_most;
    /// Instead of the threshold it is enough to keep this share of the former value.
    std::optional<double> or_share_of_before;
    /// Values within this distance of the threshold are borderline.
    double tolerance = 0.0;
    OverDays over_days = OverDays::each;
    double area_share = 1.0;  // of a group that has to meet it
    /// Instead of that share of the area it is enough to keep this share of the area that met it before.
    std::optional<double> or_share_of_area_before;
    bool is_required = true;  // higher levels of a rule are reported, but not failed
    /// Kinds it is asked of; empty: all of the rule's.
    std::vector<ReceiverKind> kinds;
};

enum class Occluders { all, plan };  // who throws shadows: the whole city, or the planned objects alone

/// What a rule says to humans, in another language than English.
struct RuleTexts {
    std::string title;
    std::vector<std::string> confirmed;
    std::vector<std::string> to_check;
    std::vector<std::string> criteria;  // Criterion::text of each
};

struct Rule {
    std::string id;
    std::string version;
    std::string title;
    std::string source;       // document, edition, section
    std::string source_date;  // of the edition
    std::vector<std::string> confirmed;
    std::vector<std::string> to_check;
    std::optional<RuleTexts> german;

    std::vector<ReceiverKind> kinds;
    double height_m = 0.0;  // of ground and polygon samples
    std::vector<CalendarDay> days;
    SunWindow window;
    double min_elevation_deg = 0.0;
    double min_incidence_deg = 0.0;
    double min_run_min = 0.0;
    std::optional<SampledConstruction> sampled;
    Occluders occluders = Occluders::all;
    bool needs_before = false;
    bool needs_weather = false;
    double swivel_deg = 30.0;     // of light_incidence_deg
    std::vector<Metric> metrics;  // reported besides those of the criteria
    std::vector<Criterion> criteria;

    /// The metrics to compute, each once.
    std::vector<Metric> all_metrics() const;
};

/// The thresholds that the rule has for a metric.
std::vector<double> thresholds_of(const Rule& rule, Metric metric);

enum class Verdict : std::uint8_t { none, pass, borderline, fail };
const char* name_of(Verdict verdict);

/// A value against a threshold: `margin` is positive on the side that meets it. Within the tolerance it is borderline.
struct Judgement {
    Verdict verdict = Verdict::none;
    double margin = 0.0;
};
/// `before` is the value of the former state, where there is one. Where a share of it is enough, a value that is no
/// worse than it passes.
Judgement judge(const Criterion& criterion, double value, std::optional<double> before);

}  // namespace skybake
