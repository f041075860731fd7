// What every verb of the command line shares: the common options, the ways to speak, and how a verb is registered.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/finding.h"
#include "base/progress.h"

namespace skybake::cli {

enum ExitCode : int { kDone = 0, kDifference = 1, kWrongUse = 2, kOurBug = 3, kInterrupted = 130 };

/// Options that every verb has.
struct CommonOptions {
    int threads = 0;  // 0: as many as there are cores
    std::uint64_t seed = 0;
    bool is_quiet = false;
    bool wants_json = false;
    bool is_strict = false;
};

/// The verb that was chosen on the command line, to be run after parsing.
struct Program {
    CommonOptions common;
    std::function<int()> run;
};

/// Adds the subcommand `name` with the common options; `run` is called when it was chosen. `examples` stand at the end
/// of its help.
CLI::App* add_verb(CLI::App& app, Program& program, const std::string& name, const std::string& description,
                   const std::string& examples, std::function<int()> run);

/// A line for humans on stderr; silent under --quiet.
void say(const CommonOptions& common, const std::string& line);
/// Prints all findings for humans on stderr (errors and warnings also under --quiet) and tells the exit code they ask
/// for: kDifference when --strict and there is one of severity error, else kDone.
int report_findings(const CommonOptions& common, const FindingLog& findings);
nlohmann::json to_json(const FindingLog& findings);
/// The one JSON object of --json, on stdout.
void print_json(const nlohmann::json& object);

/// Progress on stderr: a moving line with rate and remaining time on a terminal, a line now and then otherwise; Ctrl-C
/// sets stop_requested.
class ConsoleProgress final : public Progress {
  public:
    explicit ConsoleProgress(const CommonOptions& common);
    ~ConsoleProgress() override;
    void begin(std::string_view stage, std::uint64_t total) override;
    void advance(std::uint64_t steps) override;
    bool stop_requested() const override;

  private:
    struct State;
    State* state_;
};

/// Parses and runs the words of a command line (without the program's name) and returns the exit code; errors of the
/// input are thrown.
int run_arguments(std::vector<std::string> arguments);

// One file a verb.
void add_town(CLI::App& app, Program& program);
void add_check(CLI::App& app, Program& program);
void add_bake(CLI::App& app, Program& program);
void add_probe(CLI::App& app, Program& program);
void add_compare(CLI::App& app, Program& program);
void add_view(CLI::App& app, Program& program);
void add_render(CLI::App& app, Program& program);
void add_export(CLI::App& app, Program& program);
void add_sun(CLI::App& app, Program& program);
void add_sky(CLI::App& app, Program& program);
void add_demo(CLI::App& app, Program& program);
void add_study(CLI::App& app, Program& program);

}  // namespace skybake::cli
