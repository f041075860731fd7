// What the reader makes of files of a few lines. Truth: the CityJSON 2.0.1 specification, and cubes whose figures are
// plain.
#include "io/cityjson/read_cityjson.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "error_of.h"
#include "temporary_city.h"

namespace skybake {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
    return skybake::error_of([&] { load_text(text); });
}

std::string first_text(const LoadedCity& city, const std::string& code) {
    for (const Finding& finding : city.findings.list()) {
        if (finding.code == code) return to_text(finding);
    }
    return "no " + code;
}

TEST(ReadCityJson, ACubeIsSixSurfacesOfInferredTypes) {
    const LoadedCity city = load_text(document(building(solid())));
    ASSERT_EQ(city.city.objects.size(), 1u);
    const CityObject& object = city.city.objects[0];
    EXPECT_EQ(object.type, ObjectType::building);
    EXPECT_EQ(object.lod, "2");
    ASSERT_EQ(object.geometry.surfaces.size(), 6u);
    EXPECT_EQ(object.geometry.surfaces[0].type, SurfaceType::ground);
    EXPECT_EQ(object.geometry.surfaces[1].type, SurfaceType::roof);
    EXPECT_EQ(object.geometry.surfaces[2].type, SurfaceType::wall);
    EXPECT_EQ(city.summary.triangles, 12u);
    EXPECT_EQ(city.summary.closed_shells, 1u);
    EXPECT_EQ(extent_of(city.city).hi, Vec3d(1.0));
    EXPECT_EQ(city.findings.count("SB207") + city.findings.count("SB208") + city.findings.count("SB209"), 0u);
}

TEST(ReadCityJson, SequenceAndDocumentGiveTheSameCity) {
    const std::string header =
        R"({"type":"CityJSON","version":"2.0",)" + kTransform + R"(,"CityObjects":{},"vertices":[]})";
    const std::string feature = R"({"type":"CityJSONFeature","id":"b","CityObjects":{)" + building(solid()) +
                                R"(},"vertices":)" + kCubeVertices + "}";
    const LoadedCity sequence = load_text(header + "\n\n" + feature + "\r\n");
    const LoadedCity whole = load_text(document(building(solid())));
    ASSERT_EQ(sequence.city.objects.size(), 1u);
    EXPECT_EQ(sequence.city.objects[0].geometry.vertices, whole.city.objects[0].geometry.vertices);
    EXPECT_EQ(sequence.city.objects[0].geometry.corners, whole.city.objects[0].geometry.corners);
    EXPECT_EQ(load_text(header + "\n").city.objects.size(), 0u) << "a header alone is an empty city";
    const LoadedCity cut = load_text(header + "\n" + feature + "\n" + feature.substr(0, 100));
    EXPECT_EQ(cut.city.objects.size(), 1u);
    EXPECT_THAT(first_text(cut, "SB119"),
                HasSubstr("SB119 error: a.city.json: line 3: is not JSON: line 3, column 10"));
}

TEST(ReadCityJson, ABrokenDocumentIsRefusedWithLineAndColumn) {
    EXPECT_THAT(error_of("{\n  \"type\": \"CityJSON\",\n  oops\n}"),
                HasSubstr("a.city.json: is not JSON: line 3, column 3"));
    EXPECT_THAT(error_of(document(building(R"({"type":"Solid","lod":"2","boundaries":[1,,2]})"))),
                HasSubstr("is not JSON: line 1, column"));
    EXPECT_THAT(error_of(document(building(solid()), "[[0,0,0],[1,2")), HasSubstr("is not JSON"));
    EXPECT_THAT(error_of(document(building(solid()), "[[0,0,0],[1,2]]")),
                HasSubstr("#/vertices holds '[1,2]', which is not three numbers"));
    EXPECT_THAT(error_of("   \n"), HasSubstr("the file is empty"));
    EXPECT_THAT(error_of("[1, 2]"), HasSubstr("is not JSON"));
    EXPECT_THAT(error_of("{}"), HasSubstr("its type is not \"CityJSON\""));
    EXPECT_THAT(error_of(R"({"type":"CityJSON","version":"0.9","CityObjects":{},"vertices":[]})"),
                HasSubstr("is CityJSON 0.9, which this version does not read"));
    EXPECT_THAT(error_of(R"({"type":"CityJSON","version":"2.0","vertices":[]})"),
                HasSubstr("#/CityObjects is missing"));
    EXPECT_THAT(error_of(R"({"type":"CityJSON","version":"2.0","CityObjects":{}})"),
                HasSubstr("#/vertices is missing"));
}

TEST(ReadCityJson, OtherFormatsAreRefusedByName) {
    EXPECT_THAT(error_of("<?xml version=\"1.0\"?><COLLADA/>"),
                HasSubstr("is COLLADA, which this version does not read"));
    EXPECT_THAT(error_of("pnts...."), HasSubstr("is 3D Tiles (pnts)"));
    EXPECT_THAT(error_of("date;E00;A00"), HasSubstr("is a file of unknown format"));
    EXPECT_THAT(error_of("LOCATION,Graz,,AUT"), HasSubstr("is EnergyPlus weather (EPW)"));
    EXPECT_THAT(error_of("\x1f\x8b\x08"), HasSubstr("is gzip-compressed data"));
    SilentProgress progress;
    const std::filesystem::path absent = "no-such.city.json";
    EXPECT_THROW(load_city(std::span(&absent, 1), {}, progress), InputError);
}

TEST(ReadCityJson, EveryPrefixOfAFileIsRefusedOrReadButNeverCrashes) {
    const std::string text = document(
        building(solid("2", R"("semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[[0,0,0,0,0,0]]},)")));
    for (std::size_t length = 0; length < text.size(); ++length) {
        EXPECT_NE(error_of(text.substr(0, length)), "no error") << length;
    }
}

TEST(ReadCityJson, EveryByteReplacedEndsInACityOrAnError) {
    const std::string text = document(
        building(solid(
            "2", R"("material":{"t":{"values":[[0,0,0,0,0,null]]}},"texture":{"t":{"values":[[[[0,0,1,2,3]]]]}},)")),
        kCubeVertices,
        R"("appearance":{"materials":[{"name":"m"}],"textures":[{"image":"a.png"}],"vertices-texture":[[0,0],[1,0],[1,1],[0,1]]},)");
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (const char c : {'9', '"', '[', '}', '\0', '\xff'}) {
            std::string changed = text;
            changed[i] = c;
            try {
                load_text(changed);
            } catch (const InputError&) {
            }
        }
    }
}

TEST(ReadCityJson, TheHighestLodIsTakenByValueAndTheAskedOneOnDemand) {
    const std::string objects = building(solid("1.3") + "," + solid("2.2") + "," + solid("0"));
    EXPECT_EQ(load_text(document(objects)).city.objects[0].lod, "2.2");
    EXPECT_EQ(load_text(document(objects), {"1.3"}).city.objects[0].lod, "1.3");
    EXPECT_EQ(load_text(document(objects), {"2"}).city.objects[0].lod, "2.2");
    const LoadedCity nearest = load_text(document(objects), {"1.2"});
    EXPECT_EQ(nearest.city.objects[0].lod, "1.3");
    EXPECT_EQ(nearest.findings.count("SB109"), 1u);
    EXPECT_EQ(nearest.city.lods, (std::vector<std::string>{"0", "1.3", "2.2"}));
    EXPECT_THROW(load_text(document(objects), {"high"}), InputError);
    const LoadedCity flat =
        load_text(document(building(R"({"type":"MultiSurface","lod":0,"boundaries":[[[0,1,2,3]]]})")));
    EXPECT_EQ(flat.findings.count("SB108"), 1u);
    EXPECT_TRUE(flat.city.objects[0].geometry.is_empty());
}

TEST(ReadCityJson, ABuildingAndItsPartsShowABodyOnce) {
    const auto family = [](const std::string& lod_of_whole) {
        return document(building(solid(lod_of_whole), "b", R"("children":["p"],)") +
                        R"(,"p":{"type":"BuildingPart","parents":["b"],"geometry":[)" + solid("2.2") + "]}");
    };
    const LoadedCity parts = load_text(family("1.2"));
    EXPECT_EQ(parts.findings.count("SB114"), 1u);
    EXPECT_TRUE(parts.city.objects[0].geometry.is_empty());
    EXPECT_EQ(parts.city.objects[1].geometry.surfaces.size(), 6u);
    const LoadedCity whole = load_text(family("3"));
    EXPECT_FALSE(whole.city.objects[0].geometry.is_empty());
    EXPECT_TRUE(whole.city.objects[1].geometry.is_empty());
}

TEST(ReadCityJson, TheSameShellTwiceIsUsedOnceWithItsSemantics) {
    const std::string surfaces =
        R"({"type":"MultiSurface","lod":"2","semantics":{"surfaces":[{"type":"Window"}],"values":[0,0,0,0,0,0]},"boundaries":)" +
        kCubeShell + "}";
    const LoadedCity city = load_text(document(building(surfaces + "," + solid())));
    const Geometry& g = city.city.objects[0].geometry;
    ASSERT_EQ(g.surfaces.size(), 6u);
    EXPECT_EQ(g.shells[0].kind, Shell::Kind::outer);
    for (const Surface& surface : g.surfaces) EXPECT_EQ(surface.type, SurfaceType::window);
    EXPECT_THAT(first_text(city, "SB202"),
                HasSubstr("a.city.json: #/CityObjects/b/geometry/0: 6 surfaces are there already at LoD 2"));
}

TEST(ReadCityJson, BadIndicesAndNestsLeaveOutTheirSurfaceOnly) {
    const LoadedCity city = load_text(document(building(
        R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,99]],[[0,1,"x"]],[[0,1]],7,[[4,5,6,7]]]})")));
    EXPECT_EQ(city.summary.surfaces, 1u);
    EXPECT_EQ(city.city.objects[0].geometry.surfaces[0].source_index, 4u);
    EXPECT_EQ(first_text(city, "SB103"),
              "SB103 error: a.city.json: #/CityObjects/b/geometry/0/boundaries (polygon 0): vertex 99 of 8 does not "
              "exist; the surface is left out. Export the file again; cjio's "
              "`validate` shows all such places.");
    EXPECT_EQ(city.findings.count("SB101"), 2u);
    EXPECT_EQ(city.findings.count("SB204"), 1u);
}

TEST(ReadCityJson, TemplatesStandAtTheirAnchorTurnedByTheirMatrix) {
    const std::string more =
        R"("geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,0,2]]},)";
    const std::string tree =
        R"("t":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[6],"transformationMatrix":[0,-1,0,10,1,0,0,0,0,0,1,0,0,0,0,1]}]})";
    const LoadedCity city = load_text(document(tree, kCubeVertices, more));
    // Anchor (1, 1, 1), a quarter turn to the left, ten metres to the east: (1, 0, 0) comes to (11, 2, 1).
    const Geometry& g = city.city.objects[0].geometry;
    ASSERT_EQ(g.vertices.size(), 3u);
    EXPECT_THAT(g.vertices, testing::UnorderedElementsAre(Vec3d(11, 1, 1), Vec3d(11, 2, 1), Vec3d(11, 1, 3)));
    EXPECT_EQ(g.surfaces[0].type, SurfaceType::vegetation);
    const std::string bad =
        R"("t":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance","template":5,"boundaries":[6]}]})";
    EXPECT_EQ(load_text(document(bad, kCubeVertices, more)).findings.count("SB111"), 1u);
}

TEST(ReadCityJson, TexturesFollowTheirCornersAndStayInTheFolder) {
    const std::string more =
        R"("appearance":{"textures":[{"image":"t/a.png","wrapMode":"mirror"},{"image":"../secret.png"},{"image":"gone.png"},{"image":"http://x/y.png"}],"vertices-texture":[[0,0],[2,0],[2,1],[0,1]]},)";
    const std::string textured =
        R"({"type":"MultiSurface","lod":"2","texture":{"x":{"values":[[[0,0,1,2,3]],[[2,0,1,2,3]],[[0,0,1]],[[null]]]}},"boundaries":[[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]]]})";
    const TemporaryFolder folder;
    folder.write("t/a.png", "x");
    const LoadedCity city = load(folder.write("a.city.json", document(building(textured), kCubeVertices, more)));
    ASSERT_EQ(city.city.textures.size(), 4u);
    EXPECT_FALSE(city.city.textures[0].is_missing);
    EXPECT_EQ(city.city.textures[0].wrap, TextureWrap::mirror);
    EXPECT_EQ(city.findings.count("SB402"), 1u);
    EXPECT_EQ(city.findings.count("SB401"), 2u);
    EXPECT_EQ(city.findings.count("SB403"), 1u);
    const Geometry& g = city.city.objects[0].geometry;
    ASSERT_EQ(g.surfaces.size(), 4u);
    EXPECT_TRUE(g.surfaces[0].texture.has_value());
    EXPECT_FALSE(g.surfaces[2].texture.has_value());
    EXPECT_FALSE(g.surfaces[3].texture.has_value());
    for (std::uint32_t c = g.ring_first[0]; c < g.ring_first[1]; ++c) {
        const Vec3d& p = g.vertices[g.corners[c]];
        EXPECT_EQ(g.corner_uv[c], Vec2f(2.0f * static_cast<float>(p.x), static_cast<float>(p.y)));
    }
}

TEST(ReadCityJson, MaterialsAreLinearAndShared) {
    const std::string more =
        R"("appearance":{"materials":[{"name":"a","diffuseColor":[0.5,0.5,0.5]},{"name":"b","diffuseColor":[0.5,0.5,0.5]},{"name":"c","diffuseColor":[2,0,0],"transparency":0.5}]},)";
    const LoadedCity city = load_text(
        document(building(solid("2", R"("material":{"m":{"values":[[0,1,2,null,0,9]]}},)")), kCubeVertices, more));
    EXPECT_EQ(city.city.materials.size(), 2u) << "equal colours are one material";
    EXPECT_NEAR(city.city.materials[0].albedo.x, 0.2140f, 1e-4f);  // IEC 61966-2-1 of 0.5
    EXPECT_EQ(city.findings.count("SB404"), 1u);
    EXPECT_EQ(city.findings.count("SB405"), 1u);
    EXPECT_EQ(city.findings.count("SB406"), 1u);
    const Geometry& g = city.city.objects[0].geometry;
    EXPECT_EQ(g.surfaces[0].material, g.surfaces[1].material);
    EXPECT_FALSE(g.surfaces[3].material.has_value());
    EXPECT_FALSE(g.surfaces[5].material.has_value());
}

TEST(ReadCityJson, IdsTwiceUnknownTypesAndInteriorsAreTold) {
    const std::string moved = R"({"type":"MultiSurface","lod":"2","boundaries":[[[4,5,6,7]]]})";
    const LoadedCity city = load_text(
        document(building(solid()) + "," + building(moved) + "," + building(solid()) +
                 R"(,"n":{"type":"+Noise","geometry":[)" + moved + R"(]},"g":{"type":"Gnome","geometry":[)" + moved +
                 R"(]},"r":{"type":"BuildingRoom","parents":["nobody"],"geometry":[)" + solid() + "]}"));
    EXPECT_EQ(city.findings.count("SB104"), 2u);
    EXPECT_EQ(city.findings.count("SB105"), 1u);
    EXPECT_EQ(city.findings.count("SB106"), 1u);
    EXPECT_EQ(city.findings.count("SB110"), 1u);
    EXPECT_EQ(city.findings.count("SB115"), 1u);
    EXPECT_EQ(city.city.objects.size(), 5u);
    EXPECT_EQ(city.city.objects[1].id, "b#2");
}

TEST(ReadCityJson, KeysWithEscapesAndOtherScriptsKeepTheirText) {
    const LoadedCity city =
        load_text(document(building(solid(), "\\u6771\\u4eac \\\"1\\\"") + "," + building(solid(), "東京")));
    ASSERT_EQ(city.city.objects.size(), 2u);
    EXPECT_EQ(city.city.objects[0].id, "東京 \"1\"");
    EXPECT_EQ(city.city.objects[1].id, "東京");
}

TEST(ReadCityJson, SeveralFilesMakeOneCity) {
    const TemporaryFolder folder;
    const std::vector<std::filesystem::path> files{folder.write("a.json", document(building(solid(), "a"))),
                                                   folder.write("b.json", document(building(solid(), "b"))),
                                                   folder.write("c.json", document(building(solid(), "a")))};
    SilentProgress progress;
    const LoadedCity city = load_city(files, {}, progress);
    EXPECT_EQ(city.city.objects.size(), 2u) << "the third file repeats the first";
    EXPECT_EQ(city.inputs.size(), 3u);
    EXPECT_NE(city.inputs[0].hash, city.inputs[1].hash);
    EXPECT_EQ(city.findings.count("SB104"), 1u);
}

TEST(LoadCity, GroundIsAddedOnRequestOnly) {
    EXPECT_EQ(load_text(document(building(solid()))).findings.count("SB501"), 1u);
    const LoadedCity plane = load_text(document(building(solid())), {std::nullopt, GroundChoice::plane, 30.0});
    ASSERT_EQ(plane.city.objects.size(), 2u);
    EXPECT_EQ(plane.city.objects[1].id, "skybake-ground");
    EXPECT_EQ(extent_of(plane.city).lo, Vec3d(-30, -30, -0.01));
    EXPECT_EQ(extent_of(plane.city).hi, Vec3d(31, 31, 1));
    EXPECT_FALSE(plane.has_own_ground);
    const LoadedCity draped = load_text(document(building(solid())), {std::nullopt, GroundChoice::draped, 30.0});
    double area = 0.0;  // the draped triangles cover the square of 61 m once
    const Geometry& g = draped.city.objects[1].geometry;
    for (std::uint32_t r = 0; r + 1 < g.ring_first.size(); ++r) {
        const Vec3d a = g.vertices[g.corners[3 * r]], b = g.vertices[g.corners[3 * r + 1]],
                    c = g.vertices[g.corners[3 * r + 2]];
        EXPECT_GT(glm::cross(b - a, c - a).z, 0.0);
        area += 0.5 * glm::cross(b - a, c - a).z;
    }
    EXPECT_NEAR(area, 61.0 * 61.0, 1e-6);
}

/// The draped ground's height above (x, y).
double height_at(const Geometry& g, double x, double y) {
    for (std::uint32_t r = 0; r + 1 < g.ring_first.size(); ++r) {
        const Vec3d a = g.vertices[g.corners[3 * r]], ab = g.vertices[g.corners[3 * r + 1]] - a,
                    ac = g.vertices[g.corners[3 * r + 2]] - a;
        const double det = ab.x * ac.y - ab.y * ac.x;
        const double u = ((x - a.x) * ac.y - (y - a.y) * ac.x) / det, v = (ab.x * (y - a.y) - ab.y * (x - a.x)) / det;
        if (u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9) return a.z + u * ab.z + v * ac.z;
    }
    return NAN;
}

TEST(LoadCity, DrapedGroundMeetsTheFootOfALongWall) {
    // A house of 60 m × 4 m that stands at 2 m, and low ones of 2 m on both sides of its middle at 0 m.
    std::string vertices, objects;
    int first = 0;
    const auto add = [&](double x, double y, double wide, double deep, double z) {
        for (const double up : {0.0, 5.0}) {
            for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
                vertices += std::string(vertices.empty() ? "[" : ",[") +
                            std::to_string(std::llround(1000 * (x + i * wide))) + "," +
                            std::to_string(std::llround(1000 * (y + j * deep))) + "," +
                            std::to_string(std::llround(1000 * (z + up))) + "]";
        }
        std::string shell;
        for (const auto& f : {std::array{0, 3, 2, 1}, std::array{4, 5, 6, 7}, std::array{0, 1, 5, 4},
                              std::array{1, 2, 6, 5}, std::array{2, 3, 7, 6}, std::array{3, 0, 4, 7}}) {
            shell += shell.empty() ? "[[" : ",[[";
            for (int k = 0; k < 4; ++k)
                shell += (k > 0 ? "," : "") + std::to_string(first + f[static_cast<std::size_t>(k)]);
            shell += "]]";
        }
        objects +=
            (objects.empty() ? "" : ",") +
            building(R"({"type":"Solid","lod":"1","boundaries":[[)" + shell + "]]}", "b" + std::to_string(first));
        first += 8;
    };
    add(0, 0, 60, 4, 2);
    add(29, 6, 2, 2, 0);
    add(29, -4, 2, 2, 0);
    const LoadedCity draped =
        load_text(document(objects, "[" + vertices + "]"), {std::nullopt, GroundChoice::draped, 30.0});
    ASSERT_EQ(draped.city.objects.back().id, "skybake-ground");
    for (double x = 0.0; x <= 60.0; x += 0.5) {
        for (const double y : {0.0, 4.0})
            EXPECT_NEAR(height_at(draped.city.objects.back().geometry, x, y), 2.0, 1e-6) << x;
    }
}

}  // namespace
}  // namespace skybake
