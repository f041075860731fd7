// Real files and their real faults. Truth: the table and the notes of the data's DATA.md, counted there by other tools.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "temporary_city.h"
#include "test_data.h"

namespace skybake {
namespace {

std::size_t buildings_of(const CityModel& city) {
    return static_cast<std::size_t>(std::count_if(city.objects.begin(), city.objects.end(),
                                                  [](const CityObject& o) { return o.type == ObjectType::building; }));
}
std::size_t shown_of(const CityModel& city, ObjectType type) {
    return static_cast<std::size_t>(std::count_if(city.objects.begin(), city.objects.end(), [&](const CityObject& o) {
        return o.type == type && !o.geometry.is_empty();
    }));
}
std::size_t surfaces_of(const CityModel& city, ObjectType type) {
    std::size_t sum = 0;
    for (const CityObject& object : city.objects) sum += object.type == type ? object.geometry.surfaces.size() : 0;
    return sum;
}

TEST(RealCities, ViennaShowsEachShellOnce) {
    const auto path = test_data("data/vienna-cityjsonseq/vienna.jsonl");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(buildings_of(loaded.city), 149u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::building_part), 443u);
    EXPECT_EQ(loaded.findings.count("SB202"), 490u) << "every one of the 490 solids comes twice";
    std::size_t roofs = 0;
    for (const CityObject& o : loaded.city.objects) {
        for (const Surface& s : o.geometry.surfaces) roofs += s.type == SurfaceType::roof;
    }
    EXPECT_EQ(roofs, 1930u) << "the semantics of the loose surfaces went to the solids";
    EXPECT_EQ(loaded.findings.count("SB304"), 1u);
    EXPECT_FALSE(loaded.georeference.site.has_value());
    const Vec3d size = extent_of(loaded.city).size();
    EXPECT_NEAR(size.x, 524, 1);
    EXPECT_NEAR(size.y, 556, 1);
    EXPECT_NEAR(size.z, 57, 1);
}

TEST(RealCities, TheHagueHasItsTerrain) {
    const auto path = test_data("data/denhaag-cityjson/denhaag.city.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(buildings_of(loaded.city), 844u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::building) + shown_of(loaded.city, ObjectType::building_part), 1990u);
    EXPECT_EQ(surfaces_of(loaded.city, ObjectType::terrain), 5595u);
    EXPECT_TRUE(loaded.has_own_ground);
    ASSERT_TRUE(loaded.georeference.site.has_value());
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->latitude_rad), 52.10, 0.02);
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->longitude_rad), 4.27, 0.02);
}

TEST(RealCities, MamreIsBroughtBackToItsPlace) {
    const auto path = test_data("data/mamre-cityjson/citjsn_mamre3D.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(loaded.findings.count("SB201"), 1u);
    EXPECT_EQ(buildings_of(loaded.city), 2344u);
    EXPECT_EQ(surfaces_of(loaded.city, ObjectType::terrain), 28228u);
    const Box3d box = extent_of(loaded.city);
    EXPECT_NEAR(box.size().x, 2623, 1);
    EXPECT_NEAR(box.size().y, 2101, 1);
    EXPECT_NEAR(box.size().z, 107, 1);
    // The stated extent has a margin of 250 m: the true range lies in its middle.
    EXPECT_NEAR(box.lo.x, 263698.1 + 250, 1);
    EXPECT_NEAR(box.hi.y, 6290344.5 - 250, 1);
    EXPECT_GE(box.lo.z, 138.2);
    EXPECT_LE(box.hi.z, 270.7);
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->latitude_rad), -33.51, 0.02);  // Mamre, Western Cape
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->longitude_rad), 18.47, 0.02);
}

TEST(RealCities, CapeTownNeedsNoTransform) {
    const auto path = test_data("data/capetown-uestate-cityjson/citjsnClean_uEstate10m.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(buildings_of(loaded.city), 305u);
    EXPECT_EQ(surfaces_of(loaded.city, ObjectType::terrain), 15819u);
    EXPECT_NEAR(extent_of(loaded.city).size().z, 122, 1);
    EXPECT_EQ(loaded.findings.count("SB113"), 1u);
    EXPECT_EQ(loaded.findings.count("SB116"), 1u);
    EXPECT_EQ(loaded.findings.count("SB215"), 1u);
}

TEST(RealCities, DelftOffersFourLodsAndBothFormatsGiveTheSame) {
    const auto path = test_data("data/delft-3dbag/delft.city.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity whole = load(path);
    EXPECT_EQ(whole.city.lods, (std::vector<std::string>{"0", "1.2", "1.3", "2.2"}));
    EXPECT_EQ(buildings_of(whole.city), 159u);
    EXPECT_EQ(shown_of(whole.city, ObjectType::building), 0u) << "a building's LoD 0 is a footprint";
    EXPECT_EQ(shown_of(whole.city, ObjectType::building_part), 160u);
    EXPECT_EQ(whole.findings.count("SB108"), 0u);
    const LoadedCity sequence = load(test_data("data/delft-3dbag/delft.city.jsonl"));
    EXPECT_EQ(sequence.summary.triangles, whole.summary.triangles);
    EXPECT_LT(glm::distance(extent_of(sequence.city).lo, extent_of(whole.city).lo), 1e-6)
        << "but for the transforms' rounding";
    const LoadedCity coarse = load(path, {"1.2"});
    EXPECT_EQ(shown_of(coarse.city, ObjectType::building_part), 160u);
    EXPECT_LT(coarse.summary.triangles, whole.summary.triangles);
}

TEST(RealCities, DelftOf3dfierIsAllGround) {
    const auto path = test_data("data/delft-3dfier/delft.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(buildings_of(loaded.city), 160u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::road), 143u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::plant_cover), 126u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::land_use), 81u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::water), 3u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::bridge), 3u);
    EXPECT_TRUE(loaded.has_own_ground);
}

TEST(RealCities, RotterdamKnowsFourOfItsImages) {
    const auto path = test_data("data/rotterdam-delfshaven-cityjson/3-20-DELFSHAVEN.city.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(buildings_of(loaded.city), 853u);
    EXPECT_EQ(loaded.city.textures.size(), 148u);
    EXPECT_EQ(loaded.findings.count("SB401"), 144u);
    EXPECT_GE(loaded.findings.count("SB204"), 633u)
        << "the faces without area that DATA.md counts, and slivers below 0.1 mm";
    EXPECT_EQ(loaded.summary.surfaces + loaded.findings.count("SB204"), 15482u);
}

TEST(RealCities, FzkHausHasAllItsImages) {
    const auto path =
        test_data("data/fzk-haus-cityjson-textured/01-FZK-Haus-LoD2-Tex-no-Storey-CG30-V01_formatted.json");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(loaded.city.textures.size(), 5u);
    EXPECT_EQ(loaded.findings.count("SB401"), 0u);
    EXPECT_EQ(loaded.summary.closed_shells, 1u);
    EXPECT_NEAR(extent_of(loaded.city).size().z, 6.5, 0.1);
}

TEST(RealCities, RailwayStandsItsFifteenTrees) {
    const auto path = test_data("data/railway-templates-cityjsonseq/geom_temp.city.jsonl");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::solitary_vegetation), 15u);
    EXPECT_EQ(shown_of(loaded.city, ObjectType::bridge), 1u);
    EXPECT_EQ(loaded.city.textures.size(), 5u);
    EXPECT_EQ(loaded.findings.count("SB401") + loaded.findings.count("SB403"), 0u);
}

/// A broken file and what it must end in: findings, or part of the error.
struct Broken {
    const char* file;
    std::vector<std::string> codes;
    std::string error;
};

TEST(BrokenFiles, EachEndsInItsFindingOrItsError) {
    SKYBAKE_NEEDS_DATA(test_data("data/broken"));
    const std::vector<Broken> files{
        {"val3dity/test_geometry_specific/501.json", {"SB214"}, ""},
        {"val3dity/test_geometry_specific/502.json", {"SB202"}, ""},
        {"val3dity/test_geometry_specific/601.json", {"SB214"}, ""},
        {"val3dity/cityjson/cube10.json", {"SB209"}, ""},
        {"val3dity/cityjson/nonmanifold.json", {"SB209"}, ""},
        {"val3dity/test_duplicates/cube_tol_1.json", {"SB210"}, ""},
        {"val3dity/test_file_format/invalid_schema_cityjson_2.json", {"SB103"}, ""},
        {"val3dity/test_file_format/invalid_json_cityjson.json", {}, "is not JSON: line 3, column"},
        {"val3dity/test_file_format/index901.obj", {"SB103"}, ""},
        {"val3dity/test_duplicates/cube_tol_1.obj", {"SB210"}, ""},
        {"val3dity/test_cjseq/notransform.city.jsonl", {}, "#/transform is missing"},
        {"val3dity/test_empty/completely_empty.json", {}, "the file is empty"},
        {"val3dity/test_empty/empty_primitive.json", {"SB101"}, ""},
        {"val3dity/test_cityjson/emptygeom.json", {"SB117"}, ""},
        {"val3dity/gml/csol1.gml", {"SB304"}, ""},
        {"cjval/texture1.city.json", {"SB403"}, ""},
        {"cjval/texture2.city.json", {"SB403"}, ""},
        {"cjval/texture6.city.json", {"SB403"}, ""},
        {"cjval/material.city.json", {"SB404"}, ""},
        {"cjval/material2.city.json", {"SB404"}, ""},
        {"cjval/japanese.city.json", {"SB307"}, ""},
        {"cjval/duplicate.json", {"SB104"}, ""},
        {"cjval/many.json", {"SB105"}, ""},
        {"cjval/extension.jsonl", {"SB106", "SB119"}, ""},
        {"cjval/sem.json", {"SB112", "SB103"}, ""},
        {"duckdb-cityjson/geometry_templates_bad_lod.city.json", {"SB118"}, ""},
        {"real/paris_tower_z_sentinel.city.jsonl", {"SB211", "SB215"}, ""},
        {"real/frankfurt_draco.b3dm", {}, ""},
        {"real/multiyear_16rows.epw", {}, "is EnergyPlus weather (EPW)"},
    };
    for (const Broken& broken : files) {
        SCOPED_TRACE(broken.file);
        const auto path = test_data(std::string("data/broken/") + broken.file);
        try {
            const LoadedCity loaded = load(path);
            EXPECT_EQ(broken.error, "");
            for (const std::string& code : broken.codes) EXPECT_GT(loaded.findings.count(code), 0u) << code;
        } catch (const InputError& error) {
            ASSERT_NE(broken.error, "") << error.what();
            EXPECT_THAT(error.what(), testing::HasSubstr(broken.error));
        }
    }
}

TEST(BrokenFiles, TheCompressedTileIsReadWhole) {
    const auto path = test_data("data/broken/real/frankfurt_draco.b3dm");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    ASSERT_EQ(loaded.city.objects.size(), 1u);
    // The tile says 49,427 (in its accessor's count, which should be three times as much); 1 of them is there twice.
    ASSERT_EQ(loaded.findings.count("SB202"), 1u);
    EXPECT_EQ(loaded.city.objects[0].geometry.surfaces.size() + loaded.findings.count("SB204") + 1, 49'427u);
}

TEST(BrokenFiles, TheSentinelDoesNotStretchTheTower) {
    const auto path = test_data("data/broken/real/paris_tower_z_sentinel.city.jsonl");
    SKYBAKE_NEEDS_DATA(path);
    const LoadedCity loaded = load(path);
    EXPECT_LT(extent_of(loaded.city).size().z, 100.0);
    EXPECT_GT(loaded.georeference.site->elevation_m, 0.0);
}

TEST(BrokenFiles, ValidControlsHaveNoErrors) {
    SKYBAKE_NEEDS_DATA(test_data("data/broken"));
    for (const char* file : {"val3dity/test_cityjson/torus.city.json", "val3dity/test_valid/composite_solid.json",
                             "val3dity/test_valid/multi_solid.json", "val3dity/test_cityjson/several_lods_valid.json",
                             "cjval/texture3.city.json", "duckdb-cityjson/hollow_solid.city.json"}) {
        SCOPED_TRACE(file);
        const LoadedCity loaded = load(test_data(std::string("data/broken/") + file));
        EXPECT_EQ(loaded.findings.count(Severity::error), 0u);
        EXPECT_EQ(loaded.summary.open_shells, 0u);
        EXPECT_GT(loaded.summary.closed_shells, 0u);
        EXPECT_EQ(loaded.findings.count("SB207") + loaded.findings.count("SB208"), 0u) << "nothing to turn";
    }
    EXPECT_EQ(load(test_data("data/broken/duckdb-cityjson/hollow_solid.city.json")).summary.closed_shells, 2u);
}

TEST(BrokenFiles, EveryFileOfTheFolderEndsWithoutACrash) {
    SKYBAKE_NEEDS_DATA(test_data("data/broken"));
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test_data("data/broken"))) {
        if (!entry.is_regular_file()) continue;
        ++count;
        SCOPED_TRACE(entry.path());
        try {
            EXPECT_FALSE(load(entry.path()).findings.empty());
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::StartsWith(entry.path().string()));
        }
    }
    EXPECT_GE(count, 40u);
}

}  // namespace
}  // namespace skybake
