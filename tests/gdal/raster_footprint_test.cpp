// Rasters and footprints through GDAL: small files made here, and the measured courtyard. Truth: the numbers written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "cityjson/temporary_city.h"
#include "test_data.h"

namespace skybake {
namespace {

using testing::HasSubstr;

const std::string kGrid = "ncols 4\nnrows 3\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -9999\n";

LoadedCity load_all(const std::vector<std::filesystem::path>& files, const LoadOptions& options = {}) {
    SilentProgress progress;
    return load_city(files, options, progress);
}
std::string feature(const std::string& properties, const std::string& coordinates) {
    return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":{"type":"Polygon","coordinates":)" +
           coordinates + "}}";
}
std::string collection(const std::string& features, const std::string& crs = "urn:ogc:def:crs:EPSG::25832") {
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + crs + R"("}},"features":[)" +
           features + "]}";
}

TEST(Raster, AnAsciiGridIsGroundThroughTheMiddlesOfItsCells) {
    const TemporaryFolder folder;
    const LoadedCity loaded = load(folder.write("dem.asc", kGrid + "1 2 3 4\n1 2 3 4\n1 2 3 4\n"));
    EXPECT_TRUE(loaded.has_own_ground);
    EXPECT_EQ(extent_of(loaded.city).lo, Vec3d(1005, 2005, 1));
    EXPECT_EQ(extent_of(loaded.city).hi, Vec3d(1035, 2025, 4));
    EXPECT_EQ(loaded.findings.count("SB503"), 1u);
    // A cell without a value leaves a gap.
    const LoadedCity gap = load(folder.write("gap.asc", kGrid + "1 2 3 4\n1 2 -9999 4\n1 2 3 4\n"));
    EXPECT_EQ(extent_of(gap.city).size(), Vec3d(30, 20, 3));
    EXPECT_GT(gap.summary.surfaces, 2u);
    for (const Vec3d& p : gap.city.objects.at(0).geometry.vertices) EXPECT_NE(Vec2d(p), Vec2d(1025, 2015));
}

TEST(Raster, WhatIsNoRasterIsRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW(load(folder.write("a.tif", std::string("II*\0", 4) + "garbage")), InputError);
    EXPECT_THROW(load(folder.write("a.asc", "ncols 4\nnrows -3\n")), InputError);
    try {
        load(folder.write("big.asc", "ncols 100000\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("100000 x 2 cells"));
    }
}

TEST(Footprints, HeightsStoreysAndRoofs) {
    const TemporaryFolder folder;
    const auto square = [](double x) {
        return "[[[" + std::to_string(x) + ",0],[" + std::to_string(x + 10) + ",0],[" + std::to_string(x + 10) +
               ",6],[" + std::to_string(x) + ",6],[" + std::to_string(x) + ",0]]]";
    };
    const LoadedCity loaded = load(folder.write(
        "a.geojson",
        collection(feature(R"("id":"h","height":"12 m")", square(0)) + "," +
                   feature(R"("id":"l","building:levels":3,"roof:levels":1,"roof:shape":"gabled")", square(20)) + "," +
                   feature(R"("id":"none")", square(40)) + "," +
                   feature(R"("id":"m","height":9,"min_height":3,"roof:shape":"dome")", square(60)))));
    ASSERT_EQ(loaded.city.objects.size(), 3u);
    const auto top = [&](const std::string& id) {
        Box3d box;
        for (const CityObject& o : loaded.city.objects) {
            for (const Vec3d& p : o.geometry.vertices) {
                if (o.id == id) box.extend(p);
            }
        }
        return Vec2d(box.lo.z, box.hi.z);
    };
    EXPECT_EQ(top("h"), Vec2d(0, 12));
    EXPECT_EQ(top("l"), Vec2d(0, 12)) << "four storeys of 3 m";
    EXPECT_EQ(top("m"), Vec2d(3, 9));
    EXPECT_EQ(loaded.findings.count("SB123"), 1u);
    EXPECT_EQ(loaded.findings.count("SB124"), 1u);
    EXPECT_EQ(loaded.findings.count("SB504"), 3u) << "no terrain to stand on";
    EXPECT_EQ(loaded.summary.closed_shells, 3u);
}

TEST(Footprints, StandOnTheTerrainOfTheOtherFileInItsSystem) {
    const TemporaryFolder folder;
    // A slope of 1:10 to the east about 9° E 48° N, in UTM 32; the footprint is in degrees.
    std::string grid = "ncols 41\nnrows 41\nxllcorner 499795\nyllcorner 5316100\ncellsize 10\n";
    for (int r = 0; r < 41; ++r) {
        for (int c = 0; c < 41; ++c) grid += std::to_string(300 + c) + " ";
        grid += "\n";
    }
    folder.write("dem.prj",
                 "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
                 "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
                 "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_"
                 "meridian\",9],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],"
                 "PARAMETER[\"false_northing\",0],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"32632\"]]");
    const auto dem = folder.write("dem.asc", grid);
    const auto houses = folder.write(
        "h.geojson",
        R"({"type":"FeatureCollection","features":[)" +
            feature(R"("id":"h","height":8)", "[[[9,48],[9.0001,48],[9.0001,48.0001],[9,48.0001],[9,48]]]") + "]}");
    LoadOptions options;
    options.raster.max_error_m = 0.0;
    const LoadedCity loaded = load_all({dem, houses}, options);
    EXPECT_EQ(loaded.georeference.crs_code, "EPSG:32632");
    EXPECT_EQ(loaded.findings.count("SB308"), 1u);
    EXPECT_EQ(loaded.findings.count("SB504"), 0u);
    ASSERT_EQ(loaded.city.objects.size(), 2u);
    Box3d box;
    for (const Vec3d& p : loaded.city.objects[1].geometry.vertices) box.extend(p);
    EXPECT_NEAR(box.lo.x, 500000.0, 0.01) << "9° E is the middle of the zone";
    EXPECT_NEAR(box.size().x, 7.46, 0.01) << "0.0001° of longitude at 48°, scale 0.9996";
    // 500 000 is 20 cells and 0 m to the east of the first middle at 499 800.
    EXPECT_NEAR(box.lo.z, 320.0, 0.01);
    EXPECT_NEAR(box.hi.z, 328.0, 0.01);
    EXPECT_EQ(loaded.findings.count("SB208"), 0u) << "longitude and latitude were not mixed up";
}

TEST(Raster, TheMeasuredCourtyard) {
    const auto dem = test_data("data/goteborg-kronenhuset-measured/DEM_KR.tif");
    SKYBAKE_NEEDS_DATA(dem);
    LoadOptions options;
    const LoadedCity ground = load(dem, options);
    EXPECT_EQ(ground.georeference.crs_code, "EPSG:3007");
    options.raster.content = io::RasterContent::surface;
    const LoadedCity city = load(test_data("data/goteborg-kronenhuset-measured/DSM_KR.tif"), options);
    const Vec3d size = extent_of(city.city).size();
    EXPECT_NEAR(size.x, 234, 2);
    EXPECT_NEAR(size.y, 223, 2);
    std::size_t walls = 0;
    for (const Surface& s : city.city.objects.at(0).geometry.surfaces) walls += s.type == SurfaceType::wall;
    EXPECT_GT(walls, 1000u);
    EXPECT_LT(ground.summary.surfaces, city.summary.surfaces);
}

}  // namespace
}  // namespace skybake
