// skybake compare: two bakes of one atlas, texel by texel.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/manifest/compare_bakes.h"
#include "io/manifest/read_bake.h"
#include "program.h"

namespace skybake::cli {
namespace {

struct CompareSettings {
    std::string a;
    std::string b;
    std::string pictures;
    std::optional<double> max_rmse_lx;
    std::optional<double> range_lx;
    std::size_t worst_count = 10;
};

nlohmann::json to_json(const io::Deviation& d) {
    return {{"rmse", d.rmse},
            {"mean", d.mean},
            {"rmse_over_mean", d.rmse_over_mean()},
            {"bias", d.bias},
            {"max_abs", d.max_abs}};
}

double share_off(const io::PartDeviations& d) {
    return d.total.texels > 0 ? static_cast<double>(d.texels_off) / static_cast<double>(d.total.texels) : 0.0;
}

nlohmann::json to_json(const io::PartDeviations& d) {
    nlohmann::json json = to_json(d.total);
    json["texels"] = d.total.texels;
    json["texels_off_by_10_percent"] = d.texels_off;
    json["share_off_by_10_percent"] = share_off(d);
    json["parts"] = {{"sun", to_json(d.sun)}, {"sky", to_json(d.sky)}, {"indirect", to_json(d.indirect)}};
    return json;
}

nlohmann::json to_json(const io::BakeComparison& comparison) {
    nlohmann::json json = to_json(comparison.all);
    json["unit"] = "lx";
    json["reference"] = "B";
    json["texels_buried_in_one"] = comparison.buried_in_one;
    json["instants"] = nlohmann::json::array();
    for (const io::InstantComparison& instant : comparison.instants) {
        nlohmann::json entry = to_json(instant.deviations);
        entry["label"] = instant.label_b;
        entry["label_a"] = instant.label_a;
        json["instants"].push_back(entry);
    }
    json["worst"] = nlohmann::json::array();
    for (const io::WorstPlace& place : comparison.worst) {
        json["worst"].push_back({{"instant", place.instant},
                                 {"page", place.page},
                                 {"chart", place.chart},
                                 {"column", place.column},
                                 {"row", place.row},
                                 {"a", place.a_lx},
                                 {"b", place.b_lx},
                                 {"difference", place.a_lx - place.b_lx}});
    }
    json["pictures"] = comparison.pictures;
    return json;
}

void print_row(const std::string& name, const io::Deviation& d) {
    fmt::print("{:<28} {:>10.1f} {:>10.2f} {:>9.3f} % {:>10.2f} {:>10.1f}\n", name, d.mean, d.rmse,
               100.0 * d.rmse_over_mean(), d.bias, d.max_abs);
}

void print_table(const io::BakeComparison& comparison) {
    fmt::print("{:<28} {:>10} {:>10} {:>11} {:>10} {:>10}\n", "lx; B is the reference", "mean of B", "RMSE",
               "RMSE/mean", "bias A-B", "max |A-B|");
    if (comparison.instants.size() > 1) {
        for (const io::InstantComparison& instant : comparison.instants)
            print_row(instant.label_b, instant.deviations.total);
    }
    print_row("all", comparison.all.total);
    print_row("  sun", comparison.all.sun);
    print_row("  sky", comparison.all.sky);
    if (comparison.all.indirect.mean > 0.0 || comparison.all.indirect.max_abs > 0.0)
        print_row("  reflected", comparison.all.indirect);
    fmt::print("{} texels; {} ({:.4f} %) are off by more than 10 % of their instant's mean.\n",
               comparison.all.total.texels, comparison.all.texels_off, 100.0 * share_off(comparison.all));
    if (comparison.buried_in_one > 0)
        fmt::print("{} texels are buried in only one of the bakes; they are left out.\n", comparison.buried_in_one);
    if (comparison.worst.empty()) return;
    fmt::print("\nWorst texel of the worst charts:\n{:>8} {:>6} {:>8} {:>8} {:>8} {:>12} {:>12} {:>12}\n", "instant",
               "page", "chart", "column", "row", "A lx", "B lx", "A-B");
    for (const io::WorstPlace& w : comparison.worst) {
        fmt::print("{:>8} {:>6} {:>8} {:>8} {:>8} {:>12.1f} {:>12.1f} {:>12.1f}\n", w.instant, w.page, w.chart,
                   w.column, w.row, w.a_lx, w.b_lx, w.a_lx - w.b_lx);
    }
}

int run_compare(const CommonOptions& common, const CompareSettings& settings) {
    const io::StoredBake a = io::open_bake(settings.a);
    const io::StoredBake b = io::open_bake(settings.b);
    io::CompareOptions options;
    options.worst_count = settings.worst_count;
    options.picture_range_lx = settings.range_lx;
    if (!settings.pictures.empty()) options.picture_folder = settings.pictures;
    const oneapi::tbb::global_control limit(
        oneapi::tbb::global_control::max_allowed_parallelism,
        static_cast<std::size_t>(common.threads > 0 ? common.threads : oneapi::tbb::info::default_concurrency()));
    ConsoleProgress progress(common);
    const io::BakeComparison comparison = io::compare_bakes(a, b, options, progress);
    for (const io::InstantComparison& instant : comparison.instants) {
        if (instant.label_a != instant.label_b) {
            say(common, fmt::format("Compared by order: '{}' of A with '{}' of B.", instant.label_a, instant.label_b));
        }
    }
    if (common.wants_json) {
        print_json(to_json(comparison));
    } else {
        print_table(comparison);
    }
    if (!comparison.pictures.empty()) {
        say(common, fmt::format("{} difference pictures in {}: red where A is brighter, blue where it is darker, full "
                                "colour at the range that each name states.",
                                comparison.pictures.size(), settings.pictures));
    }
    if (settings.max_rmse_lx && comparison.all.total.rmse > *settings.max_rmse_lx) {
        say(common, fmt::format("RMSE {:.4g} lx exceeds --max-rmse {:.4g} lx.", comparison.all.total.rmse,
                                *settings.max_rmse_lx));
        return kDifference;
    }
    return kDone;
}

}  // namespace

void add_compare(CLI::App& app, Program& program) {
    const auto settings = std::make_shared<CompareSettings>();
    CLI::App* verb = add_verb(
        app, program, "compare",
        "How far bake A is from the reference bake B of the same atlas: RMSE, bias and maximum of the illuminance in "
        "lx, over\n"
        "all texels that belong to a chart, in total and for sun, sky and reflected light; instants are compared in "
        "their order.",
        "  skybake compare coarse/ reference/\n"
        "  skybake compare coarse/ reference/ --json --max-rmse 100\n"
        "  skybake compare coarse/ reference/ -o differences/ --range 2000",
        [&program, settings] { return run_compare(program.common, *settings); });
    verb->add_option("A", settings->a, "folder of the bake that is judged")->required();
    verb->add_option("B", settings->b, "folder of the reference bake")->required();
    verb->add_option("-o,--output", settings->pictures, "folder for difference pictures, one PNG a page and instant");
    verb->add_option("--range", settings->range_lx,
                     "lx at full colour of the pictures; default: 10 % of the instant's mean")
        ->check(CLI::PositiveNumber);
    verb->add_option("--max-rmse", settings->max_rmse_lx, "lx; exit with 1 when the RMSE of the total is larger")
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--worst", settings->worst_count, "how many of the worst charts to list")->capture_default_str();
}

}  // namespace skybake::cli
