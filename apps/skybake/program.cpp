#include "program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>

namespace skybake::cli {

CLI::App* add_verb(CLI::App& app, Program& program, const std::string& name, const std::string& description,
                   const std::string& examples, std::function<int()> run) {
    CLI::App* verb = app.add_subcommand(name, description);
    verb->footer("Examples:\n" + examples);
    CommonOptions& common = program.common;
    verb->add_option("--threads", common.threads, "threads to use; 0 means all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    verb->add_option("--seed", common.seed, "seed of all random numbers")->capture_default_str();
    verb->add_flag("--quiet", common.is_quiet, "no progress and no remarks on stderr");
    verb->add_flag("--json", common.wants_json, "one JSON object with the run's figures on stdout");
    verb->add_flag("--strict", common.is_strict, "exit with 1 when a finding is an error");
    verb->callback([&program, run = std::move(run)] { program.run = run; });
    return verb;
}

void say(const CommonOptions& common, const std::string& line) {
    if (!common.is_quiet) fmt::print(stderr, "{}\n", line);
}

int report_findings(const CommonOptions& common, const FindingLog& findings) {
    for (const Finding& finding : findings.list()) {
        if (finding.severity == Severity::info && common.is_quiet) continue;
        fmt::print(stderr, "{}\n", to_text(finding));
    }
    return common.is_strict && findings.count(Severity::error) > 0 ? kDifference : kDone;
}

nlohmann::json to_json(const FindingLog& findings) {
    nlohmann::json list = nlohmann::json::array();
    for (const Finding& f : findings.list()) {
        list.push_back({{"code", f.code},
                        {"severity", name_of(f.severity)},
                        {"where", f.where},
                        {"what", f.what},
                        {"remedy", f.remedy},
                        {"count", f.count}});
    }
    return list;
}

void print_json(const nlohmann::json& object) {
    fmt::print("{}\n", object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

namespace {
std::atomic<bool> interrupted{false};
void on_interrupt(int) {
    if (interrupted.exchange(true)) std::_Exit(kInterrupted);  // a second Ctrl-C does not wait
}
}  // namespace

struct ConsoleProgress::State {
    bool is_quiet = false;
    bool is_terminal = false;
    std::mutex mutex;
    std::string stage;
    std::uint64_t total = 0;
    std::atomic<std::uint64_t> done{0};
    std::atomic<std::int64_t> next_print_ms{0};
    std::chrono::steady_clock::time_point begun;

    std::int64_t elapsed_ms() const {
        return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begun).count();
    }
    void finish_line() {
        if (!is_quiet && is_terminal && !stage.empty()) fmt::print(stderr, "\r\033[K");
    }
};

ConsoleProgress::ConsoleProgress(const CommonOptions& common) : state_(new State) {
    state_->is_quiet = common.is_quiet;
    state_->is_terminal = isatty(STDERR_FILENO) != 0;
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

ConsoleProgress::~ConsoleProgress() {
    state_->finish_line();
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    delete state_;
}

void ConsoleProgress::begin(std::string_view stage, std::uint64_t total) {
    const std::lock_guard lock(state_->mutex);
    state_->finish_line();
    state_->stage = stage;
    state_->total = total;
    state_->done = 0;
    state_->begun = std::chrono::steady_clock::now();
    state_->next_print_ms = state_->is_terminal ? 100 : 10'000;
}

void ConsoleProgress::advance(std::uint64_t steps) {
    const std::uint64_t done = state_->done.fetch_add(steps) + steps;
    if (state_->is_quiet || state_->total == 0) return;
    const std::int64_t now = state_->elapsed_ms();
    if (now < state_->next_print_ms) return;
    const std::unique_lock lock(state_->mutex, std::try_to_lock);
    if (!lock) return;
    state_->next_print_ms = now + (state_->is_terminal ? 100 : 10'000);
    const double share = static_cast<double>(done) / static_cast<double>(state_->total);
    const double seconds = static_cast<double>(now) / 1000.0;
    const double remaining = share > 0 ? seconds * (1.0 - share) / share : 0.0;
    fmt::print(stderr, "{}{}: {:.0f} % ({:.0f} s, about {:.0f} s more){}", state_->is_terminal ? "\r\033[K" : "",
               state_->stage, 100.0 * share, seconds, remaining, state_->is_terminal ? "" : "\n");
    std::fflush(stderr);
}

bool ConsoleProgress::stop_requested() const {
    return interrupted;
}

}  // namespace skybake::cli
