// OBJ and MTL: lines of a few faces, and the real files. Truth: the format's specification, and DATA.md.
#include "io/obj/read_obj.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/hash_rng.h"
#include "cityjson/temporary_city.h"
#include "test_data.h"

namespace skybake {
namespace {

const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

LoadedCity load_obj(const std::string& text, const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return load(folder.write("a.obj", text), options);
}
std::size_t shown_of(const LoadedCity& loaded, ObjectType type) {
    return static_cast<std::size_t>(
        std::count_if(loaded.city.objects.begin(), loaded.city.objects.end(),
                      [&](const CityObject& o) { return o.type == type && !o.geometry.is_empty(); }));
}

TEST(ReadObj, ACubeGetsItsTypesBySlope) {
    const LoadedCity city = load_obj("# a cube\n" + kCube);
    ASSERT_EQ(city.city.objects.size(), 1u);
    const CityObject& object = city.city.objects[0];
    EXPECT_EQ(object.id, "a");
    EXPECT_EQ(object.type, ObjectType::generic);
    ASSERT_EQ(object.geometry.surfaces.size(), 6u);
    EXPECT_EQ(object.geometry.surfaces[0].type, SurfaceType::ground);
    EXPECT_EQ(object.geometry.surfaces[1].type, SurfaceType::roof);
    EXPECT_EQ(object.geometry.surfaces[2].type, SurfaceType::wall);
    EXPECT_EQ(city.findings.count("SB207"), 0u);
}

TEST(ReadObj, YUpOriginAndReferenceSystem) {
    LoadOptions options;
    options.placement = {io::UpAxis::y, {678000, 5403000, 370}};
    options.crs = "EPSG:32632";
    // One point at x = 1, y (up) = 2, z (south) = 3.
    const LoadedCity city = load_obj("v 0 0 0\nv 1 0 0\nv 1 2 3\nf 1 2 3\n", options);
    EXPECT_EQ(extent_of(city.city).lo, Vec3d(678000, 5402997, 370));
    EXPECT_EQ(extent_of(city.city).hi, Vec3d(678001, 5403000, 372));
    ASSERT_TRUE(city.georeference.site.has_value());
    EXPECT_EQ(city.georeference.crs_code, "EPSG:32632");
}

TEST(ReadObj, ObjectsMaterialsAndTextures) {
    const TemporaryFolder folder;
    folder.write("m/roof.png", "x");
    folder.write("a.mtl",
                 "newmtl Building\nKd 1 0 0\nd 0.5\nnewmtl Road\nKd 0 1 0\n"
                 "newmtl tiles\nmap_Kd -s 1 1 1 -clamp on m\\roof.png\nnewmtl out\nmap_Kd ../x.png\n");
    const LoadedCity city = load(folder.write(
        "a.obj", "mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\n" + kCube +
                     "o house\nusemtl Building\nf -8 -7 -3\nusemtl Road\nf 5 6 7\nusemtl BuildingWall\nf 1 2 5\n"
                     "o roof\nusemtl tiles\nf 5/1 6/2 7/3\nf 5/1 7/3/ 8//\n"));
    ASSERT_EQ(city.city.objects.size(), 4u);
    const auto& objects = city.city.objects;
    EXPECT_EQ(shown_of(city, ObjectType::building), 1u);
    EXPECT_EQ(shown_of(city, ObjectType::road), 1u);
    const auto house =
        std::find_if(objects.begin(), objects.end(), [](const CityObject& o) { return o.id == "house"; });
    ASSERT_NE(house, objects.end());
    EXPECT_EQ(house->geometry.surfaces.size(), 2u) << "BuildingWall belongs to the building";
    EXPECT_EQ(city.city.materials[house->geometry.surfaces[0].material->index()].albedo, Rgb(1, 0, 0));
    const auto roof = std::find_if(objects.begin(), objects.end(), [](const CityObject& o) { return o.id == "roof"; });
    ASSERT_NE(roof, objects.end());
    ASSERT_TRUE(roof->geometry.surfaces[0].texture.has_value());
    const Texture& texture = city.city.textures[roof->geometry.surfaces[0].texture->index()];
    EXPECT_FALSE(texture.is_missing);
    EXPECT_EQ(texture.wrap, TextureWrap::clamp);
    EXPECT_EQ(city.findings.count("SB402"), 1u);
    EXPECT_EQ(city.findings.count("SB403"), 1u);
    EXPECT_EQ(city.findings.count("SB404"), 1u) << "BuildingWall is in no library";
    EXPECT_EQ(city.findings.count("SB406"), 1u);
}

TEST(ReadObj, BadLinesAreToldWithTheirNumber) {
    const LoadedCity city =
        load_obj(kCube + "f 1 2 99\nf 1 2\nf 1 0 2\nf a b c\nv 1 x 2\nf 1 2 -1\nl 1 2\nf 1 \\\n2 3\n");
    EXPECT_EQ(city.findings.count("SB103"), 3u);
    EXPECT_EQ(city.findings.count("SB204"), 1u);
    EXPECT_EQ(city.findings.count("SB101"), 1u);
    EXPECT_EQ(city.findings.count("SB211"), 1u);
    EXPECT_EQ(city.findings.count("SB102"), 1u);
    for (const Finding& finding : city.findings.list()) {
        if (finding.code == "SB204") {
            EXPECT_EQ(finding.where, "a.obj: line 16");
        }
    }
    EXPECT_EQ(load_obj("v 0 0 0\nmtllib ../a.mtl\nmtllib none.mtl\n").findings.count("SB117"), 1u);
}

TEST(ReadObj, RealFiles) {
    SKYBAKE_NEEDS_DATA(test_data("data/lyon-obj-geometric-issues"));
    for (const auto& entry : std::filesystem::directory_iterator(test_data("data/lyon-obj-geometric-issues"))) {
        if (entry.path().extension() != ".obj") continue;
        SCOPED_TRACE(entry.path());
        const LoadedCity city = load(entry.path());
        // A third piece of terrain, 20 m of walls and slopes, cannot be told from a building.
        const std::string name = entry.path().filename().string();
        EXPECT_EQ(city.has_own_ground, name.starts_with("extrait_2") || name.starts_with("extrait_3"));
        EXPECT_GT(city.summary.surfaces, 80u);
        EXPECT_EQ(city.findings.count(Severity::error), 0u);
    }
}

TEST(ReadObj, RealFilesWithGarbledBytesAndCuts) {
    const auto path = test_data("data/lyon-obj-geometric-issues/cloche_hopital_charite.obj");
    SKYBAKE_NEEDS_DATA(path);
    std::ostringstream whole;
    whole << std::ifstream(path, std::ios::binary).rdbuf();
    const TemporaryFolder folder;
    static constexpr std::string_view kBytes = "0vf/ -.e9a\n\\ntl";
    for (std::uint64_t round = 0; round < 200; ++round) {
        std::string text = whole.str();
        for (std::uint64_t i = 0; i <= round % 16; ++i)
            text[hash_combine(round, 2 * i) % text.size()] = kBytes[hash_combine(round, 2 * i + 1) % kBytes.size()];
        if (round % 4 == 0) text.resize(hash_combine(round, 99) % text.size());
        EXPECT_NO_THROW(load(folder.write("a.obj", "v 0 0 0\n" + text))) << round;
    }
}

TEST(ReadObj, DelftIsTheCityJsonOf3dfier) {
    const auto path = test_data("data/delft-3dfier/testarea.obj");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity mesh = load(path);
    EXPECT_EQ(shown_of(mesh, ObjectType::building), 160u);
    EXPECT_EQ(shown_of(mesh, ObjectType::road), 143u);
    EXPECT_EQ(shown_of(mesh, ObjectType::plant_cover), 126u);
    EXPECT_EQ(shown_of(mesh, ObjectType::terrain), 81u);
    EXPECT_EQ(shown_of(mesh, ObjectType::water), 3u);
    EXPECT_EQ(shown_of(mesh, ObjectType::bridge), 3u);
    EXPECT_TRUE(mesh.has_own_ground);
    const LoadedCity json = load(test_data("data/delft-3dfier/delft.json"));
    EXPECT_NEAR(extent_of(mesh.city).size().x, extent_of(json.city).size().x, 0.1);
    EXPECT_NEAR(extent_of(mesh.city).size().y, extent_of(json.city).size().y, 0.1);
}

}  // namespace
}  // namespace skybake
