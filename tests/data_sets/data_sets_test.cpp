// Every file of every data set is read, or refused for a stated reason: the table of docs/validation.md.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>

#include "api/load_city.h"
#include "test_data.h"

namespace skybake {
namespace {

/// The figures of one data set, read in a process of its own so that the peak memory is its own.
std::string row_of(const std::string& name, const std::vector<std::filesystem::path>& files) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        SilentProgress progress;
        std::string row;
        try {
            const LoadedCity loaded = load_city(files, {}, progress);
            const auto missing = std::count_if(loaded.city.textures.begin(), loaded.city.textures.end(),
                                               [](const Texture& t) { return t.is_missing; });
            std::string codes;
            std::map<std::string, std::uint64_t> by_code;
            for (const Finding& finding : loaded.findings.list()) by_code[finding.code] += finding.count;
            for (const auto& [code, count] : by_code)
                codes += fmt::format("{}{} {}", codes.empty() ? "" : ", ", code, count);
            rusage usage{};
            getrusage(RUSAGE_SELF, &usage);
            row = fmt::format("| {} | {} | {} | {} | {} + {} | {} | {:.2f} | {} |", name, loaded.city.objects.size(),
                              loaded.summary.surfaces, loaded.summary.triangles,
                              static_cast<long>(loaded.city.textures.size()) - missing, missing, codes,
                              loaded.read_seconds, usage.ru_maxrss / 1024);
        } catch (const std::exception& error) {
            std::string reason = error.what();
            if (reason.find(files.front().filename().string()) == std::string::npos) _exit(2);
            reason = reason.substr(std::min(reason.find(": ") + 2, reason.size()));
            row = fmt::format("| {} | refused: {} | | | | | | |", name, reason.substr(0, reason.find('\n')));
        }
        const auto written = write(pipe_ends[1], row.data(), row.size());
        _exit(written == static_cast<ssize_t>(row.size()) ? 0 : 1);
    }
    close(pipe_ends[1]);
    std::string row;
    char buffer[4096];
    for (ssize_t count; (count = read(pipe_ends[0], buffer, sizeof buffer)) > 0;)
        row.append(buffer, static_cast<std::size_t>(count));
    close(pipe_ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << name;
    return row;
}

/// Beside the city files: pictures, texts, and what a city file names itself.
bool is_beside(const std::filesystem::path& path) {
    static const std::set<std::string> kBeside{".png", ".jpg", ".jpeg", ".JPG", ".md", ".mtl"};
    return kBeside.count(path.extension().string()) > 0;
}

TEST(DataSets, AreReadOrRefusedForAStatedReason) {
    const auto data = test_data("data");
    SKYBAKE_NEEDS_DATA(data);
    std::map<std::string, std::vector<std::filesystem::path>> sets;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
        if (!entry.is_regular_file() || is_beside(entry.path())) continue;
        std::string name = entry.path().lexically_relative(data).string();
        if (name.starts_with("ingolstadt")) name = "ingolstadt-lod3-citygml (18 files)";  // one street in pieces
        sets[name].push_back(entry.path());
    }
    EXPECT_GT(sets.size(), 60u);
    std::string table =
        "\n| data set | objects | surfaces | triangles | images found + missing | findings | seconds | peak MB |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (auto& [name, files] : sets) {
        std::sort(files.begin(), files.end());
        table += row_of(name, files) + "\n";
    }
    fmt::print("{}", table);
}

}  // namespace
}  // namespace skybake
