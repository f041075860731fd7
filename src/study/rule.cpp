#include "study/rule.h"

#include <algorithm>
#include <array>

namespace skybake {
namespace {
constexpr std::array<const char*, kMetricCount> kMetricNames{
    "sun_hours",           "longest_sun_hours",  "shadow_hours",      "longest_shadow_hours",
    "new_shadow_hours",    "sky_view_factor",    "sky_component_pct", "sunshine_pct",
    "winter_sunshine_pct", "irradiation_kwh_m2", "reflected_kwh_m2",  "light_incidence_deg"};
}

const char* name_of(Metric metric) {
    return kMetricNames[static_cast<std::size_t>(metric)];
}

std::optional<Metric> metric_of(std::string_view name) {
    const auto found = std::find(kMetricNames.begin(), kMetricNames.end(), name);
    if (found == kMetricNames.end()) return std::nullopt;
    return static_cast<Metric>(found - kMetricNames.begin());
}

bool is_of_days(Metric metric) {
    return metric <= Metric::new_shadow_hours;
}

bool prefers_more(Metric metric) {
    switch (metric) {
        case Metric::shadow_hours:
        case Metric::longest_shadow_hours:
        case Metric::new_shadow_hours:
        case Metric::light_incidence_deg:
            return false;
        default:
            return true;
    }
}

std::vector<Metric> Rule::all_metrics() const {
    std::vector<Metric> all = metrics;
    for (const Criterion& criterion : criteria) all.push_back(criterion.metric);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

std::vector<double> thresholds_of(const Rule& rule, Metric metric) {
    std::vector<double> thresholds;
    for (const Criterion& c : rule.criteria) {
        if (c.metric != metric) continue;
        if (c.at_least) thresholds.push_back(*c.at_least);
        if (c.at_most) thresholds.push_back(*c.at_most);
    }
    return thresholds;
}

const char* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::none:
            return "none";
        case Verdict::pass:
            return "pass";
        case Verdict::borderline:
            return "borderline";
        case Verdict::fail:
            return "fail";
    }
    return "";
}

Judgement judge(const Criterion& criterion, double value, std::optional<double> before) {
    if (!criterion.at_least && !criterion.at_most) return {};
    double margin = criterion.at_least ? value - *criterion.at_least : *criterion.at_most - value;
    if (criterion.or_share_of_before && before) {
        const double kept = value - *criterion.or_share_of_before * *before;
        margin = std::max(margin, criterion.at_least ? kept : -kept);
    }
    const bool is_no_worse = criterion.or_share_of_before && before && value >= *before;
    if (margin > criterion.tolerance || is_no_worse) return {Verdict::pass, margin};
    return {margin < -criterion.tolerance ? Verdict::fail : Verdict::borderline, margin};
}

}  // namespace skybake
