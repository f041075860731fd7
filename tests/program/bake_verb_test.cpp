// `skybake bake` as a user runs it: the same bytes whoever runs it, and nothing that looks whole when it is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "run_program.h"

namespace skybake {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class BakeVerb : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(run({"town", "-o", place_.str("a/town.city.json"), "--buildings", "40", "--quiet"}), 0);
    }
    int run(std::vector<std::string> arguments) { return Running(place_, std::move(arguments)).exit_code(); }
    std::vector<std::string> bake(const std::string& city, const std::string& folder, const std::string& texel = "1",
                                  const std::string& threads = "0") {
        return {"bake",      place_.str(city),
                "-o",        place_.str(folder),
                "--texel",   texel,
                "--at",      "2026-06-21T12:00+02:00",
                "--threads", threads,
                "--quiet"};
    }
    std::map<std::string, std::string> bytes_of(const std::string& folder) {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(place_ / folder)) {
            if (entry.is_regular_file())
                files[fs::relative(entry.path(), place_ / folder).string()] = text_of(entry.path());
        }
        return files;
    }
    static void expect_equal(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
        ASSERT_EQ(a.size(), b.size());
        for (const auto& [name, bytes] : a) {
            ASSERT_TRUE(b.contains(name)) << name;
            EXPECT_TRUE(bytes == b.at(name)) << name << " differs";
        }
    }

    TemporaryFolder place_;
};

TEST_F(BakeVerb, WritesTheSameBytesForAnyNumberOfThreads) {
    ASSERT_EQ(run(bake("a/town.city.json", "one", "1", "1")), 0);
    const auto one = bytes_of("one");
    EXPECT_GT(one.size(), 5u);
    for (const char* threads : {"2", "7"}) {
        ASSERT_EQ(run(bake("a/town.city.json", threads, "1", threads)), 0);
        expect_equal(one, bytes_of(threads));
    }
}

/// Photons too: the files have the reflected light, and the same bytes for any number of threads.
TEST_F(BakeVerb, WritesTheSamePhotonsForAnyNumberOfThreads) {
    const auto with_photons = [&](const std::string& folder, const std::string& threads) {
        std::vector<std::string> arguments = bake("a/town.city.json", folder, "2", threads);
        arguments.insert(arguments.end(),
                         {"--indirect", "photons", "--photons", "60000", "--seed", "3", "--report-leaks"});
        return run(arguments);
    };
    ASSERT_EQ(with_photons("one", "1"), 0);
    const auto one = bytes_of("one");
    ASSERT_TRUE(one.contains("light/i0_p0_indirect.png"));
    const auto manifest = nlohmann::json::parse(one.at("manifest.json"));
    const auto& lumen = manifest.at("report").at("photon_lumen");
    EXPECT_NEAR(
        lumen.at("absorbed").get<double>() + lumen.at("escaped").get<double>() + lumen.at("at_limit").get<double>(),
        lumen.at("emitted").get<double>(), 1e-6 * lumen.at("emitted").get<double>());
    EXPECT_EQ(manifest.at("settings").at("photons"), "60000");
    ASSERT_TRUE(one.contains("light/i0_p0_leaks.png"));
    EXPECT_GE(manifest.at("report").at("leaks").at("area_m2").get<double>(), 0.0);
    for (const char* threads : {"2", "7"}) {
        ASSERT_EQ(with_photons(threads, threads), 0);
        expect_equal(one, bytes_of(threads));
    }
}

/// A night with the town's lamps and their reflections: light in its own pages, and the same bytes.
TEST_F(BakeVerb, WritesTheSameLampsForAnyNumberOfThreads) {
    const auto night = [&](const std::string& folder, const std::string& threads) {
        return run({"bake", place_.str("a/town.city.json"), "-o", place_.str(folder), "--texel", "2", "--at",
                    "2026-06-21T23:30+02:00", "--sky", "none", "--lamps", place_.str("a/town.lamps.json"), "--indirect",
                    "photons", "--photons", "60000", "--threads", threads, "--quiet"});
    };
    ASSERT_EQ(night("one", "1"), 0);
    const auto one = bytes_of("one");
    ASSERT_TRUE(one.contains("light/p0_lamps.png"));
    const auto manifest = nlohmann::json::parse(one.at("manifest.json"));
    EXPECT_EQ(manifest.at("lamp_scales").at("uri"), "light/lamp_scales.bin");
    EXPECT_EQ(manifest.at("pages")[0].at("lamps"), "light/p0_lamps.png");
    EXPECT_GT(manifest.at("report").at("lamps"), 5);
    EXPECT_GT(manifest.at("report").at("rays").at("lamp"), 1000);
    EXPECT_GT(manifest.at("report").at("photon_lumen").at("emitted"), 5000.0);
    EXPECT_EQ(manifest.at("inputs").size(), 2u);
    // The night is lit: the mean is more than a thousandth of a lux, and far from a day's.
    const double hint = manifest.at("instants")[0].at("exposure_hint");
    EXPECT_GT(hint, 0.5 / (100.0 / 1000.0 / 3.14159));
    EXPECT_LT(hint, 0.5 / (0.1 / 1000.0 / 3.14159));
    for (const char* threads : {"2", "7"}) {
        ASSERT_EQ(night(threads, threads), 0);
        expect_equal(one, bytes_of(threads));
    }
}

/// Paths likewise; their settings and their standard error stand in the manifest.
TEST_F(BakeVerb, WritesTheSamePathsForAnyNumberOfThreads) {
    const auto with_paths = [&](const std::string& folder, const std::string& threads) {
        std::vector<std::string> arguments = bake("a/town.city.json", folder, "4", threads);
        arguments.insert(arguments.end(), {"--indirect", "reference", "--paths", "8", "--bounces", "3"});
        return run(arguments);
    };
    ASSERT_EQ(with_paths("one", "1"), 0);
    const auto one = bytes_of("one");
    const auto manifest = nlohmann::json::parse(one.at("manifest.json"));
    EXPECT_EQ(manifest.at("settings").at("paths"), "8");
    EXPECT_FALSE(manifest.at("settings").contains("photons"));
    EXPECT_GT(manifest.at("report").at("indirect_lx").at("mean").get<double>(), 0.0);
    EXPECT_GT(manifest.at("report").at("indirect_lx").at("standard_error").get<double>(), 0.0);
    ASSERT_EQ(with_paths("seven", "7"), 0);
    expect_equal(one, bytes_of("seven"));
}

TEST_F(BakeVerb, WritesTheSameBytesForShuffledObjects) {
    using Json = nlohmann::ordered_json;
    Json city = Json::parse(text_of(place_ / "a/town.city.json"));
    std::vector<std::pair<std::string, Json>> objects;
    for (auto& [id, object] : city["CityObjects"].items()) objects.emplace_back(id, object);
    std::shuffle(objects.begin(), objects.end(), std::mt19937(3));
    city["CityObjects"] = Json::object();
    for (auto& [id, object] : objects) city["CityObjects"][id] = std::move(object);
    fs::create_directories(place_ / "b");
    std::ofstream(place_ / "b/town.city.json") << city;
    fs::copy(place_ / "a/textures", place_ / "b/textures", fs::copy_options::recursive);

    ASSERT_EQ(run(bake("a/town.city.json", "in-order")), 0);
    ASSERT_EQ(run(bake("b/town.city.json", "shuffled")), 0);
    auto a = bytes_of("in-order"), b = bytes_of("shuffled");
    // Only the manifest may differ, and only in what it says of the input file.
    Json manifest_a = Json::parse(a.at("manifest.json")), manifest_b = Json::parse(b.at("manifest.json"));
    a.erase("manifest.json");
    b.erase("manifest.json");
    expect_equal(a, b);
    EXPECT_NE(manifest_a.at("inputs"), manifest_b.at("inputs"));
    manifest_a.erase("inputs");
    manifest_b.erase("inputs");
    EXPECT_EQ(manifest_a, manifest_b);
}

/// Kills a bake as soon as it touches its folder, before the manifest stands there.
TEST_F(BakeVerb, KilledWhileWritingLeavesNothingThatLooksWhole) {
    ASSERT_EQ(run(bake("a/town.city.json", "lit", "2")), 0);
    {
        Running second(place_, bake("a/town.city.json", "lit"));
        while (second.is_running() && fs::exists(place_ / "lit/manifest.json"))
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        second.end(SIGKILL);
    }
    ASSERT_FALSE(fs::exists(place_ / "lit/manifest.json"));
    for (const std::string verb : {"view", "compare"}) {
        std::vector<std::string> arguments{verb, place_.str("lit")};
        if (verb == "compare") arguments.push_back(place_.str("lit"));
        Running reader(place_, arguments);
        EXPECT_EQ(reader.exit_code(), 2);
        EXPECT_THAT(reader.err(), HasSubstr("manifest.json"));
    }
    ASSERT_EQ(run(bake("a/town.city.json", "lit")), 0);
    ASSERT_EQ(run(bake("a/town.city.json", "fresh")), 0);
    expect_equal(bytes_of("fresh"), bytes_of("lit"));
}

TEST_F(BakeVerb, KilledWhileTracingLeavesTheOlderBakeAsItWas) {
    ASSERT_EQ(run(bake("a/town.city.json", "lit", "2")), 0);
    const auto before = bytes_of("lit");
    for (const int signal : {SIGKILL, SIGTERM}) {
        Running second(place_, bake("a/town.city.json", "lit", "0.25"));
        std::this_thread::sleep_for(std::chrono::milliseconds(700));
        ASSERT_TRUE(second.is_running());
        second.end(signal);
        expect_equal(before, bytes_of("lit"));
    }
}

TEST_F(BakeVerb, WrongUseEndsWithTwoAndSaysWhy) {
    const auto expect_error = [&](std::vector<std::string> arguments, const std::string& word) {
        Running program(place_, std::move(arguments));
        EXPECT_EQ(program.exit_code(), 2);
        EXPECT_THAT(program.err(), HasSubstr(word));
    };
    expect_error({"bak"}, "'bake'");
    expect_error({"bake", place_.str("a/town.city.json"), "--texle", "1"}, "'--texel'");
    expect_error({"bake", place_.str("none.city.json"), "-o", place_.str("x"), "--at", "2026-06-21T12:00Z"},
                 "none.city.json");
    expect_error({"bake", place_.str("a/town.city.json"), "-o", place_.str("x")}, "--at");
    expect_error({"bake", place_.str("a/town.city.json"), "-o", place_.str("x"), "--at", "noon"}, "noon");
    // Before the work: even the missing city is not looked for.
    expect_error({"bake", place_.str("none.city.json"), "-o", "/dev/null/x", "--at", "2026-06-21T12:00Z"},
                 "/dev/null/x");
    EXPECT_FALSE(fs::exists(place_ / "x"));
}

}  // namespace
}  // namespace skybake
