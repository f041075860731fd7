// check --repair: what is written reads as the repaired city, without its faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_program.h"
#include "test_data.h"

namespace skybake {
namespace {

using nlohmann::json;

json check(const TemporaryFolder& place, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "check");
    arguments.push_back("--json");
    Running program(place, arguments);
    EXPECT_EQ(program.exit_code(), 0) << program.err();
    return json::parse(program.out());
}
std::uint64_t count_of(const json& report, const std::string& code) {
    std::uint64_t count = 0;
    for (const json& finding : report.at("findings")) {
        if (finding.at("code") == code) count += finding.at("count").get<std::uint64_t>();
    }
    return count;
}

TEST(RepairVerb, TheRepairedCityIsReadWithoutTheFaults) {
    const std::vector<std::string> cities = {"data/graz-inffeld-citygml/campus_inffeld.gml",
                                             "data/berlin-citygml10/berlin_open_data_sample_data.citygml",
                                             "data/lyon-textured-house-citygml/LYON_1ER_BATI_2015_small_house.gml",
                                             "data/dunedin-photogrammetry-3dtiles/lod1_0.derived.glb"};
    for (const std::string& city : cities) {
        if (!std::filesystem::exists(test_data(city))) continue;
        SCOPED_TRACE(city);
        const TemporaryFolder place;
        const json before = check(place, {test_data(city).string(), "--repair", "-o", place.str("r.city.json")});
        const json after = check(place, {place.str("r.city.json")});
        EXPECT_EQ(after.at("surfaces"), before.at("surfaces"));
        EXPECT_EQ(after.at("surfaces_by_type"), before.at("surfaces_by_type"));
        EXPECT_EQ(after.at("textures_found"), before.at("textures_found"));
        EXPECT_EQ(after.at("textures_missing"), 0);
        EXPECT_EQ(after.at("textured_surfaces"), before.at("textured_surfaces"));
        for (const char* code : {"SB101", "SB202", "SB207", "SB208", "SB210"})
            EXPECT_EQ(count_of(after, code), 0u) << code;
        for (std::size_t axis = 0; axis < 6; ++axis) {
            if (before.at("extent").is_null()) continue;
            EXPECT_NEAR(after.at("extent")[axis].get<double>(), before.at("extent")[axis].get<double>(), 0.001);
        }
    }
}

TEST(RepairVerb, DegreesComeOutInUtm) {
    const auto tokyo = test_data("data/tokyo-west-plateau-lod1-citygml");
    SKYBAKE_NEEDS_DATA(tokyo);
    std::string file;
    for (const auto& entry : std::filesystem::directory_iterator(tokyo)) {
        if (entry.path().extension() == ".gml") file = entry.path().string();
    }
    const TemporaryFolder place;
    const json before = check(place, {file, "--repair", "-o", place.str("r.city.json")});
    const json after = check(place, {place.str("r.city.json")});
    EXPECT_THAT(after.at("crs").get<std::string>(), testing::HasSubstr("EPSG:32654"));
    // The site is the middle of the city's box, which is turned by UTM's convergence of 0.85° here: half the diagonal
    // of 697 m by its sine is 5.2 m, 6e-5 degrees.
    for (const char* angle : {"latitude_deg", "longitude_deg"})
        EXPECT_NEAR(after.at("site").at(angle).get<double>(), before.at("site").at(angle).get<double>(), 6e-5);
    EXPECT_EQ(after.at("surfaces"), before.at("surfaces"));
}

TEST(RepairVerb, BelongsToAnOutput) {
    const TemporaryFolder place;
    Running program(place, {"check", "a.city.json", "--repair"});
    EXPECT_EQ(program.exit_code(), 2);
    EXPECT_THAT(program.err(), testing::HasSubstr("--repair and -o FILE belong together"));
}

}  // namespace
}  // namespace skybake
