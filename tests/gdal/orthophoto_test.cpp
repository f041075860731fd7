// Pictures from above on the ground. Truth: the colours and places that the pictures made here have.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>

#include "cityjson/temporary_city.h"
#include "error_of.h"
#include "io/image/image.h"

namespace skybake {
namespace {

using testing::HasSubstr;

/// A picture of `side` × `side` pixels of a metre whose red is the column and whose green the row, times 255 / side.
void write_photo(const std::filesystem::path& path, int epsg, double west, double north, int side,
                 GDALDataType type = GDT_Byte) {
    GDALAllRegister();
    const GDALDatasetUniquePtr photo(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), side, side, 3, type, nullptr));
    std::array<double, 6> place{west, 1.0, 0.0, north, 0.0, -1.0};
    photo->SetGeoTransform(place.data());
    OGRSpatialReference system;
    system.importFromEPSG(epsg);
    photo->SetSpatialRef(&system);
    std::vector<std::uint8_t> band(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < band.size(); ++i) {
            const std::size_t n = static_cast<std::size_t>(side);
            band[i] = static_cast<std::uint8_t>(c == 2 ? 9 : (c == 0 ? i % n : i / n) * 255 / n);
        }
        ASSERT_EQ(photo->GetRasterBand(c + 1)->RasterIO(GF_Write, 0, 0, side, side, band.data(), side, side, GDT_Byte,
                                                        0, 0, nullptr),
                  CE_None);
    }
}

/// Terrain of squares of `step` metres from (0, 0) to (side, side), offset by (x, y), 0.1 m up for each metre east.
std::string terrain(const std::string& crs, double x, double y, int side, int step) {
    std::string vertices, faces;
    const int n = side / step + 1;
    for (int r = 0; r < n; ++r) {
        for (int c = 0; c < n; ++c) {
            vertices += (vertices.empty() ? "[" : ",[") + std::to_string(c * step) + "," + std::to_string(r * step) +
                        "," + std::to_string(0.1 * c * step) + "]";
            if (r + 1 == n || c + 1 == n) continue;
            const int v = r * n + c;
            for (const auto& [i, j, k] : {std::array{v, v + 1, v + n + 1}, std::array{v, v + n + 1, v + n}})
                faces += (faces.empty() ? "[[" : ",[[") + std::to_string(i) + "," + std::to_string(j) + "," +
                         std::to_string(k) + "]]";
        }
    }
    return R"({"type":"CityJSON","version":"2.0","metadata":{"referenceSystem":")" + crs +
           R"("},"transform":{"scale":[1,1,1],"translate":[)" + std::to_string(x) + "," + std::to_string(y) +
           R"(,0]},"CityObjects":{"t":{"type":"TINRelief","geometry":[{"type":"CompositeSurface","lod":"1","boundaries":[)" +
           faces + R"(]}]}},"vertices":[)" + vertices + "]}";
}

/// The colour that the ground shows at a vertex.
std::array<int, 3> colour_at(const LoadedCity& city, const Surface& surface, std::uint32_t corner) {
    const Geometry& g = city.city.objects[0].geometry;
    const io::Image8 image = io::read_image(city.city.textures[surface.texture->index()]);
    const Vec2f uv = g.corner_uv[corner];
    const auto at = [](float v, int count) {
        return std::clamp(static_cast<int>(v * static_cast<float>(count)), 0, count - 1);
    };
    const int x = at(uv.x, image.width), y = at(1.0f - uv.y, image.height);
    const std::size_t pixel =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
    return {image.pixels[pixel], image.pixels[pixel + 1], image.pixels[pixel + 2]};
}

LoadedCity load_with(const std::filesystem::path& city, const std::filesystem::path& photo) {
    LoadOptions options;
    options.orthophotos = {photo};
    return load(city, options);
}

TEST(Orthophoto, LiesWhereItBelongs) {
    const TemporaryFolder folder;
    const auto city = folder.write("a.city.json", terrain("EPSG:25833", 500000, 5300000, 200, 10));
    const auto photo = city.parent_path() / "p.tif";
    write_photo(photo, 25833, 500000 - 20, 5300000 + 220, 240);
    const LoadedCity loaded = load_with(city, photo);
    EXPECT_EQ(loaded.findings.count("SB505"), 1u);
    EXPECT_EQ(loaded.inputs.size(), 2u);
    const Geometry& g = loaded.city.objects[0].geometry;
    ASSERT_EQ(g.surfaces.size(), 800u);
    for (const Surface& surface : g.surfaces) {
        ASSERT_TRUE(surface.texture.has_value());
        for (std::uint32_t c = g.ring_first[surface.ring_begin]; c < g.ring_first[surface.ring_end]; ++c) {
            const Vec3d& p = g.vertices[g.corners[c]];
            const auto [red, green, blue] = colour_at(loaded, surface, c);
            // Two pixels of 255/240 codes, one of the lookup and one of the resampling, and a code for rounding down.
            EXPECT_NEAR(red, (p.x - 500000 + 20) * 255 / 240, 3.2);
            EXPECT_NEAR(green, (5300220 - p.y) * 255 / 240, 3.2);
            EXPECT_EQ(blue, 9);
        }
    }
}

TEST(Orthophoto, ComesFromItsSystemIntoTheCitys) {
    const TemporaryFolder folder;
    // 15° E is 500 000 in zone 33; the photo is in zone 32, where that place is far off and north is turned by 4.5°.
    const auto city = folder.write("a.city.json", terrain("EPSG:25833", 500000, 5300000, 100, 10));
    OGRSpatialReference from, to;
    from.importFromEPSG(25833);
    to.importFromEPSG(25832);
    const std::unique_ptr<OGRCoordinateTransformation> way(OGRCreateCoordinateTransformation(&from, &to));
    double x = 500000, y = 5300000;
    ASSERT_TRUE(way->Transform(1, &x, &y));
    const auto photo = city.parent_path() / "p.tif";
    write_photo(photo, 25832, std::floor(x) - 60, std::floor(y) + 180, 240);
    const LoadedCity loaded = load_with(city, photo);
    const Geometry& g = loaded.city.objects[0].geometry;
    for (const Surface& surface : g.surfaces) {
        for (std::uint32_t c = g.ring_first[surface.ring_begin]; c < g.ring_first[surface.ring_end]; ++c) {
            double px = g.vertices[g.corners[c]].x, py = g.vertices[g.corners[c]].y;
            ASSERT_TRUE(way->Transform(1, &px, &py));
            const auto [red, green, blue] = colour_at(loaded, surface, c);
            EXPECT_NEAR(red, (px - std::floor(x) + 60) * 255 / 240, 3.2);
            EXPECT_NEAR(green, (std::floor(y) + 180 - py) * 255 / 240, 3.2);
        }
    }
}

TEST(Orthophoto, BeyondItGroundHasItsOwnAlbedo) {
    const TemporaryFolder folder;
    // One square of 100 m, of which the photo covers the south-west quarter.
    const auto city = folder.write("a.city.json", terrain("EPSG:25833", 500000, 5300000, 100, 100));
    const auto photo = city.parent_path() / "p.tif";
    write_photo(photo, 25833, 500000 - 20, 5300000 + 50, 70);
    const LoadedCity loaded = load_with(city, photo);
    const Geometry& g = loaded.city.objects[0].geometry;
    for (const Surface& surface : g.surfaces) {
        for (std::uint32_t c = g.ring_first[surface.ring_begin]; c < g.ring_first[surface.ring_end]; ++c) {
            const bool is_under = g.vertices[g.corners[c]].x < 500050 && g.vertices[g.corners[c]].y < 5300050;
            const auto colour = colour_at(loaded, surface, c);
            // Default terrain reflects 0.20 of the blue, of which the code is 124.
            EXPECT_EQ(colour[2], is_under ? 9 : 124);
        }
    }
}

TEST(Orthophoto, WhatDoesNotFitIsRefused) {
    const TemporaryFolder folder;
    const auto city = folder.write("a.city.json", terrain("EPSG:25833", 500000, 5300000, 100, 10));
    const auto photo = city.parent_path() / "p.tif";
    write_photo(photo, 25833, 700000, 5300000, 70);
    EXPECT_THAT(error_of([&] { load_with(city, photo); }), HasSubstr("p.tif: covers no ground of the city"));
    write_photo(photo, 25833, 500000, 5300100, 70, GDT_UInt16);
    EXPECT_THAT(error_of([&] { load_with(city, photo); }), HasSubstr("no picture of 8 bits a colour"));
    EXPECT_THAT(error_of([&] { load_with(city, folder.write("x.tif", "II*")); }), HasSubstr("x.tif: cannot be opened"));
    EXPECT_THAT(error_of([&] { load_with(city, city.parent_path() / "none.tif"); }), HasSubstr("no such file"));
    io::write_png(city.parent_path() / "p.png", {2, 2, 3, std::vector<std::uint8_t>(12, 7)});
    EXPECT_THAT(error_of([&] { load_with(city, city.parent_path() / "p.png"); }),
                HasSubstr("does not say where it lies"));
    folder.write("p.pgw", "50\n0\n0\n-50\n500025\n5300075\n");
    EXPECT_EQ(load_with(city, city.parent_path() / "p.png").findings.count("SB505"), 1u);
}

}  // namespace
}  // namespace skybake
