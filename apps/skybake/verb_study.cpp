// skybake study: sun and shadow by a rule, with verdicts, tables, maps and a report.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "api/study_texels.h"
#include "base/error.h"
#include "base/threads.h"
#include "io/file/replace_file.h"
#include "io/gdal/write_maps.h"
#include "io/manifest/sha256.h"
#include "io/rules/read_rule.h"
#include "io/study/study_city_json.h"
#include "io/study/study_html.h"
#include "program.h"
#include "study_options.h"
#include "study_verify.h"

namespace skybake::cli {

namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
    io::FileReplacement file(path);
    file.write(text);
    file.commit();
}

/// The tables and maps beside the report, and their hashes.
void write_tables(const StudyOptions& options, const Rule& rule, StudyResult& result) {
    const Study& study = result.study;
    const fs::path& folder = options.output;
    std::vector<std::string> names{"groups.csv"};
    io::write_groups_csv(folder / "groups.csv", rule, study, result.groups);
    if (!options.leaves_out_cells) {
        io::write_cells_csv(folder / "cells.csv", rule, study);
        io::write_cells_gpkg(folder / "cells.gpkg", rule, study, result.facts.crs);
        io::write_study_city(std::move(*result.city), folder / "city.city.json", rule, study, result.groups);
        names.insert(names.end(), {"cells.csv", "city.city.json"});
    }
    io::write_ground_tiff(folder / "ground.tif", study, result.facts.crs);
    if (!result.pictures->shadows.empty())
        io::write_shadows_gpkg(folder / "shadows.gpkg", *result.pictures, study, result.facts.settings.convergence_rad,
                               result.facts.crs);
    if (result.facts.has_before) {
        io::write_new_shadow_csv(folder / "new_shadow.csv", study);
        names.push_back("new_shadow.csv");
    }
    for (const std::string& name : names) {
        const io::FileHash hash = io::hash_file(folder / name);
        result.facts.tables.push_back({"", name, hash.bytes, hash.sha256});
    }
}

void print_verdicts(const Rule& rule, const StudyResult& result) {
    fmt::print("{} ({} {})\n", rule.title, rule.id, rule.version);
    for (const Group& group : result.groups) {
        if (group.level != Level::kind) continue;
        fmt::print("{}: {} cells, {:.0f} m2\n", group.id, group.samples, group.area_m2);
        for (std::size_t c = 0; c < result.study.columns.size(); ++c) {
            const GroupColumn& g = group.columns[c];
            fmt::print("  {:<34} {:8.2f} {} on average, {:.2f} to {:.2f}\n", result.study.columns[c].name, g.mean,
                       traits_of(result.study.columns[c].metric).unit, g.least, g.greatest);
        }
        for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
            const GroupCriterion& g = group.criteria[c];
            if (g.verdict == Verdict::none) continue;
            fmt::print("  {:<34} {}: {:.1f} % of the area pass, {:.1f} % borderline, {:.1f} % fail\n",
                       rule.criteria[c].id, name_of(g.verdict), 100 * g.area_pass, 100 * g.area_borderline,
                       100 * g.area_fail);
        }
    }
    for (const std::string& note : rule.to_check) fmt::print("to check: {}\n", note);
}

void list_rules() {
    for (const std::string& name : shipped_rules(rules_folder())) {
        const Rule rule = io::read_rule(rule_file_of(name, rules_folder()));
        fmt::print("{:<24} {} ({})\n", name, rule.title, rule.source_date);
    }
}

/// --texels: no tables and no verdicts, but layers in a bake.
int run_on_texels(const CommonOptions& common, const StudyOptions& options) {
    if (!options.output.empty() || !options.receivers.empty())
        throw InputError(
            "--texels writes into the bake, and its texels are the receivers: leave out -o and --receivers, or call "
            "study a second time for tables and a report.");
    FindingLog findings;
    const StudyRequest request = study_request(options, common.seed, findings);
    ConsoleProgress progress(common);
    const auto begin = std::chrono::steady_clock::now();
    TexelStudy result = study_texels(request, options.texels, progress);
    result.findings.merge(findings);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const int exit_code = report_findings(common, result.findings);
    say(common,
        fmt::format("{} texels, {:.3g} rays, {:.1f} s", result.texels, static_cast<double>(result.rays), seconds));
    if (common.wants_json) {
        print_json({{"bake", options.texels.string()},
                    {"layers", result.layers},
                    {"texels", result.texels},
                    {"rays", result.rays},
                    {"seconds", seconds},
                    {"findings", to_json(result.findings)}});
    } else {
        for (const std::string& layer : result.layers) fmt::print("{}\n", layer);
        fmt::print("See them with: skybake view {}\n", options.texels.string());
    }
    return exit_code;
}

int run(const CommonOptions& common, const StudyOptions& options, const CLI::App& verb) {
    if (options.lists_rules) {
        list_rules();
        return kDone;
    }
    const ThreadLimit threads(common.threads);
    if (!options.verified.empty()) return verify_study(common, options.verified);
    if (options.city.files.empty()) throw InputError("study needs a CITY: city files (or --list-rules, or --verify).");
    if (!options.texels.empty()) return run_on_texels(common, options);
    const auto begin = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const bool writes = !options.output.empty();
    if (writes) {
        std::error_code error;
        fs::create_directories(options.output, error);
        if (error)
            throw InputError(fmt::format("-o {}: cannot be made: {}.", options.output.string(), error.message()));
    }
    FindingLog weather_findings;
    StudyRequest request = study_request(options, common.seed, weather_findings);
    request.wants_pictures = writes;
    request.wants_city = writes && !options.leaves_out_cells;
    const Rule& rule = request.rule;
    ConsoleProgress progress(common);
    StudyResult result = study_city(request, progress);
    result.findings.merge(weather_findings);
    result.facts.program_version = SKYBAKE_VERSION;
    const fs::path folder = writes ? options.output : fs::path(".");
    result.facts.inputs = study_inputs(options, folder);
    result.facts.arguments = study_arguments(verb, options, folder);
    if (writes) write_tables(options, rule, result);
    nlohmann::json report = io::study_report(rule, result.study, result.groups, result.facts);
    if (writes) {
        write_text(folder / "report.html",
                   io::study_html({rule, result.study, result.groups, result.facts, *result.pictures, result.findings},
                                  options.language));
        // Last, so that a folder with a report.json is whole.
        write_text(folder / "report.json", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    }
    const int exit_code = report_findings(common, result.findings);
    const Study& study = result.study;
    const double rate = study.sun_seconds > 0.0 ? static_cast<double>(study.sun_rays) / study.sun_seconds : 0.0;
    say(common, fmt::format("{} cells, {:.3g} rays, sun {:.1f} s at {:.1f} million rays/s, {:.1f} s in all",
                            study.receivers.samples.size(), static_cast<double>(study.rays), study.sun_seconds,
                            1e-6 * rate, seconds()));
    if (common.wants_json) {
        report["seconds"] = {{"sun", study.sun_seconds}, {"total", seconds()}};
        report["rays_per_second"] = rate;
        report["findings"] = to_json(result.findings);
        print_json(report);
    } else {
        print_verdicts(rule, result);
    }
    return exit_code;
}

}  // namespace

void add_study(CLI::App& app, Program& program) {
    const auto options = std::make_shared<StudyOptions>();
    const auto verb = std::make_shared<CLI::App*>();
    *verb = add_verb(
        app, program, "study", "Sun and shadow by a rule: exact intervals, sky, energy, verdicts, before and after.",
        "  skybake study --list-rules\n"
        "  skybake study town.city.json --rule en17037-sunlight --days 03-21 -o study\n"
        "  skybake study town.city.json --rule nyc-ceqr --add tower.city.json --polygons parks.geojson -o study\n"
        "  skybake study town.city.json --rule tno-light --texels town.bake\n"
        "  skybake study --verify study/report.json",
        [&program, options, verb] { return run(program.common, *options, **verb); });
    add_study_options(*verb, *options);
}

}  // namespace skybake::cli
