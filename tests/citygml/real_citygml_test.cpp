// Real CityGML files and their real faults. Truth: the table and the notes of the data's DATA.md, counted there by
// other tools.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "gml_text.h"
#include "test_data.h"

namespace skybake {
namespace {

const std::string kTokyo = "data/tokyo-plateau-textured-citygml/53394517_bldg_6697_2_op_CityGML";

std::map<SurfaceType, std::size_t> surfaces_of(const LoadedCity& loaded) {
    std::map<SurfaceType, std::size_t> counts;
    for (const CityObject& object : loaded.city.objects) {
        for (const Surface& surface : object.geometry.surfaces) ++counts[surface.type];
    }
    return counts;
}

TEST(RealCityGml, GrazTurnsSixGroundsAndSixRoofs) {
    const auto path = test_data("data/graz-inffeld-citygml/campus_inffeld.gml");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(loaded.city.objects.size(), 109u);
    auto counts = surfaces_of(loaded);
    EXPECT_EQ(counts[SurfaceType::ground], 115u);
    EXPECT_EQ(counts[SurfaceType::roof], 115u);
    EXPECT_EQ(counts[SurfaceType::wall], 905u);
    EXPECT_EQ(loaded.findings.count(Severity::error), 0u);
    const Vec3d size = extent_of(loaded.city).size();
    EXPECT_NEAR(size.x, 809, 1);
    EXPECT_NEAR(size.y, 303, 1);
    EXPECT_NEAR(size.z, 35, 1);
    ASSERT_TRUE(loaded.georeference.site.has_value());
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->latitude_rad), 47.06, 0.01);
}

TEST(RealCityGml, TheIngolstadtStreetHasItsWindowsAndTextures) {
    const auto folder = test_data("data/ingolstadt-lod3-citygml");
    SKYBAKE_NEEDS_DATA(folder);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".xml") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    ASSERT_EQ(files.size(), 18u);
    SilentProgress progress;
    const LoadedCity loaded = load_city(files, {}, progress);
    auto counts = surfaces_of(loaded);
    EXPECT_GT(counts[SurfaceType::window], 404u) << "frames and panes of 404 windows";
    EXPECT_GE(counts[SurfaceType::door], 22u);
    EXPECT_EQ(counts[SurfaceType::closure], 4u);
    EXPECT_EQ(loaded.findings.count("SB401") + loaded.findings.count("SB402") + loaded.findings.count("SB403"), 0u);
    EXPECT_EQ(loaded.city.textures.size(), 56u) << "the files name 56 images, some of them for front and back";
    std::size_t holes = 0;
    for (const CityObject& object : loaded.city.objects) {
        for (const Surface& s : object.geometry.surfaces) holes += s.ring_end - s.ring_begin - 1;
    }
    EXPECT_GT(holes, 1400u) << "of 1488 interior rings";
    const Vec3d size = extent_of(loaded.city).size();
    EXPECT_NEAR(size.x, 155, 1);
    EXPECT_NEAR(size.y, 170, 1);
    EXPECT_NEAR(size.z, 24, 1);
}

TEST(RealCityGml, TheLyonHouseIsClosedAndTextured) {
    const auto path = test_data("data/lyon-textured-house-citygml/LYON_1ER_BATI_2015_small_house.gml");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(loaded.summary.closed_shells, 1u);
    EXPECT_EQ(loaded.summary.surfaces, 7u);
    EXPECT_EQ(loaded.city.objects[1].parent_id, "BU_69381AB133");
    const auto& surfaces = loaded.city.objects[1].geometry.surfaces;
    EXPECT_EQ(std::count_if(surfaces.begin(), surfaces.end(), [](const Surface& s) { return s.texture.has_value(); }),
              6);
    EXPECT_EQ(loaded.findings.count("SB304"), 1u) << "the file names no reference system";
    EXPECT_EQ(loaded.findings.count("SB202"), 0u);
}

TEST(RealCityGml, TokyoIsTheSameInVersions2And3) {
    SKYBAKE_NEEDS_DATA(test_data(kTokyo + "2.gml"));
    const LoadedCity two = load(test_data(kTokyo + "2.gml"));
    const LoadedCity three = load(test_data(kTokyo + "3.gml"));
    const Geometry& a = two.city.objects[0].geometry;
    const Geometry& b = three.city.objects[0].geometry;
    EXPECT_EQ(a.surfaces.size(), 650u);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_EQ(a.corner_uv, b.corner_uv);
    for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
        EXPECT_EQ(a.surfaces[i].type, b.surfaces[i].type);
        EXPECT_EQ(a.surfaces[i].texture, b.surfaces[i].texture);
    }
    EXPECT_EQ(two.summary.closed_shells, 1u);
    EXPECT_EQ(two.city.lods, (std::vector<std::string>{"0", "1", "2"}));
    const Vec3d size = extent_of(two.city).size();
    EXPECT_NEAR(size.x, 119, 1);
    EXPECT_NEAR(size.y, 64, 1);
    EXPECT_NEAR(size.z, 32, 1);
    EXPECT_NEAR(degrees_from_radians(two.georeference.site->latitude_rad), 35.679, 0.001);
    EXPECT_NEAR(degrees_from_radians(two.georeference.site->longitude_rad), 139.718, 0.001);
}

TEST(RealCityGml, WestTokyoPotsdamAndBerlin) {
    SKYBAKE_NEEDS_DATA(test_data("data/potsdam-lod1-citygml10"));
    const LoadedCity tokyo = load(test_data("data/tokyo-west-plateau-lod1-citygml/53395404_bldg_6697_op.gml"));
    EXPECT_EQ(tokyo.city.objects.size(), 657u);
    EXPECT_EQ(tokyo.summary.closed_shells, 657u);
    EXPECT_NEAR(extent_of(tokyo.city).size().x, 578, 1);
    EXPECT_NEAR(extent_of(tokyo.city).size().y, 389, 1);
    const LoadedCity potsdam = load(test_data("data/potsdam-lod1-citygml10/Potsdam_LoD1.gml"));
    EXPECT_EQ(potsdam.summary.closed_shells, 97u);
    EXPECT_EQ(potsdam.georeference.crs_code, "EPSG:25833+5783");
    EXPECT_NEAR(extent_of(potsdam.city).size().x, 619, 1);
    const LoadedCity berlin = load(test_data("data/berlin-citygml10/berlin_open_data_sample_data.citygml"));
    EXPECT_EQ(berlin.city.objects.size(), 61u);
    EXPECT_EQ(berlin.summary.surfaces, 1125u);
    EXPECT_NEAR(extent_of(berlin.city).size().y, 338, 1);
}

TEST(RealCityGml, TheValidatorsControlsHaveNoErrors) {
    SKYBAKE_NEEDS_DATA(test_data("data/broken/val3dity/gml"));
    for (const char* file : {"csol1.gml", "msol1.gml"}) {
        const LoadedCity loaded = load(test_data(std::string("data/broken/val3dity/gml/") + file));
        EXPECT_EQ(loaded.summary.closed_shells, 2u);
        EXPECT_EQ(loaded.findings.count("SB207") + loaded.findings.count("SB208") + loaded.findings.count("SB209"), 0u);
        EXPECT_EQ(loaded.findings.count(Severity::error), 0u);
    }
    EXPECT_THAT(finding_text(load(test_data("data/broken/go-citygml/malformed_poslist.gml")), "SB101"),
                testing::HasSubstr("line 15: LinearRing: 5 numbers are no whole positions of 3"));
    EXPECT_EQ(load(test_data("data/broken/go-citygml/unsupported_objects.gml")).findings.count("SB117"), 1u);
    EXPECT_EQ(load(test_data("data/broken/go-citygml/malformed_ring.gml")).findings.count("SB209"), 1u);
}

}  // namespace
}  // namespace skybake
