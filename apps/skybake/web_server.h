// A static web server on the loopback interface, for the walkthrough of a bake.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace skybake::cli {

/// Where the search for a free port begins, and how many are tried.
inline constexpr int kFirstPort = 8080;
inline constexpr int kPortsTried = 100;

/// The file that a decoded URL path names below `root`: a folder means its index.html. None when there is no such file,
/// or when the path leads out of `root`, be it by "..", by an absolute path or by a symbolic link.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& root, const std::string& url_path);

/// By the file name's ending; application/octet-stream for what is not known.
std::string mime_type(const std::filesystem::path& file);

/// Serves the files of the first root that has them, to this computer only: it listens on 127.0.0.1 and refuses
/// requests that were made in another host's name (a foreign page cannot read a bake by rebinding its own name to
/// 127.0.0.1). Ranges are answered, text and
/// geometry are gzipped for who asks, nothing can be written. bind() first, then run() in a thread of its own; stop()
/// may be called from any thread.
class WebServer {
  public:
    /// `mounts`: further folders by the first part of the path, with which they are asked for ("compare" answers
    /// /compare/…).
    explicit WebServer(std::vector<std::filesystem::path> roots,
                       std::map<std::string, std::filesystem::path> mounts = {});
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    /// Takes the port, or the first free one from kFirstPort on when none is asked for. Returns it. Throws InputError
    /// when it is taken.
    int bind(std::optional<int> port);
    /// Answers until stop(); false when listening failed.
    bool run();
    void stop();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace skybake::cli
