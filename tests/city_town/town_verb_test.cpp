// `skybake town` as a user runs it: exit codes, --json, and the files that it leaves.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace {

struct Result {
    int code = -1;
    std::string out;
};

Result run(const std::string& arguments) {
    Result result;
    FILE* pipe = popen((std::string(SKYBAKE_PROGRAM) + " " + arguments + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return result;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) result.out.append(buffer.data(), n);
    const int status = pclose(pipe);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

TEST(TownVerb, WritesTheTownAndItsPicturesAndTellsFigures) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("skybake_town_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string file = (folder / "t.city.json").string();
    const Result result = run("town -o " + file + " --buildings 30 --seed 4 --variant with-tower --json --quiet");
    EXPECT_EQ(result.code, 0);
    const auto figures = nlohmann::json::parse(result.out, nullptr, false);
    ASSERT_FALSE(figures.is_discarded()) << result.out;
    EXPECT_EQ(figures.at("buildings"), 31);  // and the planned tower
    EXPECT_EQ(figures.at("bytes"), std::filesystem::file_size(file));
    EXPECT_TRUE(std::filesystem::exists(folder / "textures" / "facade_ochre.png"));
    EXPECT_TRUE(std::filesystem::exists(folder / "t.lamps.json"));
    EXPECT_GT(figures.at("lamp_count"), 5);
    std::filesystem::remove_all(folder);
}

TEST(TownVerb, WrongUseEndsWithTwo) {
    EXPECT_EQ(run("town").code, 2);
    EXPECT_EQ(run("town -o /tmp/never.json --buildings 9").code, 2);
    EXPECT_EQ(run("town -o /tmp/never.json --buildings 100001").code, 2);
    EXPECT_EQ(run("town -o /tmp/never.json --variant castle").code, 2);
    EXPECT_EQ(run("town -o /dev/null/never.json").code, 2);
}

}  // namespace
