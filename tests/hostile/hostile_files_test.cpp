// Files that want to do harm, in every format that can: an error or a finding, soon, and nothing else. CityGML and
// CityJSON have more of their own beside their readers' tests.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include "citygml/gml_text.h"
#include "error_of.h"
#include "gltf/gltf_maker.h"

namespace skybake {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class HostileFiles : public testing::Test {
  protected:
    ~HostileFiles() override { EXPECT_LT((std::clock() - begun_) / CLOCKS_PER_SEC, 60) << "seconds of processor"; }
    std::string error_of_file(const std::string& name, const std::string& text) const {
        return error_of([&] { load(folder_.write(name, text)); });
    }
    TemporaryFolder folder_;

  private:
    std::clock_t begun_ = std::clock();
};

std::string repeated(const std::string& text, std::size_t times) {
    std::string all;
    for (std::size_t i = 0; i < times; ++i) all += text;
    return all;
}

/// A strip of `triangles` triangles.
GltfMaker strip_asset(std::size_t triangles) {
    GltfMaker maker;
    std::vector<float> places;
    for (std::size_t i = 0; i < triangles + 2; ++i)
        for (const float v : {static_cast<float>(i / 2), 0.0f, static_cast<float>(i % 2)}) places.push_back(v);
    maker.mesh({{"mode", 5}, {"attributes", {{"POSITION", maker.floats(places, "VEC3")}}}});
    return maker;
}

// What a billion laughs is in formats without entities: a shape, named a great many times.
TEST_F(HostileFiles, RepeatedShapesEndBeforeTheMemoryDoes) {
    constexpr std::size_t kShape = 20'000, kTimes = 10'000;
    const auto all_of = [](const char* name) {
        return AllOf(HasSubstr(name), HasSubstr("repeats its shapes until they have more than"));
    };
    {
        GltfMaker maker = strip_asset(kShape);
        for (std::size_t i = 0; i < kTimes; ++i) maker.json["nodes"].push_back({{"mesh", 0}});
        EXPECT_THAT(error_of_file("a.glb", maker.glb()), all_of("a.glb"));
    }
    {
        GltfMaker maker = strip_asset(kShape);
        const int places = maker.floats(std::vector<float>(3 * kTimes, 1.0f), "VEC3");
        maker.json["nodes"].push_back(
            {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
        EXPECT_THAT(error_of_file("b.glb", maker.glb()), all_of("b.glb"));
    }
    const std::string templates =
        R"("geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[)" +
        repeated("[[0,1,2]],", kShape) + R"([[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,0,2]]},)";
    const auto tree = [](std::size_t i) {
        return fmt::format(
            R"("t{}":{{"type":"SolitaryVegetationObject","geometry":[{{"type":"GeometryInstance","template":0,"boundaries":[0],"transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}}]}})",
            i);
    };
    std::string trees;
    for (std::size_t i = 0; i < kTimes; ++i) (trees += i > 0 ? "," : "") += tree(i);
    EXPECT_THAT(error_of_file("c.city.json", document(trees, kCubeVertices, templates)), all_of("c.city.json"));
    {
        // Of a sequence each line is a part: lines are left out when there is too much.
        std::string lines =
            R"({"type":"CityJSON","version":"2.0",)" + templates + kTransform + R"(,"CityObjects":{},"vertices":[]})";
        for (std::size_t i = 0; i < kTimes; ++i)
            lines += "\n{\"type\":\"CityJSONFeature\",\"id\":\"t\",\"CityObjects\":{" + tree(i) +
                     R"(},"vertices":[[0,0,0]]})";
        EXPECT_GT(load(folder_.write("d.city.jsonl", lines)).findings.count("SB119"), 0u);
    }
    {
        std::string shape = "<gml:MultiSurface gml:id=\"s\">";
        for (std::size_t i = 0; i < kShape; ++i) shape += surface_member(polygon(kFaces[i % 6]));
        const auto plant = [](const std::string& geometry) {
            return member(
                "<veg:SolitaryVegetationObject><veg:lod2ImplicitRepresentation><ImplicitGeometry>" + geometry +
                "<referencePoint><gml:Point><gml:pos>0 0 0</gml:pos></gml:Point></referencePoint></ImplicitGeometry>"
                "</veg:lod2ImplicitRepresentation></veg:SolitaryVegetationObject>");
        };
        const std::string first = plant("<relativeGMLGeometry>" + shape + "</gml:MultiSurface></relativeGMLGeometry>");
        const std::string others = repeated(plant("<relativeGMLGeometry xlink:href=\"#s\"/>"), kTimes);
        EXPECT_THAT(error_of_file("e.gml", gml_document(first + others)), all_of("e.gml"));
    }
}

TEST_F(HostileFiles, TheSameBytesAgainAndAgain) {
    // A thousand materials that show one picture of a megabyte by a thousand names hold it once, or are refused it.
    GltfMaker maker = cube_asset();
    const int view = maker.view(std::vector<std::uint8_t>(1u << 20, 0x89));
    for (int i = 0; i < 1000; ++i) {
        maker.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
        maker.json["textures"].push_back({{"source", i}});
        maker.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    }
    EXPECT_GE(load(folder_.write("a.glb", maker.glb())).findings.count("SB404"), 990u);
    for (int i = 0; i < 1000; ++i) maker.json["textures"][static_cast<std::size_t>(i)]["source"] = 0;
    EXPECT_EQ(load(folder_.write("b.glb", maker.glb())).findings.count("SB404"), 0u) << "once is right";
    // One library, named on each of 100,000 lines.
    std::string library;
    for (int i = 0; i < 2000; ++i) library += fmt::format("newmtl m{}\nKd 1 1 1\n", i);
    folder_.write("a.mtl", library);
    const LoadedCity obj = load(folder_.write(
        "a.obj", repeated("mtllib a.mtl\n", 100'000) + "usemtl m1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    EXPECT_EQ(obj.summary.surfaces, 1u);
}

TEST_F(HostileFiles, DeepNests) {
    const std::string deep(1'000'000, '[');
    const std::string closed = deep + std::string(1'000'000, ']');
    for (const std::string& nest : {deep, closed}) {
        EXPECT_THAT(error_of_file("a.gltf", R"({"asset":{"version":"2.0"},"nodes":)" + nest + "}"),
                    nest == deep ? HasSubstr("a.gltf") : HasSubstr("no error"));
        EXPECT_THAT(error_of_file("a.geojson", R"({"type":"FeatureCollection","features":)" + nest + "}"),
                    HasSubstr("a.geojson"));
        const std::string polygon =
            R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":3},"geometry":{"type":"Polygon","coordinates":)" +
            nest + "}}]}";
        EXPECT_THAT(error_of_file("b.geojson", polygon), HasSubstr("b.geojson"));
        const std::string header =
            R"({"type":"CityJSON","version":"2.0",)" + kTransform + R"(,"CityObjects":{},"vertices":[]})" + "\n";
        const LoadedCity sequence = load(folder_.write(
            "a.city.jsonl", header + R"({"type":"CityJSONFeature","id":"a","vertices":)" + nest + "}\n" + "{}\n"));
        EXPECT_EQ(sequence.findings.count("SB119"), 2u);
    }
}

TEST_F(HostileFiles, HugeCounts) {
    const auto with = [](const std::string& path, const nlohmann::json& value) {
        GltfMaker maker = cube_asset();
        maker.json[nlohmann::json::json_pointer(path)] = value;
        return maker;
    };
    for (const std::uint64_t huge : {1ull << 31, 1ull << 32, 1ull << 63, ~0ull}) {
        for (const char* path :
             {"/accessors/0/count", "/accessors/0/byteOffset", "/accessors/1/count", "/bufferViews/0/byteLength",
              "/bufferViews/0/byteOffset", "/bufferViews/1/byteStride", "/nodes/0/mesh",
              "/meshes/0/primitives/0/material", "/meshes/0/primitives/0/indices"}) {
            const LoadedCity city = load(folder_.write("a.glb", with(path, huge).glb()));
            EXPECT_EQ(city.summary.surfaces, 0u) << path << ' ' << huge;
            EXPECT_EQ(city.findings.count("SB101"), 1u) << path << ' ' << huge;
        }
        GltfMaker maker = cube_asset();
        maker.json["accessors"][0].erase("bufferView");  // zeros, as many as it says
        maker.json["accessors"][0]["count"] = huge;
        EXPECT_EQ(load(folder_.write("a.glb", maker.glb())).findings.count("SB101"), 1u);
        GltfMaker packed = cube_asset();
        packed.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
            {"buffer", 0}, {"byteLength", 96}, {"byteStride", 12}, {"count", huge}, {"mode", "ATTRIBUTES"}};
        EXPECT_EQ(load(folder_.write("a.glb", packed.glb())).findings.count("SB101"), 1u);
    }
    // Lengths in the heads of GLB and b3dm: the file's, the first chunk's; the tables'.
    const std::string glb = cube_asset().glb();
    const std::string most = "\xff\xff\xff\xff";
    for (const std::size_t at : {8u, 12u}) {
        std::string text = glb;
        text.replace(at, 4, most);
        EXPECT_THAT(error_of_file("a.glb", text), HasSubstr("beyond the end")) << at;
    }
    for (const std::size_t at : {12u, 16u, 20u, 24u}) {
        std::string text = "b3dm" + GltfMaker::little_endian(1) + std::string(20, '\0') + glb;
        text.replace(at, 4, most);
        EXPECT_THAT(error_of_file("a.b3dm", text), HasSubstr("beyond the end")) << at;
    }
    for (const char* index : {"9223372036854775807", "-9223372036854775808", "99999999999999999999", "0", "-4"})
        EXPECT_EQ(load(folder_.write("a.obj", fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {}\n", index)))
                      .findings.count("SB103"),
                  1u)
            << index;
    for (const char* size : {"2147483647", "100000", "4294967297", "-1", "1e9"}) {
        EXPECT_THAT(
            error_of_file("a.asc",
                          fmt::format("ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", size, size)),
            HasSubstr("a.asc"))
            << size;
    }
}

/// A TIFF of 32-bit floats with a place, one strip that is not there: a header and nothing.
std::string empty_tiff(std::uint32_t side) {
    const auto u16 = [](std::uint32_t v) { return GltfMaker::little_endian(v).substr(0, 2); };
    const auto u32 = GltfMaker::little_endian;
    std::string entries;
    std::uint32_t count = 0;
    const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t n, std::uint32_t value) {
        entries += u16(tag) + u16(type) + u32(n) + u32(value);
        ++count;
    };
    constexpr std::uint32_t kShort = 3, kLong = 4, kDouble = 12, kPixelScale = 300, kTiepoint = 324;
    entry(256, kLong, 1, side);
    entry(257, kLong, 1, side);
    entry(258, kShort, 1, 32);
    entry(259, kShort, 1, 1);
    entry(262, kShort, 1, 1);
    entry(273, kLong, 1, 0);
    entry(277, kShort, 1, 1);
    entry(278, kLong, 1, side);
    entry(279, kLong, 1, 0);
    entry(339, kShort, 1, 3);
    entry(33550, kDouble, 3, kPixelScale);
    entry(33922, kDouble, 6, kTiepoint);
    std::string text = std::string("II*\0", 4) + u32(8) + u16(count) + entries + u32(0);
    text.resize(kPixelScale, '\0');
    const double numbers[9] = {1, 1, 0, 0, 0, 0, 1000, 2000, 0};
    text.append(reinterpret_cast<const char*>(numbers), sizeof(numbers));
    return text;
}

TEST_F(HostileFiles, RastersThatAreHeadersAndNothing) {
    EXPECT_THAT(error_of_file("a.tif", empty_tiff(100'000)), HasSubstr("100000 x 100000 cells"));
    EXPECT_THAT(error_of_file("a.tif", empty_tiff(16'000)), HasSubstr("nearly all of it must be empty"));
    EXPECT_EQ(error_of_file("a.tif", empty_tiff(100)), "no error") << "sparse, and zero";
}

TEST_F(HostileFiles, NodesInCircles) {
    GltfMaker maker = cube_asset();
    maker.json["nodes"] = {{{"children", {1}}}, {{"children", {0, 2}}}, {{"mesh", 0}, {"children", {2, 2, 99}}}};
    maker.json["scenes"] = {{{"nodes", {0}}}};
    const LoadedCity loaded = load(folder_.write("a.glb", maker.glb()));
    EXPECT_EQ(loaded.summary.surfaces, 12u) << "each node once";
    EXPECT_EQ(loaded.findings.count("SB101"), 4u) << "three children that are parents, and one that is not there";
}

TEST_F(HostileFiles, GroupsInCircles) {
    const std::string groups = R"("a":{"type":"CityObjectGroup","children":["b","a"],"parents":["b"]},)"
                               R"("b":{"type":"CityObjectGroup","children":["a"],"parents":["a"]},)";
    EXPECT_EQ(load_text(document(groups + building(solid(), "c", R"("parents":["a","c"],)"))).summary.surfaces, 6u);
    const auto group = [](const std::string& id, const std::string& of) {
        return member("<grp:CityObjectGroup gml:id=\"" + id + "\"><grp:groupMember xlink:href=\"#" + of +
                      "\"/></grp:CityObjectGroup>");
    };
    const std::string part = "<bldg:consistsOfBuildingPart xlink:href=\"#b\"/>";  // of itself
    const LoadedCity city = load_gml(
        gml_document(group("g", "h") + group("h", "g") +
                     gml_building(part + "<bldg:lod2Solid>" + gml_solid(cube_members()) + "</bldg:lod2Solid>")));
    EXPECT_EQ(city.summary.surfaces, 6u);
}

// A secret beside the folder, reached by name, from the root, and by a link that an archive may bring.
TEST_F(HostileFiles, PathsStayInTheirFolder) {
    const std::filesystem::path secret = folder_.write("secret.png", "s");
    const auto place = folder_.write("city/here.png", "h").parent_path();
    std::filesystem::create_symlink(secret, place / "link.png");
    std::filesystem::create_directory_symlink("..", place / "up");
    std::filesystem::create_symlink("here.png", place / "inside.png");
    const auto found = [&](const std::string& name, const std::string& text) {
        const LoadedCity city = load(folder_.write("city/" + name, text));
        EXPECT_EQ(city.city.textures.size(), 1u) << name;
        if (!city.city.textures.empty() && !city.city.textures[0].is_missing) return std::string("found");
        return std::string(city.findings.count("SB402") > 0 ? "refused" : "missing");
    };
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"here.png", "found"},         {"./x/../here.png", "found"},      {"inside.png", "found"},
        {"../secret.png", "refused"},  {"x/../../secret.png", "refused"}, {"..\\\\secret.png", "refused"},
        {secret.string(), "refused"},  {"link.png", "refused"},           {"up/secret.png", "refused"},
        {"up/city/here.png", "found"},  // out and back in: it is inside
    };
    for (const auto& [uri, expected] : cases) {
        const std::string plain = uri == "..\\\\secret.png" ? "..\\secret.png" : uri;  // JSON escapes backslashes
        const std::string textured =
            R"({"type":"MultiSurface","lod":"2","texture":{"x":{"values":[[[0,0,1,2,3]]]}},"boundaries":[[[4,5,6,7]]]})";
        const std::string images =
            R"("appearance":{"textures":[{"image":")" + uri + R"("}],"vertices-texture":[[0,0],[2,0],[2,1],[0,1]]},)";
        EXPECT_EQ(found("a.city.json", document(building(textured), kCubeVertices, images)), expected) << uri;
        GltfMaker maker = cube_asset();
        maker.json["images"] = {{{"uri", plain}}};
        maker.json["textures"] = {{{"source", 0}}};
        maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        EXPECT_EQ(found("a.glb", maker.glb()), expected) << uri;
        EXPECT_EQ(
            found("a.gml",
                  gml_document(gml_building("<bldg:lod2Solid>" + gml_solid(cube_members()) + "</bldg:lod2Solid>") +
                               "<app:appearanceMember><app:Appearance><app:surfaceDataMember><app:ParameterizedTexture>"
                               "<app:imageURI>" +
                               plain +
                               "</app:imageURI></app:ParameterizedTexture></app:surfaceDataMember></app:Appearance>"
                               "</app:appearanceMember>")),
            expected)
            << uri;
        folder_.write("city/a.mtl", "newmtl m\nmap_Kd " + plain + "\n");
        EXPECT_EQ(found("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), expected) << uri;
    }
    // Material libraries and buffers.
    folder_.write("secret.mtl", "newmtl m\n");
    folder_.write("secret.bin", "12345678");
    std::filesystem::create_symlink("../secret.mtl", place / "link.mtl");
    std::filesystem::create_symlink("../secret.bin", place / "link.bin");
    for (const char* uri : {"../secret.mtl", "link.mtl", "up/secret.mtl"})
        EXPECT_EQ(load(folder_.write("city/a.obj", fmt::format("mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", uri)))
                      .findings.count("SB402"),
                  1u)
            << uri;
    for (const char* uri : {"../secret.bin", "%2e%2e/secret.bin", "link.bin", "up/secret.bin", "file:///etc/passwd"}) {
        GltfMaker maker = cube_asset();
        maker.json["buffers"] = {{{"uri", uri}, {"byteLength", 8}}};
        EXPECT_THAT(error_of_file("city/a.gltf", maker.json.dump()), HasSubstr("outside the file's folder")) << uri;
    }
}

}  // namespace
}  // namespace skybake
