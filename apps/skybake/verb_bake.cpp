// skybake bake: sun, sky and reflected light of a city into lightmaps, ready for the walkthrough.
#include <fmt/format.h>

#include <memory>

#include "api/bake_city.h"
#include "bake_report.h"
#include "base/error.h"
#include "base/threads.h"
#include "bounce_options.h"
#include "city_options.h"
#include "lamp_options.h"
#include "light_options.h"
#include "program.h"
#include "viewer_assets.h"

namespace skybake::cli {

namespace {

struct Options {
    CityOptions city;
    LightOptions light;
    BounceOptions bounce;
    LampOptions lamps;
    float lamp_cutoff_lx = LampChartOptions().cutoff_lx;
    std::filesystem::path output;
    float texel_m = 0.5f;
    std::string sampling{kSkySamplingNames[0]};
    float tolerance = 0.01f;
    bool reports_leaks = false;
};

/// What decides the bytes of a bake, by the names of the options.
std::vector<std::pair<std::string, std::string>> settings_of(const Options& options) {
    std::vector<std::pair<std::string, std::string>> settings{
        {"at", options.light.at},
        {"timezone", options.light.timezone},
        {"site", options.light.site},
        {"sun-direction", options.light.sun_direction},
        {"sky", options.light.sky},
        {"weather", std::filesystem::path(options.light.weather).filename().string()},
        {"sun", options.light.sun},
        {"sky-samples", std::to_string(options.light.sky_samples)},
        {"albedo", options.light.albedo},
        {"crowns", options.light.crowns},
        {"leaves", options.light.leaves},
        {"crown-transmissivity",
         options.light.crown_transmissivity ? fmt::format("{}", *options.light.crown_transmissivity) : ""},
        {"lod", options.city.lod},
        {"ground", name_of(options.city.ground)},
        {"ground-margin", fmt::format("{}", options.city.ground_margin_m)},
        {"texel", fmt::format("{}", options.texel_m)},
        {"sampling", options.sampling},
        {"tolerance", fmt::format("{}", options.tolerance)}};
    if (!options.lamps.file.empty()) {
        settings.emplace_back("lamps", options.lamps.file.filename().string());
        settings.emplace_back("lamps-origin", options.lamps.origin);
        settings.emplace_back("lamp-cutoff", fmt::format("{}", options.lamp_cutoff_lx));
    }
    const auto bounce = settings_of(options.bounce);
    settings.insert(settings.end(), bounce.begin(), bounce.end());
    return settings;
}

std::string leak_text(const LeakReport& leaks, const std::filesystem::path& folder) {
    if (leaks.texels == 0) return "leaks: no texel would be lit through a wall.";
    const LeakReport::Place& w = leaks.worst;
    return fmt::format(
        "leaks: feelers keep light from {} texels, {:.1f} m2, {:.3g} lm in all; most on page {}, column {}, row {}: "
        "{:.0f} lx beside the {:.0f} lx there. Pictures: {}, red at {:.0f} lx",
        leaks.texels, leaks.area_m2, leaks.lumen, w.page, w.column, w.row, w.leak_lx, w.total_lx,
        (folder / "light/i*_p*_leaks.png").string(), leaks.picture_range_lx);
}

int run(const CommonOptions& common, const Options& options) {
    check_light_options(options.light);
    const Indirect indirect = indirect_of(options.bounce);
    if (options.reports_leaks && (indirect != Indirect::photons || options.bounce.feelers == 0))
        throw InputError(
            "--report-leaks: tells what feelers keep out; write --indirect photons with --feelers 4 or 8.");
    viewer_assets();  // a bake without its walkthrough is not whole: say so before the work
    const ThreadLimit threads(common.threads);
    BakeCityOptions bake;
    bake.files = options.city.files;
    bake.load = options.city.load_options();
    bake.daylight = daylight_settings_of(options.light);
    bake.site = site_of(options.light, std::nullopt);
    bake.albedo = parse_albedo(options.light.albedo);
    bake.crowns = crown_settings_of(options.light);
    bake.texel_m = options.texel_m;
    bake.bake.sky_samples = options.light.sky_samples;
    const auto name = std::find(kSkySamplingNames.begin(), kSkySamplingNames.end(), options.sampling);
    bake.bake.sampling = static_cast<SkySampling>(name - kSkySamplingNames.begin());
    bake.bake.tolerance = options.tolerance;
    if (indirect == Indirect::photons) bake.bake.bounces = photons_of(options.bounce, common.seed);
    bake.lamps = options.lamps.file;
    bake.lamps_origin = origin_of(options.lamps);
    bake.bake.lamp_sampling.cutoff_lx = options.lamp_cutoff_lx;
    if (bake.bake.sampling == SkySampling::full) bake.bake.lamp_sampling.sampling = LampSampling::full;
    if (indirect == Indirect::reference) bake.bake.bounces = path_options_of(options.bounce, common.seed);
    bake.bake.keeps_leaks = options.reports_leaks;
    bake.seed = common.seed;
    bake.version = SKYBAKE_VERSION;
    bake.settings = settings_of(options);
    bake.output = options.output;
    BakeCityResult result;
    {
        ConsoleProgress progress(common);
        result = bake_city(bake, progress);
    }
    copy_viewer(options.output);
    const int exit_code = report_findings(common, result.findings);
    const BakeReport& report = result.report;
    const StageSeconds& s = report.seconds;
    say(common, fmt::format("{}: {} buildings, {} triangles, {} charts on {} pages, {:.2f} million texels of {} m",
                            options.output.string(), report.buildings, report.triangles, report.charts, report.pages,
                            static_cast<double>(report.texels) * 1e-6, report.texel_m));
    if (bake.bake.sampling == SkySampling::projected) {
        say(common, fmt::format("sky: projected shadows; rays for {:.1f} % of texels times directions, {:.1f} million",
                                100.0 * report.evaluated_fraction, static_cast<double>(report.rays.sky) * 1e-6));
    } else {
        say(common, fmt::format("sky: {:.0f} million rays at {:.1f} million a second; {:.1f} % of full sampling, "
                                "predicted error against it {:.2f} %",
                                static_cast<double>(report.rays.sky) * 1e-6, report.rays_per_second * 1e-6,
                                100.0 * report.evaluated_fraction, 100.0 * report.predicted_rmse_over_mean));
    }
    if (report.lamps > 0) {
        say(common, fmt::format("lamps: {}, {:.1f} million rays at {:.1f} million a second; {:.1f} % of texels times "
                                "lamps in reach by 16 rays",
                                report.lamps, static_cast<double>(report.rays.lamp) * 1e-6,
                                static_cast<double>(report.rays.lamp) * 1e-6 / std::max(s.lamps, 1e-9),
                                100.0 * report.lamps_refined_fraction));
    }
    if (indirect == Indirect::photons) {
        const PhotonBalance& p = report.photons;
        say(common, fmt::format("photons: {:.1f} million rays at {:.1f} million a second, {:.1f} million at rest; of "
                                "{:.3g} lm {:.1f} % "
                                "absorbed, {:.1f} % escaped, {:.2g} % left; {:.1f} % of the texels gathered",
                                static_cast<double>(report.rays.photon) * 1e-6,
                                static_cast<double>(report.rays.photon) * 1e-6 / std::max(s.photons, 1e-9),
                                static_cast<double>(p.stored) * 1e-6, p.emitted, 100.0 * p.absorbed / p.emitted,
                                100.0 * p.escaped / p.emitted, 100.0 * p.at_limit / p.emitted,
                                100.0 * report.indirect_evaluated_fraction));
    }
    if (indirect == Indirect::reference) {
        say(common,
            fmt::format("paths: for {:.1f} % of the texels; {:.0f} lx reflected on the mean, standard error {:.1f} lx",
                        100.0 * report.indirect_evaluated_fraction, report.indirect.mean_lx, report.indirect.error_lx));
    }
    if (report.leaks) say(common, leak_text(*report.leaks, options.output));
    say(common,
        fmt::format("{:.1f} s: read {:.1f}, build {:.1f}, charts {:.1f}, sky {:.1f}, sun {:.1f}, lamps {:.1f}, photons "
                    "{:.1f}, gather {:.1f}, finish "
                    "{:.1f}, write {:.1f}; {:.0f} MB of memory",
                    s.total, s.read, s.build, s.charts, s.sky, s.sun, s.lamps, s.photons, s.gather, s.finish, s.write,
                    static_cast<double>(report.peak_rss_bytes) * 1e-6));
    say(common, fmt::format("Look at it: skybake view {}", options.output.string()));
    if (common.wants_json) {
        nlohmann::json object = to_json(report);
        if (report.leaks) {
            const LeakReport& l = *report.leaks;
            object["leaks"] = {
                {"texels", l.texels}, {"area_m2", l.area_m2}, {"lumen", l.lumen}, {"worst_lx", l.worst.leak_lx}};
        }
        object["findings"] = to_json(result.findings);
        object["output"] = options.output.string();
        print_json(object);
    }
    return exit_code;
}

}  // namespace

nlohmann::json to_json(const BakeReport& report) {
    const StageSeconds& s = report.seconds;
    const PhotonBalance& p = report.photons;
    return {{"buildings", report.buildings},
            {"triangles", report.triangles},
            {"charts", report.charts},
            {"pages", report.pages},
            {"texels", report.texels},
            {"texel_m", report.texel_m},
            {"rays",
             {{"sun", report.rays.sun},
              {"sky", report.rays.sky},
              {"lamp", report.rays.lamp},
              {"photon", report.rays.photon},
              {"feeler", report.rays.feeler}}},
            {"seconds",
             {{"read", s.read},
              {"build", s.build},
              {"charts", s.charts},
              {"sun", s.sun},
              {"sky", s.sky},
              {"lamps", s.lamps},
              {"photons", s.photons},
              {"gather", s.gather},
              {"finish", s.finish},
              {"write", s.write},
              {"total", s.total}}},
            {"rays_per_second", report.rays_per_second},
            {"evaluated_fraction", report.evaluated_fraction},
            {"predicted_rmse_over_mean", report.predicted_rmse_over_mean},
            {"lamps", report.lamps},
            {"lamps_refined_fraction", report.lamps_refined_fraction},
            {"indirect_evaluated_fraction", report.indirect_evaluated_fraction},
            {"indirect_lx", {{"mean", report.indirect.mean_lx}, {"standard_error", report.indirect.error_lx}}},
            {"photons_stored", p.stored},
            {"photon_lumen",
             {{"emitted", p.emitted}, {"absorbed", p.absorbed}, {"escaped", p.escaped}, {"at_limit", p.at_limit}}},
            {"peak_rss_bytes", report.peak_rss_bytes}};
}

void add_bake(CLI::App& app, Program& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* verb = add_verb(
        app, program, "bake",
        "Computes sun, sky and lamps for every surface of a city, into lightmaps with a walkthrough.",
        "  skybake bake town.city.json -o lit --at 2026-06-21T12:00+02:00\n"
        "  skybake bake delft.city.json -o lit --at 2026-03-21T08:00Z/2026-03-21T16:00Z/2h --ground plane\n"
        "  skybake bake city.jsonl -o lit --sun-direction 200,35 --texel 0.25 --sampling full\n"
        "  skybake bake town.city.json -o lit --sun-direction 200,35 --indirect photons --photons 2000000\n"
        "  skybake bake town.city.json -o lit --at 2026-06-21T23:30+02:00 --lamps town.lamps.json --indirect photons",
        [&program, options] { return run(program.common, *options); });
    add_city_options(verb, options->city);
    add_light_options(verb, options->light);
    add_bounce_options(verb, options->bounce);
    add_lamp_options(verb, options->lamps);
    verb->add_option("--lamp-cutoff", options->lamp_cutoff_lx,
                     "lamps that together give a place no more than this are left out there, lux")
        ->group("Lamps")
        ->type_name("LX")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    verb->add_flag("--report-leaks", options->reports_leaks,
                   "where walls would let photons through without feelers: figures, pictures, a channel of the EXRs");
    verb->add_option("-o,--output", options->output, "folder to write")->required();
    verb->add_option("--texel", options->texel_m, "length of a lightmap texel, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 100.0));
    verb->add_option(
            "--sampling", options->sampling,
            "projected: the shadows of everything on each surface, exact; hierarchical: rays from some texels, "
            "the paper's way; full: a ray from every texel in every direction, 16 to every lamp")
        ->capture_default_str()
        ->check(CLI::IsMember(std::vector<std::string>(kSkySamplingNames.begin(), kSkySamplingNames.end())));
    verb->add_option("--tolerance", options->tolerance, "error that the hierarchy may add to the skylight, relative")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
}

}  // namespace skybake::cli
