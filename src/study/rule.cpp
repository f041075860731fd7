#include "study/rule.h"

#include <algorithm>

namespace skybake {

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
