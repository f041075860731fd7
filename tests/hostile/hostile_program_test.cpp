// The program as a user runs it, on files that want its memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "gltf/gltf_maker.h"
#include "program/run_program.h"

namespace skybake {
namespace {

using testing::HasSubstr;

/// The head of a PNG of 100,000 × 100,000 pixels in 16-bit RGBA, 80 GB, and an end: by RFC 2083. Its first sum is
/// right.
std::string huge_png() {
    using std::string_literals::operator""s;
    return "\x89PNG\r\n\x1a\n"s + "\0\0\0\x0dIHDR\0\x01\x86\xa0\0\x01\x86\xa0\x10\x06\0\0\0\xf8\xc2\xd7\x8b"s +
           "\0\0\0\x02IDAT\x78\x9c\x62\xa4\x91\x2b"s + "\0\0\0\0IEND\xae\x42\x60\x82"s;
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

TEST(HostileProgram, APictureOfTenThousandMillionPixels) {
    const TemporaryFolder folder;
    write(folder / "huge.png", huge_png());
    write(folder / "a.mtl", "newmtl m\nmap_Kd huge.png\n");
    write(folder / "a.obj",
          "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 9 0 0\nv 9 9 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    write(
        folder / "a.city.json",
        R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},"appearance":{"textures":[{"image":"huge.png"}],"vertices-texture":[[0,0],[1,0],[1,1]]},"CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]],"texture":{"t":{"values":[[[0,0,1,2]]]}}}]}},"vertices":[[0,0,0],[9,0,0],[9,9,0]]})");
    const auto gml = [](const std::string& data) {
        return R"(<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:gml="http://www.opengis.net/gml" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:app="http://www.opengis.net/citygml/appearance/2.0"><app:appearanceMember><app:Appearance><app:surfaceDataMember>)" +
               data +
               R"(</app:surfaceDataMember></app:Appearance></app:appearanceMember><cityObjectMember><bldg:Building><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:Polygon gml:id="p"><gml:exterior><gml:LinearRing gml:id="r"><gml:posList>0 0 0 9 0 0 9 9 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:Building></cityObjectMember></CityModel>)";
    };
    write(
        folder / "a.gml",
        gml(R"(<app:ParameterizedTexture><app:imageURI>huge.png</app:imageURI><app:target uri="#p"><app:TexCoordList><app:textureCoordinates ring="#r">0 0 1 0 1 1 0 0</app:textureCoordinates></app:TexCoordList></app:target></app:ParameterizedTexture>)"));
    write(
        folder / "b.gml",
        gml(R"(<app:GeoreferencedTexture><app:imageURI>huge.png</app:imageURI><app:target>#p</app:target></app:GeoreferencedTexture>)"));
    write(folder / "huge.pgw", "0.001\n0\n0\n-0.001\n0\n9\n");
    GltfMaker maker = cube_asset();
    const std::string png = huge_png();
    maker.json["images"] = {{{"bufferView", maker.view(std::vector<char>(png.begin(), png.end()))}}};
    maker.json["textures"] = {{{"source", 0}}};
    maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    maker.json["meshes"][0]["primitives"][0]["material"] = 0;
    maker.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = maker.floats(std::vector<float>(16), "VEC2");
    write(folder / "a.glb", maker.glb());
    for (const char* name : {"a.obj", "a.city.json", "a.gml", "b.gml", "a.glb"}) {
        Running program(folder, {"bake", folder.str(name), "--texel", "1", "--sky", "uniform:luminance=1000", "--sun",
                                 "none", "--indirect", "photons", "--photons", "1000", "-o", folder.str("lit")});
        EXPECT_EQ(program.exit_code(std::chrono::seconds(60)), 0) << name << ": " << program.err();
        EXPECT_THAT(program.err(), HasSubstr("100000 x 100000 pixels are more than")) << name;
        EXPECT_THAT(program.err(), HasSubstr("SB408")) << name;
    }
}

TEST(HostileProgram, TooLittleMemoryIsAnError) {
    // 3,000 instances of 10,000 triangles are nothing that is refused, but more than the 200 MB that this shell gives.
    const TemporaryFolder folder;
    GltfMaker maker;
    std::vector<float> places;
    for (int i = 0; i < 10'002; ++i)
        for (const float v : {static_cast<float>(i / 2), 0.0f, static_cast<float>(i % 2)}) places.push_back(v);
    maker.mesh({{"mode", 5}, {"attributes", {{"POSITION", maker.floats(places, "VEC3")}}}});
    for (int i = 0; i < 1'500; ++i) maker.json["nodes"].push_back({{"mesh", 0}});
    write(folder / "a.glb", maker.glb());
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_DATA, &limit), 0);
    const rlim_t before = limit.rlim_cur;
    limit.rlim_cur = 200'000'000;
    ASSERT_EQ(setrlimit(RLIMIT_DATA, &limit), 0);
    Running program(folder, {"check", folder.str("a.glb"), "--threads", "1"});  // inherits the bound
    limit.rlim_cur = before;
    ASSERT_EQ(setrlimit(RLIMIT_DATA, &limit), 0);
    EXPECT_EQ(program.exit_code(std::chrono::seconds(60)), 2);
    EXPECT_THAT(program.err(), HasSubstr("out of memory"));
}

}  // namespace
}  // namespace skybake
