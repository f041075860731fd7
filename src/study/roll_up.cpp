#include "study/roll_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace skybake {
namespace {

/// The group of a receiver at a level; empty when it has none.
std::string group_of(const Receiver& receiver, Level level) {
    switch (level) {
        case Level::receiver:
            return receiver.id;
        case Level::facade:
            return receiver.kind == ReceiverKind::facade ? fmt::format("{}/{}", receiver.object_id, *receiver.surface)
                                                         : "";
        case Level::storey:
            return receiver.storey ? fmt::format("{}/{}", receiver.building_id, *receiver.storey) : "";
        case Level::building:
            return receiver.building_id;
        case Level::kind:
            return name_of(receiver.kind);
    }
    return "";
}

void judge_group(const Rule& rule, Group& group) {
    constexpr double kRounding = 1e-9;
    for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
        GroupCriterion& result = group.criteria[c];
        const double asked = result.area_pass + result.area_borderline + result.area_fail;
        if (!(asked > 0.0)) continue;
        result.area_pass /= asked;
        result.area_borderline /= asked;
        result.area_fail /= asked;
        if (result.area_pass_before) *result.area_pass_before /= asked;
        const std::optional<double>& kept = rule.criteria[c].or_share_of_area_before;
        double wanted = rule.criteria[c].area_share - kRounding;
        if (kept && result.area_pass_before) wanted = std::min(wanted, *kept * *result.area_pass_before - kRounding);
        result.verdict = result.area_pass >= wanted                            ? Verdict::pass
                         : result.area_pass + result.area_borderline >= wanted ? Verdict::borderline
                                                                               : Verdict::fail;
        if (rule.criteria[c].is_required) group.verdict = std::max(group.verdict, result.verdict);
    }
}

}  // namespace

const char* name_of(Level level) {
    switch (level) {
        case Level::receiver:
            return "receiver";
        case Level::facade:
            return "facade";
        case Level::storey:
            return "storey";
        case Level::building:
            return "building";
        case Level::kind:
            return "kind";
    }
    return "";
}

std::vector<Group> rolled_up(const Rule& rule, const Study& study, Level level) {
    std::vector<Group> groups;
    std::unordered_map<std::string, std::size_t> by_id;
    for (const Receiver& receiver : study.receivers.receivers) {
        const std::string id = group_of(receiver, level);
        if (id.empty() || receiver.sample_begin == receiver.sample_end) continue;
        // Two receivers of one id (a point named like a building) stay apart by kind, but for a building's own.
        const std::string key = level == Level::building ? id : fmt::format("{} {}", name_of(receiver.kind), id);
        const auto [entry, is_new] = by_id.try_emplace(key, groups.size());
        if (is_new) {
            Group group;
            group.level = level;
            group.id = id;
            group.kind = receiver.kind;
            group.building_id = level == Level::kind ? "" : receiver.building_id;
            group.columns.assign(study.columns.size(), {0.0, 1e30, -1e30});
            group.criteria.resize(rule.criteria.size());
            groups.push_back(std::move(group));
        }
        Group& group = groups[entry->second];
        for (std::uint32_t s = receiver.sample_begin; s < receiver.sample_end; ++s) {
            const bool is_free = receiver.kind == ReceiverKind::point;
            const double weight = is_free ? 1.0 : static_cast<double>(study.receivers.samples[s].area_m2);
            ++group.samples;
            group.area_m2 += weight;
            for (std::size_t c = 0; c < study.columns.size(); ++c) {
                const double value = static_cast<double>(study.columns[c].values[s]);
                GroupColumn& column = group.columns[c];
                column.mean += weight * value;
                column.least = std::min(column.least, value);
                column.greatest = std::max(column.greatest, value);
            }
            for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
                GroupCriterion& result = group.criteria[c];
                if (const std::vector<Verdict>& former = study.criteria[c].verdict_before; !former.empty())
                    result.area_pass_before =
                        result.area_pass_before.value_or(0.0) + (former[s] == Verdict::pass ? weight : 0.0);
                if (study.criteria[c].verdict[s] != Verdict::none) {
                    const double margin = static_cast<double>(study.criteria[c].margin[s]);
                    const bool is_first = result.area_pass + result.area_borderline + result.area_fail == 0.0;
                    result.least_margin = is_first ? margin : std::min(result.least_margin, margin);
                }
                switch (study.criteria[c].verdict[s]) {
                    case Verdict::pass:
                        result.area_pass += weight;
                        break;
                    case Verdict::borderline:
                        result.area_borderline += weight;
                        break;
                    case Verdict::fail:
                        result.area_fail += weight;
                        break;
                    case Verdict::none:
                        break;
                }
            }
        }
    }
    for (Group& group : groups) {
        for (GroupColumn& column : group.columns) column.mean /= group.area_m2;
        judge_group(rule, group);
    }
    return groups;
}

std::vector<Group> rolled_up(const Rule& rule, const Study& study) {
    std::vector<Group> all;
    for (const Level level : {Level::kind, Level::building, Level::storey, Level::facade, Level::receiver}) {
        std::vector<Group> groups = rolled_up(rule, study, level);
        all.insert(all.end(), std::make_move_iterator(groups.begin()), std::make_move_iterator(groups.end()));
    }
    return all;
}

}  // namespace skybake
