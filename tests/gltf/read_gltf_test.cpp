// glTF, GLB, b3dm: assets of a few triangles, made here, and the real files. Truth: the glTF 2.0 specification and its
// extensions, the libraries' own encoders, and DATA.md.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "cityjson/temporary_city.h"
#include "error_of.h"
#include "gltf_maker.h"
#include "io/image/image.h"
#include "test_data.h"

namespace skybake {
namespace {

using testing::HasSubstr;

LoadedCity load_asset(const std::string& bytes, const std::string& name = "a.glb") {
    const TemporaryFolder folder;
    return load(folder.write(name, bytes));
}
std::string error_of(const std::string& bytes, const std::string& name = "a.glb") {
    return skybake::error_of([&] { load_asset(bytes, name); });
}
void expect_cube(const LoadedCity& loaded, const Vec3d& lo, const Vec3d& hi) {
    ASSERT_EQ(loaded.city.objects.size(), 1u);
    EXPECT_EQ(loaded.city.objects[0].geometry.surfaces.size(), 12u);
    EXPECT_EQ(loaded.findings.count("SB207"), 0u) << "all faces run outward";
    EXPECT_LT(glm::distance(extent_of(loaded.city).lo, lo), 1e-4);
    EXPECT_LT(glm::distance(extent_of(loaded.city).hi, hi), 1e-4);
}

TEST(ReadGltf, ACubeStandsUprightAndGetsItsTypesBySlope) {
    // Up is y: what reaches from 0 to 1 in z there reaches from -1 to 0 in y here.
    for (const auto& [bytes, name] :
         {std::pair(cube_asset().glb(), "a.glb"), std::pair(cube_asset().gltf(), "a.gltf")}) {
        const LoadedCity loaded = load_asset(bytes, name);
        expect_cube(loaded, {0, -1, 0}, {1, 0, 1});
        EXPECT_EQ(loaded.city.objects[0].id, "cube");
        std::map<SurfaceType, int> counts;
        for (const Surface& s : loaded.city.objects[0].geometry.surfaces) ++counts[s.type];
        EXPECT_EQ(counts[SurfaceType::roof], 2);
        EXPECT_EQ(counts[SurfaceType::ground], 2);
        EXPECT_EQ(counts[SurfaceType::wall], 8);
    }
}

TEST(ReadGltf, UpAndOriginAsAsked) {
    const TemporaryFolder folder;
    LoadOptions options;
    options.placement = {io::UpAxis::z, {100, 200, 300}};
    const LoadedCity loaded = load(folder.write("a.glb", cube_asset().glb()), options);
    expect_cube(loaded, {100, 200, 300}, {101, 201, 301});
}

TEST(ReadGltf, NodesCarryTheirMeshes) {
    GltfMaker maker = cube_asset();
    // Ten to the right, then twice as large and turned by 90° about y (z to x, x to -z).
    maker.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                           {{"mesh", 0}, {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}, {"scale", {2, 2, 2}}}};
    // In glTF: x 10…12, y 0…2, z -2…0; here y = -z.
    expect_cube(load_asset(maker.glb()), {10, 0, 0}, {12, 2, 2});
    // A mirror turns triangles inside out; they are turned back.
    maker.json["nodes"] = {{{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
    expect_cube(load_asset(maker.glb()), {-1, -1, 0}, {0, 0, 1});
}

TEST(ReadGltf, StripsAndFansAreTheTrianglesOfTheirLists) {
    const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 0, -1, 1, 0, -1, 0, 0, -2, 1, 0, -2};
    const auto load_mode = [&](int mode, const std::vector<std::uint16_t>& indices) {
        GltfMaker maker;
        const int positions = maker.floats(corners, "VEC3");
        maker.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", maker.indices(indices)}, {"mode", mode}});
        maker.json["nodes"].push_back({{"mesh", 0}});
        return load_asset(maker.glb());
    };
    const LoadedCity list = load_mode(4, {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4});
    for (const LoadedCity& other : {load_mode(5, {0, 1, 2, 3, 4, 5}), load_mode(5, {0, 1, 2, 3, 3, 2, 2, 3, 4, 5})}) {
        ASSERT_EQ(other.city.objects.size(), 1u);
        const Geometry &a = list.city.objects[0].geometry, &b = other.city.objects[0].geometry;
        ASSERT_EQ(a.surfaces.size(), 4u);
        ASSERT_EQ(b.surfaces.size(), 4u);
        for (const Geometry* g : {&a, &b}) {
            for (std::size_t i = 0; i < 4; ++i) {
                const Vec3d p = g->vertices[g->corners[3 * i]], q = g->vertices[g->corners[3 * i + 1]],
                            r = g->vertices[g->corners[3 * i + 2]];
                EXPECT_GT(glm::cross(q - p, r - p).z, 0.0) << "faces up";
            }
        }
        EXPECT_EQ(other.findings.count("SB207"), 0u);
    }
    EXPECT_EQ(load_mode(6, {0, 1, 3, 2}).city.objects[0].geometry.surfaces.size(), 2u);
    EXPECT_EQ(load_mode(1, {0, 1}).findings.count("SB102"), 1u);
}

TEST(ReadGltf, EmbeddedPicturesAndTheirTransform) {
    GltfMaker maker;
    const int positions = maker.floats({0, 0, 0, 1, 0, 0, 1, 0, -1}, "VEC3");
    const int uvs = maker.floats({0, 0, 1, 0, 1, 1}, "VEC2");
    io::Image8 image{2, 1, 3, {255, 0, 0, 0, 255, 0}};
    const int view = maker.view(io::encode_png(image));
    maker.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
    maker.json["samplers"] = {{{"wrapS", 33071}}};
    maker.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    maker.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0.5}}, {"scale", {0.5, 2.0}}}}}}}}}}}};
    maker.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"material", 0}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    const LoadedCity loaded = load_asset(maker.glb());
    ASSERT_EQ(loaded.city.textures.size(), 1u);
    EXPECT_EQ(loaded.city.textures[0].wrap, TextureWrap::clamp);
    EXPECT_FALSE(loaded.city.textures[0].is_missing);
    EXPECT_EQ(io::read_image(loaded.city.textures[0]).pixels, image.pixels);
    const Geometry& g = loaded.city.objects[0].geometry;
    ASSERT_EQ(g.corner_uv.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d p = g.vertices[g.corners[i]];
        // u = x, v = y of the file; transformed, and counted from below: (0.25 + 0.5 u, 1 - (0.5 + 2 v)).
        EXPECT_FLOAT_EQ(g.corner_uv[i].x, static_cast<float>(0.25 + 0.5 * p.x));
        EXPECT_FLOAT_EQ(g.corner_uv[i].y, static_cast<float>(0.5 - 2.0 * p.y));
    }
}

TEST(ReadGltf, BaseColourIsLinearAndVertexColoursMultiplyIt) {
    GltfMaker maker;
    const int positions = maker.floats({0, 0, 0, 1, 0, 0, 1, 0, -1}, "VEC3");
    const int colors = maker.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.6, 0.3, 0.9, 1}}}}}};
    maker.mesh({{"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}, {"material", 0}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    const LoadedCity loaded = load_asset(maker.glb());
    const Surface& surface = loaded.city.objects.at(0).geometry.surfaces.at(0);
    const Rgb albedo = loaded.city.materials.at(surface.material.value().index()).albedo;
    EXPECT_LT(glm::distance(albedo, Rgb(0.2f, 0.1f, 0.3f)), 1e-6f);
}

TEST(ReadGltf, InstancesAreObjects) {
    GltfMaker maker = cube_asset();
    const int places = maker.floats({0, 0, 0, 5, 0, 0, 10, 0, 0}, "VEC3");
    maker.json["nodes"][0]["extensions"] = {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}};
    maker.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const LoadedCity loaded = load_asset(maker.glb());
    ASSERT_EQ(loaded.city.objects.size(), 3u);
    EXPECT_EQ(loaded.city.objects[2].id, "cube 3");
    EXPECT_DOUBLE_EQ(extent_of(loaded.city).hi.x, 11.0);
}

TEST(ReadGltf, PlacesAboutTheEarthsCentreFindTheirWay) {
    // Graz, 47.07° N 15.44° E, 400 m above the ellipsoid, on GRS 80 (EPSG guidance note 7-2, section 4.1.1).
    const double latitude = radians_from_degrees(47.07), longitude = radians_from_degrees(15.44);
    const double e2 = 0.00669438, n = 6378137.0 / std::sqrt(1 - e2 * std::sin(latitude) * std::sin(latitude));
    const Vec3d up(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                   std::sin(latitude));
    const Vec3d east(-std::sin(longitude), std::cos(longitude), 0);
    const Vec3d center((n + 400) * up.x, (n + 400) * up.y, (n * (1 - e2) + 400) * up.z);
    GltfMaker maker;
    std::vector<float> corners;
    for (const Vec3d& p : {Vec3d(0.0), 20.0 * east, 20.0 * east + 10.0 * up}) {
        for (const double v : {p.x, p.z, -p.y}) corners.push_back(static_cast<float>(v));  // y up in the file
    }
    maker.mesh({{"attributes", {{"POSITION", maker.floats(corners, "VEC3")}}}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    maker.json["extensions"] = {{"CESIUM_RTC", {{"center", {center.x, center.y, center.z}}}}};
    const LoadedCity loaded = load_asset(maker.glb());
    ASSERT_TRUE(loaded.georeference.site.has_value());
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->latitude_rad), 47.07, 1e-4);
    EXPECT_NEAR(degrees_from_radians(loaded.georeference.site->longitude_rad), 15.44, 2e-4);
    const Vec3d size = extent_of(loaded.city).size();
    EXPECT_NEAR(size.x, 20.0, 0.01);
    EXPECT_NEAR(size.y, 0.0, 0.01);
    EXPECT_NEAR(size.z, 10.0, 0.01);
    EXPECT_NEAR(extent_of(loaded.city).lo.z, 400.0, 0.01);
}

TEST(ReadGltf, TilesSplitByTheirBatches) {
    GltfMaker maker;
    const int positions = maker.floats({0, 0, 0, 1, 0, 0, 1, 0, -1, 5, 0, 0, 6, 0, 0, 6, 0, -1}, "VEC3");
    const int batches = maker.floats({0, 0, 0, 7, 7, 7}, "SCALAR");
    maker.mesh({{"attributes", {{"POSITION", positions}, {"_BATCHID", batches}}}});
    maker.json["nodes"].push_back({{"mesh", 0}, {"name", "n"}});
    const std::string features = R"({"BATCH_LENGTH":8,"RTC_CENTER":[100,200,300]}   )";
    const std::string glb = maker.glb();
    std::string tile = "b3dm" + GltfMaker::little_endian(1) +
                       GltfMaker::little_endian(static_cast<std::uint32_t>(28 + features.size() + glb.size())) +
                       GltfMaker::little_endian(static_cast<std::uint32_t>(features.size())) + std::string(12, '\0') +
                       features + glb;
    const LoadedCity loaded = load_asset(tile, "a.b3dm");
    ASSERT_EQ(loaded.city.objects.size(), 2u);
    EXPECT_EQ(loaded.city.objects[0].id, "n 0");
    EXPECT_EQ(loaded.city.objects[1].id, "n 7");
    EXPECT_EQ(extent_of(loaded.city).lo, Vec3d(100, 200, 300));
}

TEST(ReadGltf, MeshoptIsDecoded) {
    const std::size_t count = kCubeCorners.size() / 3;
    std::vector<std::uint8_t> vertices(meshopt_encodeVertexBufferBound(count, 12));
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), kCubeCorners.data(), count, 12));
    std::vector<unsigned> triangles(kCubeTriangles.begin(), kCubeTriangles.end());
    std::vector<std::uint8_t> indices(meshopt_encodeIndexBufferBound(triangles.size(), count));
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), triangles.data(), triangles.size()));
    GltfMaker maker;
    const auto compressed = [&](const std::vector<std::uint8_t>& data, const Json& how) {
        const int view = maker.view(data);
        Json extension = maker.json["bufferViews"][static_cast<std::size_t>(view)];
        extension.update(how);
        maker.json["bufferViews"][static_cast<std::size_t>(view)] = {
            {"buffer", 1}, {"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
        return view;
    };
    const int positions = maker.accessor(
        compressed(vertices, {{"byteStride", 12}, {"count", count}, {"mode", "ATTRIBUTES"}}), 5126, "VEC3", count);
    const int faces =
        maker.accessor(compressed(indices, {{"byteStride", 2}, {"count", triangles.size()}, {"mode", "TRIANGLES"}}),
                       5123, "SCALAR", triangles.size());
    maker.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", faces}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    expect_cube(load_asset(maker.glb()), {0, -1, 0}, {1, 0, 1});
    // A flipped byte is told, and does nothing else.
    maker.bytes[0] = static_cast<char>(maker.bytes[0] ^ 0x40);
    EXPECT_EQ(load_asset(maker.glb()).findings.count("SB101"), 1u);
}

TEST(ReadGltf, DracoIsDecoded) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(kCubeTriangles.size() / 3));
    const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::size_t f = 0; f < kCubeTriangles.size() / 3; ++f) {
        const auto corner = [&](std::size_t k) { return &kCubeCorners[3u * kCubeTriangles[3 * f + k]]; };
        builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(f)), corner(0),
                                          corner(1), corner(2));
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(draco::Encoder().EncodeMeshToBuffer(*mesh, &buffer).ok());
    GltfMaker maker;
    const int view = maker.view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
    maker.json["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 8}},
                               {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 36}}};
    const auto id = mesh->attribute(0)->unique_id();
    maker.mesh(
        {{"attributes", {{"POSITION", 0}}},
         {"indices", 1},
         {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", id}}}}}}}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    maker.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    expect_cube(load_asset(maker.glb()), {0, -1, 0}, {1, 0, 1});
}

TEST(ReadGltf, SparseAndNormalisedNumbers) {
    GltfMaker maker;
    // Three zeros, of which two are replaced; unsigned bytes as 0…1.
    const int index_view = maker.view(std::vector<std::uint8_t>{1, 2});
    const int value_view = maker.view(std::vector<std::uint8_t>{255, 0, 0, 255, 255, 0});
    maker.json["accessors"].push_back({{"componentType", 5121},
                                       {"normalized", true},
                                       {"type", "VEC3"},
                                       {"count", 3},
                                       {"sparse",
                                        {{"count", 2},
                                         {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", value_view}}}}}});
    maker.mesh({{"attributes", {{"POSITION", 0}}}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    const LoadedCity loaded = load_asset(maker.glb());
    EXPECT_EQ(extent_of(loaded.city).size(), Vec3d(1, 0, 1));
}

TEST(ReadGltf, WhatCannotBeReadIsNamed) {
    GltfMaker maker = cube_asset();
    maker.json["extensionsRequired"] = {"KHR_texture_basisu"};
    EXPECT_THAT(error_of(maker.glb()), HasSubstr("requires the extension KHR_texture_basisu"));
    maker = cube_asset();
    maker.json["asset"]["version"] = "1.0";
    EXPECT_THAT(error_of(maker.glb()), HasSubstr("is glTF 1.0"));
    maker = cube_asset();
    const std::string text = maker.gltf();
    maker.json["buffers"][0]["uri"] = "../secret.bin";
    EXPECT_THAT(error_of(maker.json.dump(), "a.gltf"), HasSubstr("lies outside the file's folder"));
    maker.json["buffers"][0]["uri"] = "absent.bin";
    EXPECT_THAT(error_of(maker.json.dump(), "a.gltf"), HasSubstr("absent.bin"));
    EXPECT_THAT(error_of(cube_asset().glb().substr(0, 200)), HasSubstr("beyond the end"));
}

TEST(ReadGltf, FaultsOfPartsAreFindings) {
    const auto findings = [](const std::function<void(GltfMaker&)>& damage) {
        GltfMaker maker = cube_asset();
        damage(maker);
        return load_asset(maker.glb()).findings.count("SB101");
    };
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["accessors"][0]["count"] = 4000000000u; }), 1u);
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["accessors"][0]["bufferView"] = 9; }), 1u);
    EXPECT_EQ(findings([](GltfMaker& m) {
                  m.json["accessors"][0].erase("bufferView");
                  m.json["accessors"][0]["count"] = 2000000;
              }),
              1u);
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["bufferViews"][0]["byteLength"] = 1u << 30; }), 1u);
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["nodes"][0]["children"] = Json::array({0}); }), 1u)
        << "its own parent";
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["nodes"][0]["matrix"] = {1, 2, 3}; }), 1u);
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["meshes"][0]["primitives"][0]["material"] = 3; }), 1u);
    EXPECT_EQ(findings([](GltfMaker& m) { m.json["meshes"][0]["primitives"][0]["indices"] = -1; }), 1u);
    EXPECT_EQ(findings([](GltfMaker& m) { m.bytes[96] = 100; }), 1u) << "vertex 100 of 8";
}

TEST(ReadGltf, CutShortAnywhereItEndsInAnError) {
    const std::string whole = cube_asset().glb();
    for (std::size_t size = 1; size < whole.size(); size += 7)
        EXPECT_NE(error_of(whole.substr(0, size)), "no error") << size;
}

TEST(ReadGltf, RealTiles) {
    const auto dunedin = test_data("data/dunedin-photogrammetry-3dtiles/lod1_0.derived.glb");
    SKYBAKE_NEEDS_DATA(dunedin);
    const LoadedCity mesh = load(dunedin);
    const Vec3d size = extent_of(mesh.city).size();
    EXPECT_NEAR(size.x, 346, 1);
    EXPECT_NEAR(size.y, 351, 1);
    EXPECT_NEAR(size.z, 28, 1);
    EXPECT_EQ(mesh.city.textures.size(), 2u);
    EXPECT_EQ(io::read_image(mesh.city.textures[0]).width, 4096);
    EXPECT_EQ(mesh.findings.count(Severity::error), 0u);
    for (const char* name : {"1511577738.buildings.b3dm", "1511577738.buildings.derived.glb"}) {
        const LoadedCity berlin = load(test_data("data/berlin-block-3dtiles/") / name);
        EXPECT_EQ(berlin.city.objects.size(), 127u);
        EXPECT_NEAR(extent_of(berlin.city).size().x, 782, 1);
        EXPECT_NEAR(extent_of(berlin.city).size().y, 1266, 1);
        EXPECT_NEAR(extent_of(berlin.city).size().z, 49, 1);
    }
    const LoadedCity frankfurt = load(test_data("data/broken/real/frankfurt_draco.b3dm"));
    EXPECT_GT(frankfurt.summary.surfaces, 10000u) << "Draco is read";
    EXPECT_EQ(frankfurt.city.textures.size(), 1u) << "its photo only emits";
}

}  // namespace
}  // namespace skybake
