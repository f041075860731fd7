// Lamp files: JSON of ours with profiles, and glTF with punctual lights.
#include "io/lamps/read_lamps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "error_of.h"
#include "io/lamps/write_town_lamps.h"
#include "scratch_folder.h"

namespace skybake::io {
namespace {

using testing::HasSubstr;

class LampFiles : public testing::Test {
  protected:
    LampFile read(const std::string& text, const Vec3d& origin = Vec3d(0.0), std::optional<Vec3d> at = std::nullopt) {
        std::ofstream(folder_ / "lamps", std::ios::binary) << text;
        return read_lamps(folder_ / "lamps", origin, at, findings_);
    }
    std::string error_of(const std::string& text) {
        return skybake::error_of([&] { read(text); });
    }
    ScratchFolder folder_{"lamps"};
    FindingLog findings_;
};

void expect_near(const Vec3f& a, const Vec3f& b) {
    EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z;
}

/// y up becomes z up; a light shines along its node's -z.
const char* const kGltf = R"({
  "asset": {"version": "2.0"}, "scene": 0,
  "scenes": [{"nodes": [0, 3], "extras": {"origin": [1000, 2000, 10]}}],
  "nodes": [
    {"name": "mast", "translation": [3, 4, -5], "children": [1, 2]},
    {"name": "head", "translation": [0, 2, 0], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
     "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"name": "bulb", "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,1,1,1], "extensions": {"KHR_lights_punctual": {"light": 1}}},
    {"name": "sun", "extensions": {"KHR_lights_punctual": {"light": 2}}}],
  "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "spot", "intensity": 700, "color": [1, 0.5, 0.25], "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}},
    {"type": "point", "intensity": 30},
    {"type": "directional", "intensity": 5}]}}})";

TEST_F(LampFiles, GltfLightsStandWhereTheirNodesAre) {
    const std::vector<Lamp> lamps = read(kGltf, {1000, 2000, 0}).lamps;
    ASSERT_EQ(lamps.size(), 2u);
    EXPECT_EQ(lamps[0].type, Lamp::Type::spot);
    expect_near(lamps[0].position, {3, 5, 6 + 10});
    expect_near(lamps[0].axis, {0, 0, -1});  // turned by -90° about x: -z looks down
    expect_near(lamps[0].intensity, {700, 350, 175});
    EXPECT_NEAR(lamps[0].cone_half_angle_rad, 0.5f, 1e-6f);
    EXPECT_NEAR(lamps[0].blend_rad, 0.3f, 1e-6f);
    EXPECT_EQ(lamps[1].type, Lamp::Type::point);
    expect_near(lamps[1].position, {4, 4, 5 + 10});
    expect_near(lamps[1].intensity, Rgb(30));
    ASSERT_EQ(findings_.count("SB801"), 1u);
    EXPECT_THAT(to_text(findings_.list()[0]), HasSubstr("node 3 ('sun'): a directional light"));
    expect_near(read(kGltf, Vec3d(0.0), Vec3d(7, 8, 9)).lamps[1].position, {11, 12, 14});
}

TEST_F(LampFiles, BinaryGltfIsTheSame) {
    const auto word = [](std::size_t value) {
        std::string bytes;
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
        return bytes;
    };
    const std::string json(kGltf);
    const std::string glb = "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
    EXPECT_EQ(read(glb).lamps.size(), 2u);
    for (std::size_t end = 4; end < glb.size(); ++end) EXPECT_NE(error_of(glb.substr(0, end)), "no error") << end;
}

TEST_F(LampFiles, FaultyGltfIsRefused) {
    const auto changed = [](const std::string& from, const std::string& to) {
        std::string text(kGltf);
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    EXPECT_THAT(error_of(changed("\"light\": 1", "\"light\": 9")), HasSubstr("names the light 9, and has 3"));
    EXPECT_THAT(error_of(changed("[1, 2]", "[1, 7]")), HasSubstr("names the node 7, and has 4"));
    EXPECT_THAT(error_of(changed("[1, 2]", "[1, 0]")), HasSubstr("node 0 has two parents"));
    EXPECT_THAT(error_of(changed("\"intensity\": 30", "\"intensity\": -30")), HasSubstr("intensity of -30"));
    EXPECT_THAT(error_of(changed("\"outerConeAngle\": 0.5", "\"outerConeAngle\": 5")), HasSubstr("outerConeAngle"));
    EXPECT_THAT(error_of(changed("[3, 4, -5]", "[3, 4]")), HasSubstr("the translation of node 0 is not 3 numbers"));
    EXPECT_THAT(error_of(changed("\"point\"", "\"area\"")), HasSubstr("light 1 has the type \"area\""));
    EXPECT_THAT(error_of(R"({"asset": {}, "scenes": [{}], "nodes": []})"), HasSubstr("has no lights"));
}

TEST_F(LampFiles, ProfilesAreNamedBesideTheirFile) {
    std::ofstream(folder_ / "even.ies") << "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0 1 1 1\n0 90 0\n50 50\n";
    const LampFile file = read(R"({"lamps": [
      {"id": "a", "type": "profile", "profile": "even.ies", "position": [1, 2, 3]},
      {"id": "b", "type": "profile", "profile": "even.ies", "position": [1, 2, 3], "flux_lm": 628.3185307,
       "direction": [1, 0, 0], "c0_direction": [1, 1, 0]}]})");
    ASSERT_EQ(file.lamps.size(), 2u);
    EXPECT_EQ(file.files.size(), 2u);
    EXPECT_EQ(file.lamps[0].profile, file.lamps[1].profile);
    EXPECT_NEAR(luminance(file.lamps[0].intensity), 50.0f, 1e-4f);
    EXPECT_NEAR(luminance(file.lamps[1].intensity), 100.0f, 1e-2f);  // 2π sr
    expect_near(file.lamps[1].c_zero, {0, 1, 0});
    EXPECT_THAT(error_of(R"({"lamps": [{"id": "a", "type": "profile", "profile": "no.ies", "position": [1, 2, 3]}]})"),
                HasSubstr("no.ies"));
    EXPECT_THAT(error_of(R"({"lamps": [{"id": "a", "type": "profile", "profile": "even.ies", "position": [1, 2, 3],
                             "c0_direction": [0, 0, 2]}]})"),
                HasSubstr("lamp 1: has a c0_direction along its direction"));
    EXPECT_THAT(error_of(R"({"lamps": [{"id": "a", "type": "point", "profile": "even.ies", "position": [1, 2, 3]}]})"),
                HasSubstr("has 'profile', which only a profile has"));
}

TEST_F(LampFiles, TownsLampsAreReadAsTheyWereWritten) {
    const std::vector<StreetLamp> street{{"x", {-67770.125, 214930.5, 353.0}, 1200.0, 2700.0}};
    write_town_lamps(folder_ / "t.lamps.json", street);
    const std::vector<Lamp> lamps =
        read_lamps(folder_ / "t.lamps.json", {-67770, 214930, 350}, std::nullopt, findings_).lamps;
    ASSERT_EQ(lamps.size(), 1u);
    expect_near(lamps[0].position, {-0.125f, 0.5f, 3});
    EXPECT_NEAR(effective_solid_angle(lamps[0]) * static_cast<double>(luminance(lamps[0].intensity)), 1200.0, 0.1);
    EXPECT_GT(lamps[0].intensity.x, 3.0f * lamps[0].intensity.z);  // warm
}

}  // namespace
}  // namespace skybake::io
