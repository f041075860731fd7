// skybake demo: the old town, baked and shown, by the same commands that a user would type.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "program.h"
#include "viewer_assets.h"

namespace skybake::cli {

namespace {

struct Options {
    std::string folder = "demo";
    int buildings = 250;
    double texel_m = 0.25;
    // Morning to evening, and a night that the lamps light.
    std::string at =
        "2026-06-21T07:00+02:00,2026-06-21T10:00+02:00,2026-06-21T13:00+02:00,2026-06-21T18:00+02:00,"
        "2026-06-21T23:00+02:00";
    int port = 0;
    bool stays_closed = false;
    bool only_bakes = false;
};

int run(const CommonOptions& common, const Options& options) {
    viewer_assets();  // say at once when the walkthrough is not built
    const std::filesystem::path folder = options.folder;
    std::filesystem::create_directories(folder);
    const std::string city = (folder / "town.city.json").string(), lamps = (folder / "town.lamps.json").string(),
                      lit = (folder / "lit").string();
    std::vector<std::vector<std::string>> commands{
        {"town", "-o", city, "--buildings", std::to_string(options.buildings), "--seed", std::to_string(common.seed)},
        {"bake", city, "-o", lit, "--texel", fmt::format("{}", options.texel_m), "--at", options.at, "--lamps", lamps,
         "--threads", std::to_string(common.threads)}};
    if (!options.only_bakes) {
        commands.push_back({"view", lit, "--port", std::to_string(options.port)});
        if (options.stays_closed) commands.back().push_back("--no-open");
    }
    for (std::vector<std::string>& command : commands) {
        say(common, fmt::format("> skybake {}", fmt::join(command, " ")));
        if (common.is_quiet) command.push_back("--quiet");
        if (common.wants_json && command.front() != "town") command.push_back("--json");
        const int exit_code = run_arguments(command);
        if (exit_code != kDone) return exit_code;
    }
    return kDone;
}

}  // namespace

void add_demo(CLI::App& app, Program& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* verb =
        add_verb(app, program, "demo", "Builds the procedural old town, bakes it, and opens the walkthrough.",
                 "  skybake demo\n"
                 "  skybake demo small --buildings 60 --texel 0.5 --no-open",
                 [&program, options] { return run(program.common, *options); });
    verb->add_option("DIR", options->folder, "folder for the town and its bake")->capture_default_str();
    verb->add_option("--buildings", options->buildings, "buildings of the town")
        ->capture_default_str()
        ->check(CLI::Range(10, 100000));
    verb->add_option("--texel", options->texel_m, "length of a lightmap texel, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 100.0));
    verb->add_option("--at", options->at, "instants to bake")->capture_default_str();
    verb->add_option("--port", options->port, "port on 127.0.0.1; 0 takes a free one")->capture_default_str();
    verb->add_flag("--no-open", options->stays_closed, "only serve, do not open the browser");
    verb->add_flag("--no-view", options->only_bakes, "stop after the bake");
}

}  // namespace skybake::cli
