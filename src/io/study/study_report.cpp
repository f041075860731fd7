#include <nlohmann/json.hpp>

#include "io/study/study_tables.h"
#include "study/study_rows.h"

namespace skybake::io {
namespace {

using nlohmann::json;

json group_json(const Rule& rule, const Study& study, const Group& group) {
    json columns = json::object(), criteria = json::object();
    for (std::size_t c = 0; c < study.columns.size(); ++c) {
        const GroupColumn& g = group.columns[c];
        columns[study.columns[c].name] = {{"mean", g.mean}, {"least", g.least}, {"greatest", g.greatest}};
    }
    for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
        const GroupCriterion& g = group.criteria[c];
        criteria[rule.criteria[c].id] = {{"area_pass", g.area_pass},
                                         {"area_borderline", g.area_borderline},
                                         {"area_fail", g.area_fail},
                                         {"least_margin", g.least_margin},
                                         {"verdict", name_of(g.verdict)}};
        if (g.area_pass_before) criteria[rule.criteria[c].id]["area_pass_before"] = *g.area_pass_before;
    }
    return {{"level", name_of(group.level)},
            {"id", group.id},
            {"kind", name_of(group.kind)},
            {"samples", group.samples},
            {"area_m2", group.area_m2},
            {"verdict", name_of(group.verdict)},
            {"values", columns},
            {"criteria", criteria}};
}

json rule_json(const Rule& rule) {
    json criteria = json::array();
    for (const Criterion& c : rule.criteria) {
        json entry = {{"id", c.id},
                      {"text", c.text},
                      {"metric", name_of(c.metric)},
                      {"unit", traits_of(c.metric).unit},
                      {"tolerance", c.tolerance},
                      {"area_share", c.area_share},
                      {"required", c.is_required}};
        if (c.at_least) entry["at_least"] = *c.at_least;
        if (c.at_most) entry["at_most"] = *c.at_most;
        if (c.or_share_of_before) entry["or_share_of_before"] = *c.or_share_of_before;
        if (c.or_share_of_area_before) entry["or_share_of_area_before"] = *c.or_share_of_area_before;
        criteria.push_back(std::move(entry));
    }
    return {{"id", rule.id},
            {"version", rule.version},
            {"title", rule.title},
            {"source", rule.source},
            {"source_date", rule.source_date},
            {"confirmed", rule.confirmed},
            {"to_check", rule.to_check},
            {"criteria", criteria}};
}

}  // namespace

json study_report(const Rule& rule, const Study& study, const std::vector<Group>& groups, const StudyFacts& facts) {
    json inputs = json::array(), tables = json::array();
    for (const StudyInput& input : facts.inputs)
        inputs.push_back(
            {{"role", input.role}, {"file", input.file}, {"bytes", input.bytes}, {"sha256", input.sha256}});
    for (const StudyInput& table : facts.tables)
        tables.push_back({{"file", table.file}, {"bytes", table.bytes}, {"sha256", table.sha256}});
    json columns = json::array();
    for (const Column& column : study.columns)
        columns.push_back(
            {{"name", column.name}, {"metric", name_of(column.metric)}, {"unit", traits_of(column.metric).unit}});
    json rows = json::array();
    for (const StudyRow& row : rows_of(study, sampled_packets(study.receivers, kReportPackets))) {
        const Vec3d& p = row.position;
        rows.push_back(
            {{"cell", row.sample}, {"receiver", row.receiver}, {"place", {p.x, p.y, p.z}}, {"values", row.values}});
    }
    json days = json::array();
    for (const SunDay& day : study.days) {
        days.push_back({{"month", day.day().month},
                        {"day", day.day().day},
                        {"window_begin", to_iso8601({day.begin(), 0})},
                        {"window_end", to_iso8601({day.time_of(day.length_s()), 0})},
                        {"hours", day.hours()}});
    }
    json kinds = json::array(), buildings = json::array();
    for (const Group& group : groups) {
        if (group.level == Level::kind) kinds.push_back(group_json(rule, study, group));
        if (group.level == Level::building) buildings.push_back(group_json(rule, study, group));
    }
    json shadows = json::array();
    for (const NewShadow& shadow : study.new_shadows) {
        const SunDay& day = study.days[shadow.day];
        const auto time = [&](float second) { return to_iso8601({day.time_of(static_cast<double>(second)), 0}); };
        shadows.push_back({{"receiver", study.receivers.receivers[shadow.receiver].id},
                           {"month", day.day().month},
                           {"day", day.day().day},
                           {"enter", time(shadow.episodes.front().begin_s)},
                           {"exit", time(shadow.episodes.back().end_s)},
                           {"minutes", shadow.total_min},
                           {"longest_sample_minutes", shadow.longest_sample_min},
                           {"area_share", shadow.area_share}});
    }
    const StudySettings& s = facts.settings;
    json settings = {{"year", s.year},
                     {"latitude_deg", degrees_from_radians(s.site.latitude_rad)},
                     {"longitude_deg", degrees_from_radians(s.site.longitude_rad)},
                     {"grid_convergence_deg", degrees_from_radians(s.convergence_rad)},
                     {"timezone", s.timezone ? json(*s.timezone) : json()},
                     {"scan_s", s.scan_s},
                     {"step_min", rule.sampled ? json(rule.sampled->step_s / 60.0) : json()},
                     {"min_elevation_deg", rule.min_elevation_deg},
                     {"sky_directions", s.sky_directions},
                     {"ground_albedo", s.ground_albedo},
                     {"paths", s.paths.paths},
                     {"bounces", s.paths.bounces},
                     {"seed", s.paths.seed},
                     {"instants", facts.instants},
                     {"cell_m", facts.receivers.cell_m},
                     {"height_m", facts.receivers.height_m},
                     {"storey_height_m", facts.receivers.storey_height_m},
                     {"months", facts.period.months},
                     {"weather", facts.weather ? json(*facts.weather) : json()}};
    return {{"skybake_study", 1},
            {"program", {{"version", facts.program_version}, {"isa", facts.embree_isa}}},
            {"rule", rule_json(rule)},
            {"inputs", inputs},
            {"arguments", facts.arguments},
            {"tables", tables},
            {"crs", facts.crs},
            {"settings", settings},
            {"has_before", facts.has_before},
            {"plan", facts.plan},
            {"removed", facts.removed},
            {"days", days},
            {"samples", study.receivers.samples.size()},
            {"receivers", study.receivers.receivers.size()},
            {"enclosed_cells_left_out", study.receivers.enclosed},
            {"rays", study.rays},
            {"columns", columns},
            {"kinds", kinds},
            {"buildings", buildings},
            {"new_shadow", shadows},
            {"rows", rows}};
}

}  // namespace skybake::io
