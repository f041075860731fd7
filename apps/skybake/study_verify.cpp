#include "study_verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/manifest/sha256.h"
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
    double largest = 0.0;  // difference in units of the honest one
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
    }
    if (next != told.size()) comparison.differ(fmt::format("the report has {} rows, not {}", told.size(), next));
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
                    {"differences", comparison.differences},
                    {"missing_tables", missing}});
    } else {
        fmt::print("{}: {} rows computed anew, {} of {} values to the last bit, {} difference{}.\n",
                   agrees ? "agrees" : "does not agree", comparison.rows, comparison.equal_values, comparison.values,
                   comparison.differences.size(), comparison.differences.size() == 1 ? "" : "s");
        for (const json& name : missing) fmt::print("not here to compare: {}\n", name.get<std::string>());
    }
    return agrees ? kDone : kDifference;
}

}  // namespace skybake::cli
