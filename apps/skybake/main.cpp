// The command line of skybake: parses, runs the chosen verb, and turns errors into messages and exit codes. No physics
// here.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/nearest_word.h"
#include "memory_limit.h"
#include "program.h"

namespace {

using namespace skybake::cli;

/// The known flag or verb that is nearest to what the user typed.
std::string nearest_known(const CLI::App& app, const std::string& typed) {
    std::vector<std::string> known;
    for (const CLI::App* verb : app.get_subcommands({})) known.push_back(verb->get_name());
    for (const CLI::App* verb : app.get_subcommands()) {
        known.clear();
        for (const CLI::Option* option : verb->get_options()) {
            for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
        }
    }
    return skybake::nearest_word(typed, known);
}

}  // namespace

namespace skybake::cli {

int run_arguments(std::vector<std::string> arguments) {
    CLI::App app("skybake lights whole cities with real daylight.", "skybake");
    app.set_version_flag("--version", std::string("skybake ") + SKYBAKE_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    Program program;
    add_demo(app, program);
    add_town(app, program);
    add_check(app, program);
    add_bake(app, program);
    add_probe(app, program);
    add_compare(app, program);
    add_view(app, program);
    add_render(app, program);
    add_export(app, program);
    add_sun(app, program);
    add_sky(app, program);
    add_study(app, program);

    try {
        std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
        app.parse(std::move(arguments));
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        // A mistyped word explains more than what is missed because of it.
        const std::vector<std::string> extras = app.remaining(true);
        if (extras.empty()) {
            fmt::print(stderr, "skybake: {}\n", error.what());
            return kWrongUse;
        }
        const std::string typed = extras.front().substr(0, extras.front().find('='));
        const bool is_flag = typed.rfind("-", 0) == 0;
        fmt::print(stderr, "skybake: unknown {} '{}'; did you mean '{}'? See skybake {}--help.\n",
                   is_flag ? "flag" : "word", typed, nearest_known(app, typed),
                   app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " ");
        return kWrongUse;
    }
    return program.run();
}

}  // namespace skybake::cli

int main(int argc, char** argv) {
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is no error: `skybake … | head`
    skybake::cli::limit_memory();
    try {
        return skybake::cli::run_arguments({argv + 1, argv + argc});
    } catch (const skybake::InputError& error) {
        fmt::print(stderr, "skybake: {}\n", error.what());
        return kWrongUse;
    } catch (const skybake::Interrupted&) {
        fmt::print(stderr, "skybake: interrupted; nothing was left half written.\n");
        return kInterrupted;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "skybake: out of memory. Use a coarser --texel, or a part of the city.\n");
        return kWrongUse;
    } catch (const std::exception& error) {
        fmt::print(stderr,
                   "skybake: internal error: {}\nThis is a bug of skybake; please report it with the command line.\n",
                   error.what());
        return kOurBug;
    }
}
