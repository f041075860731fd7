#include "study_verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/manifest/sha256.h"
#include "io/study/check_tables.h"
#include "study/study_rows.h"
#include "study_options.h"

namespace skybake::cli {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json read_report(const fs::path& path) {
    const std::vector<std::uint8_t> bytes = io::read_file(path, 1u << 30);
    json report = json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!report.is_object() || report.value("skybake_study", json()) != 1)
        throw InputError(fmt::format("{}: is no report of skybake study. Pass its report.json.", path.string()));
    return report;
}

void check_inputs(const json& report, const std::vector<io::StudyInput>& inputs, const fs::path& path) {
    const json& known = report.at("inputs");
    if (known.size() != inputs.size())
        throw InputError(
            fmt::format("{}: names {} inputs, its arguments {}.", path.string(), known.size(), inputs.size()));
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (known[i].at("sha256") == inputs[i].sha256) continue;
        throw InputError(fmt::format(
            "{}: its {} '{}' has changed since (SHA-256 {}… then, {}… now), so that the report does not speak of it. "
            "Put the file of then in its place, or make the study again.",
            path.string(), inputs[i].role, inputs[i].file, known[i].at("sha256").get<std::string>().substr(0, 12),
            inputs[i].sha256.substr(0, 12)));
    }
}

/// What was compared, and what did not agree.
struct Comparison {
    std::size_t rows = 0, values = 0, equal_values = 0;
    double largest = 0.0;                    // difference in units of the honest one
    std::uint64_t groups = 0, verdicts = 0;  // of the tables, that were made again from cells.csv
    std::vector<Column> columns;             // of the study, without values
    std::vector<std::string> differences;

    void differ(std::string what) { differences.push_back(std::move(what)); }
};

void compare_tables(const json& report, const fs::path& folder, Comparison& comparison, json& missing) {
    for (const json& table : report.at("tables")) {
        const std::string name = fs::path(table.at("file").get<std::string>()).filename().string();
        if (!fs::exists(folder / name)) {
            missing.push_back(name);
        } else if (io::hash_file(folder / name).sha256 != table.at("sha256")) {
            comparison.differ(fmt::format("{} is not the table that the report was written with", name));
        }
    }
}

void compare_row(const json& told, const StudyRow& row, const Study& study, Comparison& comparison) {
    ++comparison.rows;
    const Vec3d place(told.at("place")[0].get<double>(), told.at("place")[1].get<double>(),
                      told.at("place")[2].get<double>());
    if (told.at("receiver") != row.receiver || glm::length(place - row.position) > 1e-3) {
        comparison.differ(fmt::format("cell {} is of {} at another place", told.at("cell").dump(), row.receiver));
        return;
    }
    for (std::size_t c = 0; c < study.columns.size(); ++c) {
        const double then = told.at("values").at(c).get<double>(), now = static_cast<double>(row.values[c]);
        const double apart = std::abs(then - now) / traits_of(study.columns[c].metric).honest_difference;
        ++comparison.values;
        comparison.equal_values += then == now;
        comparison.largest = std::max(comparison.largest, apart);
        if (!(apart <= 1.0))
            comparison.differ(fmt::format("cell {} of {}: {} is {:.6g} in the report and {:.6g} now",
                                          told.at("cell").dump(), row.receiver, study.columns[c].name, then, now));
    }
}

void compare_rows(const json& report, const StudyRequest& request, const PreparedStudy& prepared,
                  Comparison& comparison) {
    if (report.at("samples") != prepared.receivers.samples.size()) {
        comparison.differ(fmt::format("the report has {} cells, the city {}", report.at("samples").dump(),
                                      prepared.receivers.samples.size()));
        return;
    }
    const json& told = report.at("rows");
    std::size_t next = 0;
    SilentProgress silent;
    for (const PacketRange& packet : sampled_packets(prepared.receivers, io::kReportPackets)) {
        const Study study = run_study(request.rule, only_packet(prepared.receivers, packet), prepared.days,
                                      prepared.city(), prepared.former(), prepared.settings, silent);
        for (const StudyRow& row : rows_of(study, {{0, packet.end - packet.begin}}))
            compare_row(told.at(next++), row, study, comparison);
        comparison.columns = study.columns;
    }
    if (next != told.size()) comparison.differ(fmt::format("the report has {} rows, not {}", told.size(), next));
}

/// The summaries of the report itself.
void compare_report_groups(const json& report, const Study& study, const std::vector<Group>& groups,
                           Comparison& comparison) {
    for (const auto& [key, level] : {std::pair{"kinds", Level::kind}, {"buildings", Level::building}}) {
        std::size_t next = 0;
        const json& told = report.at(key);
        for (const Group& group : groups) {
            if (group.level != level) continue;
            const json& entry = told.at(next++);
            const std::string name = fmt::format("{} {}", name_of(level), group.id);
            if (entry.at("id") != group.id || entry.at("verdict") != name_of(group.verdict)) {
                comparison.differ(fmt::format("{}: the report says {} ({}), its cells {}", name,
                                              entry.at("verdict").dump(), entry.at("id").dump(),
                                              name_of(group.verdict)));
            }
            for (std::size_t c = 0; c < study.columns.size(); ++c) {
                const double then = entry.at("values").at(study.columns[c].name).at("mean").get<double>();
                const double now = group.columns[c].mean;
                if (std::abs(then - now) > io::kTableDigits * std::max(std::abs(now), 0.1))
                    comparison.differ(fmt::format("{}: the mean of {} is {:.6g} in the report, and {:.6g} by its cells",
                                                  name, study.columns[c].name, then, now));
            }
        }
        if (next != told.size())
            comparison.differ(fmt::format("the report tells of {} {}, its cells of {}", told.size(), key, next));
    }
}

/// Summaries and verdicts from the rows of cells.csv, where it is there.
void compare_summaries(const json& report, const fs::path& folder, const Rule& rule, Comparison& comparison) {
    if (!fs::exists(folder / "cells.csv") || !fs::exists(folder / "groups.csv")) return;
    const io::TableStudy table = io::read_cells_csv(folder / "cells.csv", rule, comparison.columns);
    comparison.verdicts = table.verdicts;
    for (const std::string& text : table.other_verdicts) comparison.differ(text);
    const std::vector<Group> groups = rolled_up(rule, table.study);
    for (const std::string& text :
         io::check_groups_csv(folder / "groups.csv", rule, table.study, groups, comparison.groups))
        comparison.differ(text);
    compare_report_groups(report, table.study, groups, comparison);
}

}  // namespace

int verify_study(const CommonOptions& common, const fs::path& path) {
    const json report = read_report(path);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    Comparison comparison;
    json missing = json::array();
    try {
        StudyOptions options;
        std::uint64_t seed = 0;
        parse_study_arguments(report.at("arguments").get<std::vector<std::string>>(), folder, options, seed);
        check_inputs(report, study_inputs(options, folder), path);
        compare_tables(report, folder, comparison, missing);
        FindingLog findings;
        const StudyRequest request = study_request(options, seed, findings);
        ConsoleProgress progress(common);
        compare_rows(report, request, prepare_study(request, progress), comparison);
        if (!comparison.columns.empty()) compare_summaries(report, folder, request.rule, comparison);
    } catch (const json::exception& error) {
        throw InputError(fmt::format("{}: is damaged: {}", path.string(), error.what()));
    }
    constexpr std::size_t kTold = 10;
    for (std::size_t i = 0; i < std::min(kTold, comparison.differences.size()); ++i)
        fmt::print(stderr, "{}: {}.\n", path.string(), comparison.differences[i]);
    const std::string made_by = report.at("program").value("version", "?");
    if (made_by != SKYBAKE_VERSION) say(common, fmt::format("The report is of skybake {}.", made_by));
    const bool agrees = comparison.differences.empty();
    if (common.wants_json) {
        print_json({{"agrees", agrees},
                    {"rows", comparison.rows},
                    {"values", comparison.values},
                    {"equal_values", comparison.equal_values},
                    {"largest_difference", comparison.largest},
                    {"groups", comparison.groups},
                    {"verdicts", comparison.verdicts},
                    {"differences", comparison.differences},
                    {"missing_tables", missing}});
    } else {
        fmt::print("{}: {} rows computed anew, {} of {} values to the last bit, {} difference{}.\n",
                   agrees ? "agrees" : "does not agree", comparison.rows, comparison.equal_values, comparison.values,
                   comparison.differences.size(), comparison.differences.size() == 1 ? "" : "s");
        if (comparison.groups > 0)
            fmt::print("{} groups and {} verdicts of cells made again from cells.csv.\n", comparison.groups,
                       comparison.verdicts);
        for (const json& name : missing) fmt::print("not here to compare: {}\n", name.get<std::string>());
    }
    return agrees ? kDone : kDifference;
}

}  // namespace skybake::cli
