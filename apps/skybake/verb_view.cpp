// skybake view: serves a bake to the browser of this computer.
#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <thread>

#include "base/error.h"
#include "memory_limit.h"
#include "program.h"
#include "viewer_assets.h"
#include "web_server.h"

namespace skybake::cli {

namespace {

namespace fs = std::filesystem;

/// Where the walkthrough finds the bake that it compares with.
constexpr const char* kCompared = "compare";

struct ViewOptions {
    std::string folder;
    std::string compared;  // a second bake; empty: none
    int port = 0;          // 0: the first free one
    bool stays_closed = false;
};

/// Throws InputError unless the folder holds the manifest of a bake.
void check_bake(const fs::path& folder) {
    if (!fs::is_directory(folder)) throw InputError(fmt::format("{}: no such folder.", folder.string()));
    const fs::path path = folder / "manifest.json";
    std::ifstream stream(path);
    if (!stream)
        throw InputError(
            fmt::format("{}: this folder is no bake, it has no manifest.json. Make one with `skybake bake CITY -o {}`.",
                        folder.string(), folder.string()));
    const nlohmann::json manifest = nlohmann::json::parse(stream, nullptr, false);
    if (!manifest.is_object() || manifest.value("format", nlohmann::json()) != "skybake-bake")
        throw InputError(fmt::format("{}: not the manifest of a bake. Bake the city again.", path.string()));
}

/// How the user calls a folder: the walkthrough names bakes of one title by it.
std::string name_of(const fs::path& folder) {
    return fs::weakly_canonical(folder).filename().string();
}

/// For an address: RFC 3986, section 2.3 names what needs no escape.
std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
                              c == '.' || c == '_' || c == '~';
        out += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return out;
}

/// Asks the desktop to open the address; without a desktop nothing happens, the address is on the terminal.
void open_browser(const std::string& url) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&files, descriptor, "/dev/null", O_RDWR, 0);
    // A group of its own: Ctrl-C here must not close the browser. And none of our blocked signals.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    std::string program = "xdg-open";
    std::string address = url;
    char* arguments[] = {program.data(), address.data(), nullptr};
    pid_t child = 0;
    std::signal(SIGCHLD, SIG_IGN);  // nobody waits for it
    lift_memory_limit();
    posix_spawnp(&child, program.c_str(), &files, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
}

int run_view(const ViewOptions& options, const CommonOptions& common) {
    const fs::path folder = options.folder;
    check_bake(folder);
    std::map<std::string, fs::path> mounts;
    if (!options.compared.empty()) {
        check_bake(options.compared);
        mounts.emplace(kCompared, options.compared);
    }
    std::vector<fs::path> roots{folder};
    // A bake carries the walkthrough of its own version; a bare one is shown with the program's.
    if (!fs::exists(folder / "index.html")) roots.push_back(viewer_assets());

    // Signals are taken by sigwait below: the server's threads inherit the mask.
    sigset_t stops;
    sigemptyset(&stops);
    sigaddset(&stops, SIGINT);
    sigaddset(&stops, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &stops, nullptr);

    WebServer server(roots, mounts);
    const int port = server.bind(options.port == 0 ? std::nullopt : std::optional(options.port));
    std::string url = fmt::format("http://127.0.0.1:{}/", port);
    if (!mounts.empty())
        url += fmt::format("?compare={}/&a={}&b={}", kCompared, escaped(name_of(folder)),
                           escaped(name_of(options.compared)));
    bool is_served = false;
    const pthread_t self = pthread_self();
    std::thread serving([&] {
        is_served = server.run();
        pthread_kill(self, SIGTERM);  // wakes the wait below when listening failed; harmless after stop()
    });
    const std::string shown = mounts.empty() ? folder.string() : folder.string() + " beside " + options.compared;
    say(common, fmt::format("{} is shown at {} (to this computer only). Ctrl-C ends.", shown, url));
    if (common.wants_json) {
        fmt::print("{}\n", nlohmann::json{{"url", url}, {"port", port}}.dump());
        std::fflush(stdout);
    }
    if (!options.stays_closed) open_browser(url);

    int signal = 0;
    sigwait(&stops, &signal);
    server.stop();
    serving.join();
    if (!is_served) throw std::runtime_error("the web server stopped by itself");
    return kDone;
}

}  // namespace

void add_view(CLI::App& app, Program& program) {
    const auto options = std::make_shared<ViewOptions>();
    CLI::App* verb =
        add_verb(app, program, "view", "Shows a bake in the browser, served on 127.0.0.1",
                 "  skybake view demo\n  skybake view before after\n  skybake view graz --port 9000 --no-open",
                 [options, &program] { return run_view(*options, program.common); });
    verb->add_option("DIR", options->folder, "folder of a bake (with manifest.json)")->required();
    verb->add_option("COMPARED", options->compared, "a second bake, to compare with: swipe, A/B, difference");
    verb->add_option("--port", options->port,
                     fmt::format("port on 127.0.0.1; 0 takes the first free one from {} on", kFirstPort))
        ->capture_default_str()
        ->check(CLI::Range(0, 65535));
    verb->add_flag("--no-open", options->stays_closed, "only serve, do not open the browser");
}

}  // namespace skybake::cli
