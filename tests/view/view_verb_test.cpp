// `skybake view` as a program: what it prints, how it ends.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ViewVerb : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "skybake-view-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        if (child_ > 0) {
            kill(child_, SIGKILL);
            waitpid(child_, nullptr, 0);
        }
        fs::remove_all(folder_);
    }
    void make_bake() {
        std::ofstream(folder_ / "manifest.json") << R"({"format": "skybake-bake", "version": 1})";
        std::ofstream(folder_ / "index.html") << "page";
    }
    void start(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {SKYBAKE_PROGRAM, "view"});
        child_ = fork();
        ASSERT_GE(child_, 0);
        if (child_ != 0) return;
        std::vector<char*> pointers;
        for (std::string& argument : arguments) pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        dup2(open((folder_ / "stdout").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        dup2(open((folder_ / "stderr").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        execv(pointers[0], pointers.data());
        _exit(127);
    }
    int exit_code() {
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string printed(const char* name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name).rdbuf();
        return text.str();
    }
    /// Waits for the JSON line and returns the port in it.
    int port() const {
        for (int i = 0; i < 500; ++i) {
            const std::string line = printed("stdout");
            if (const auto at = line.find("\"port\":"); at != std::string::npos && line.back() == '\n')
                return std::atoi(line.c_str() + at + 7);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return 0;
    }

    fs::path folder_;
    pid_t child_ = -1;
};

class ViewVerbSignal : public ViewVerb, public testing::WithParamInterface<int> {};

TEST_P(ViewVerbSignal, ServesTheBakeUntilTheSignalAndEndsWithZero) {
    make_bake();
    start({folder_.string(), "--no-open", "--json"});
    const int served_port = port();
    ASSERT_GE(served_port, 8080);
    EXPECT_EQ(printed("stdout"), "{\"port\":" + std::to_string(served_port) +
                                     ",\"url\":\"http://127.0.0.1:" + std::to_string(served_port) + "/\"}\n");
    EXPECT_THAT(printed("stderr"), HasSubstr("http://127.0.0.1:" + std::to_string(served_port) + "/"));
    httplib::Client client("127.0.0.1", served_port);
    const auto page = client.Get("/");
    ASSERT_TRUE(page);
    EXPECT_EQ(page->body, "page");
    kill(child_, GetParam());
    EXPECT_EQ(exit_code(), 0);
}

INSTANTIATE_TEST_SUITE_P(CtrlCAndTerm, ViewVerbSignal, testing::Values(SIGINT, SIGTERM));

TEST_F(ViewVerb, ASecondBakeIsServedBesideTheFirst) {
    make_bake();
    const fs::path other = folder_ / "other";
    fs::create_directory(other);
    std::ofstream(other / "manifest.json") << R"({"format": "skybake-bake", "version": 1, "title": "after"})";
    start({folder_.string(), other.string(), "--no-open", "--json"});
    const int served_port = port();
    EXPECT_THAT(printed("stdout"), HasSubstr("/?compare=compare/&a="));
    EXPECT_THAT(printed("stdout"), HasSubstr("&b=other\""));
    httplib::Client client("127.0.0.1", served_port);
    const auto manifest = client.Get("/compare/manifest.json");
    ASSERT_TRUE(manifest);
    EXPECT_THAT(manifest->body, HasSubstr("after"));
    const auto outside = client.Get("/compare/../index.html");
    ASSERT_TRUE(outside);
    EXPECT_EQ(outside->status, 404);
    const auto missing = client.Get("/compare/index.html");  // the page is the first bake's
    ASSERT_TRUE(missing);
    EXPECT_EQ(missing->status, 404);
}

TEST_F(ViewVerb, ASecondFolderThatIsNoBakeIsTold) {
    make_bake();
    fs::create_directory(folder_ / "other");
    start({folder_.string(), (folder_ / "other").string(), "--no-open"});
    EXPECT_EQ(exit_code(), 2);
    EXPECT_THAT(printed("stderr"), HasSubstr("other: this folder is no bake"));
}

TEST_F(ViewVerb, AFolderWithoutManifestIsNoBake) {
    start({folder_.string(), "--no-open"});
    EXPECT_EQ(exit_code(), 2);
    EXPECT_THAT(printed("stderr"), HasSubstr("no manifest.json"));
}

TEST_F(ViewVerb, AForeignManifestIsNoBake) {
    std::ofstream(folder_ / "manifest.json") << R"({"name": "a web app"})";
    start({folder_.string(), "--no-open"});
    EXPECT_EQ(exit_code(), 2);
    EXPECT_THAT(printed("stderr"), HasSubstr("not the manifest of a bake"));
}

TEST_F(ViewVerb, AMissingFolderIsTold) {
    start({(folder_ / "none").string(), "--no-open"});
    EXPECT_EQ(exit_code(), 2);
    EXPECT_THAT(printed("stderr"), HasSubstr("no such folder"));
}

}  // namespace
