// Runs the program as a user does.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace skybake {

inline std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

/// A folder that is removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "skybake-test-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::string str(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

/// The program with its streams in files `out` and `err` of a folder; killed when it still runs at the end.
class Running {
  public:
    Running(const TemporaryFolder& folder, std::vector<std::string> arguments)
        : out_(folder / "stdout"), err_(folder / "stderr") {
        arguments.insert(arguments.begin(), SKYBAKE_PROGRAM);
        child_ = fork();
        if (child_ != 0) return;
        std::vector<char*> pointers;
        for (std::string& argument : arguments) pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        dup2(open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        dup2(open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        execv(pointers[0], pointers.data());
        _exit(127);
    }
    ~Running() {
        if (is_running()) end(SIGKILL);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    bool is_running() {
        if (child_ > 0 && waitpid(child_, &status_, WNOHANG) == child_) child_ = -1;
        return child_ > 0;
    }
    void end(int signal) {
        if (child_ <= 0) return;
        kill(child_, signal);
        waitpid(child_, &status_, 0);
        child_ = -1;
    }
    /// Waits at most so long; then the exit code, −signal when it died of one, or −1000 when it hung and was killed.
    int exit_code(std::chrono::seconds limit = std::chrono::seconds(120)) {
        const auto deadline = std::chrono::steady_clock::now() + limit;
        while (is_running()) {
            if (std::chrono::steady_clock::now() > deadline) {
                end(SIGKILL);
                return -1000;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    }
    std::string out() const { return text_of(out_); }
    std::string err() const { return text_of(err_); }

  private:
    std::filesystem::path out_, err_;
    pid_t child_ = -1;
    int status_ = 0;
};

}  // namespace skybake
