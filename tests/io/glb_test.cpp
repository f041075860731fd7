// The GLB is parsed back by hand, after the glTF 2.0 specification: layout, alignment, bounds, and that each vertex
// stands where the scene has it.
#include "io/gltf/glb.h"
#include "io/gltf/unlit_glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/gltf/welded_mesh.h"
#include "io/image/image.h"
#include "scratch_folder.h"
#include "small_bake.h"

namespace skybake::io {
namespace {

struct Glb {
    nlohmann::json json;
    std::vector<std::uint8_t> binary;

    explicit Glb(const std::vector<std::uint8_t>& bytes) {
        const auto word = [&](std::size_t at) {
            std::uint32_t value = 0;
            std::memcpy(&value, bytes.data() + at, 4);
            return value;
        };
        EXPECT_EQ(word(0), 0x46546c67u);
        EXPECT_EQ(word(4), 2u);
        EXPECT_EQ(word(8), bytes.size());
        const std::uint32_t json_size = word(12);
        EXPECT_EQ(json_size % 4, 0u);
        EXPECT_EQ(word(16), 0x4e4f534au);
        json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + json_size);
        if (bytes.size() == 20 + json_size) return;
        EXPECT_EQ(word(20 + json_size) % 4, 0u);
        EXPECT_EQ(word(24 + json_size), 0x004e4942u);
        binary.assign(bytes.begin() + 28 + json_size, bytes.end());
        EXPECT_EQ(binary.size(), word(20 + json_size));
    }

    /// All components of an accessor, checked to lie inside its view and the view inside the buffer.
    template <typename T>
    std::vector<T> read(std::size_t accessor_index) const {
        const nlohmann::json& accessor = json["accessors"][accessor_index];
        const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::string type = accessor["type"];
        const std::size_t components = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : 3;
        const std::size_t offset = accessor["byteOffset"], begin = view["byteOffset"], count = accessor["count"];
        EXPECT_EQ(offset % 4, 0u);
        EXPECT_EQ(begin % 4, 0u);
        EXPECT_EQ(view.value("byteStride", components * sizeof(T)), components * sizeof(T));
        EXPECT_LE(offset + count * components * sizeof(T), view["byteLength"].get<std::size_t>());
        EXPECT_LE(begin + view["byteLength"].get<std::size_t>(), binary.size());
        std::vector<T> values(count * components);
        std::memcpy(values.data(), binary.data() + begin + offset, values.size() * sizeof(T));
        return values;
    }

    std::vector<std::uint8_t> image(std::size_t index) const {
        const nlohmann::json& view = json["bufferViews"][json["images"][index]["bufferView"].get<std::size_t>()];
        const auto begin = binary.begin() + view["byteOffset"].get<std::ptrdiff_t>();
        return {begin, begin + view["byteLength"].get<std::ptrdiff_t>()};
    }
};

class GlbTest : public ::testing::Test {
  protected:
    ScratchFolder folder{"glb"};
    Image8 texture{2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
    std::vector<std::vector<std::uint8_t>> sky_view = {
        encode_png({48, 40, 1, std::vector<std::uint8_t>(48 * 40, 200)}),
        encode_png({32, 24, 1, std::vector<std::uint8_t>(32 * 24, 100)})};
    void SetUp() override { write_png(folder / "ground.png", texture); }
    Glb written(const SmallBake& bake, GlbSummary* summary = nullptr) {
        const GlbSummary got =
            write_glb(folder / "city.glb", bake.scene, bake.atlas, sky_view, {"skybake test", "EPSG:31256"});
        if (summary != nullptr) *summary = got;
        return Glb(read_file(folder / "city.glb"));
    }
};

TEST_F(GlbTest, OnePrimitiveForEachMaterialAndPage) {
    GlbSummary summary;
    const Glb glb = written(make_small_bake(folder / "ground.png"), &summary);
    const nlohmann::json& primitives = glb.json["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), 2u);  // plaster on page 1, ground on page 0
    EXPECT_EQ(summary.primitives, 2u);
    EXPECT_EQ(summary.triangles, 8u);
    EXPECT_EQ(summary.vertices, 16u);  // four a rectangle: its triangles share two; charts share none
    EXPECT_EQ(summary.images, 1u);
    EXPECT_EQ(summary.bytes, std::filesystem::file_size(folder / "city.glb"));
    std::set<int> pages;
    for (const nlohmann::json& primitive : primitives) {
        const nlohmann::json& material = glb.json["materials"][primitive["material"].get<std::size_t>()];
        const nlohmann::json& extension = material["extensions"]["SKYBAKE_lightmap"];
        EXPECT_EQ(extension["texCoord"], 1);
        EXPECT_EQ(material["occlusionTexture"]["texCoord"], 1);
        // The occlusion texture of a material is the picture of its own page.
        const std::size_t source =
            glb.json["textures"][material["occlusionTexture"]["index"].get<std::size_t>()]["source"];
        EXPECT_EQ(glb.image(source), sky_view[extension["page"].get<std::size_t>()]);
        pages.insert(extension["page"].get<int>());
    }
    EXPECT_EQ(pages, (std::set<int>{0, 1}));
    EXPECT_EQ(glb.json["extensionsUsed"], nlohmann::json({"SKYBAKE_lightmap"}));
    EXPECT_FALSE(glb.json.contains("extensionsRequired"));
    EXPECT_EQ(glb.json["extensions"]["SKYBAKE_lightmap"]["pages"].size(), 2u);
}

// x = east, y = up, z = −north, and the lightmap coordinate of each vertex leads to the texel where its chart has that
// very place.
TEST_F(GlbTest, VerticesStandWhereTheSceneHasThem) {
    const SmallBake bake = make_small_bake(folder / "ground.png");
    const Glb glb = written(bake);
    for (const nlohmann::json& primitive : glb.json["meshes"][0]["primitives"]) {
        const nlohmann::json& attributes = primitive["attributes"];
        const std::vector<float> positions = glb.read<float>(attributes["POSITION"]);
        const std::vector<float> normals = glb.read<float>(attributes["NORMAL"]);
        const std::vector<float> uvs = glb.read<float>(attributes["TEXCOORD_1"]);
        const std::vector<float> charts = glb.read<float>(attributes["_CHART"]);
        const std::vector<std::uint32_t> indices = glb.read<std::uint32_t>(primitive["indices"]);
        ASSERT_EQ(indices.size() % 3, 0u);
        for (const std::uint32_t index : indices) ASSERT_LT(index, charts.size());
        const nlohmann::json& material = glb.json["materials"][primitive["material"].get<std::size_t>()];
        const AtlasPage& page = bake.atlas.pages[material["extensions"]["SKYBAKE_lightmap"]["page"].get<std::size_t>()];
        Vec3f lo(1e9f), hi(-1e9f);
        for (std::size_t v = 0; v < charts.size(); ++v) {
            const Vec3f gltf(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
            lo = glm::min(lo, gltf);
            hi = glm::max(hi, gltf);
            const Vec3f world(gltf.x, -gltf.z, gltf.y);
            const Chart& chart = bake.atlas.charts[static_cast<std::size_t>(charts[v])];
            ASSERT_GE(uvs[2 * v], 0.0f);
            ASSERT_LE(uvs[2 * v], 1.0f);
            ASSERT_GE(uvs[2 * v + 1], 0.0f);
            ASSERT_LE(uvs[2 * v + 1], 1.0f);
            const Vec2f texel =
                Vec2f(uvs[2 * v] * static_cast<float>(page.width), uvs[2 * v + 1] * static_cast<float>(page.height)) -
                Vec2f(chart.position);
            const Vec3f from_chart = chart.origin + texel.x * chart.u + texel.y * chart.v;
            EXPECT_NEAR(glm::distance(world, from_chart), 0.0f, 1e-4f);
            EXPECT_NEAR(glm::distance(Vec3f(normals[3 * v], -normals[3 * v + 2], normals[3 * v + 1]), chart.normal),
                        0.0f, 1e-6f);
        }
        const nlohmann::json& accessor = glb.json["accessors"][attributes["POSITION"].get<std::size_t>()];
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(accessor["min"][static_cast<std::size_t>(c)].get<float>(), lo[c]);
            EXPECT_EQ(accessor["max"][static_cast<std::size_t>(c)].get<float>(), hi[c]);
        }
        // Counter-clockwise triangles face along their normals.
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const auto at = [&](std::size_t k) {
                return Vec3f(positions[3 * indices[i + k]], positions[3 * indices[i + k] + 1],
                             positions[3 * indices[i + k] + 2]);
            };
            const Vec3f normal(normals[3 * indices[i]], normals[3 * indices[i] + 1], normals[3 * indices[i] + 2]);
            EXPECT_GT(glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), normal), 0.0f);
        }
    }
}

// The scene's (0, 0) is the picture's lower left; glTF's is the upper left.
TEST_F(GlbTest, TextureIsEmbeddedUnchangedAndItsCoordinatesPointDown) {
    const Glb glb = written(make_small_bake(folder / "ground.png"));
    const nlohmann::json* ground = nullptr;
    for (const nlohmann::json& primitive : glb.json["meshes"][0]["primitives"]) {
        const nlohmann::json& material = glb.json["materials"][primitive["material"].get<std::size_t>()];
        if (material["name"] == "ground") ground = &primitive;
        const bool has_texture = material["pbrMetallicRoughness"].contains("baseColorTexture");
        EXPECT_EQ(has_texture, material["name"] == "ground");
        if (!has_texture) {
            EXPECT_NEAR(material["pbrMetallicRoughness"]["baseColorFactor"][0].get<float>(), 0.6f, 1e-6f);
            continue;
        }
        const nlohmann::json& albedo =
            glb.json["textures"][material["pbrMetallicRoughness"]["baseColorTexture"]["index"].get<std::size_t>()];
        EXPECT_EQ(glb.image(albedo["source"]), read_file(folder / "ground.png"));
        EXPECT_EQ(glb.json["samplers"][albedo["sampler"].get<std::size_t>()]["wrapS"], 10497);
    }
    ASSERT_NE(ground, nullptr);
    const std::vector<float> positions = glb.read<float>((*ground)["attributes"]["POSITION"]);
    const std::vector<float> uvs = glb.read<float>((*ground)["attributes"]["TEXCOORD_0"]);
    for (std::size_t v = 0; v < uvs.size() / 2; ++v) {
        const float north = -positions[3 * v + 2];
        EXPECT_EQ(uvs[2 * v], positions[3 * v] / 10.0f);
        EXPECT_EQ(uvs[2 * v + 1], 1.0f - north / 16.0f);
    }
}

TEST_F(GlbTest, MissingOrStrangeTexturesBecomeGrey) {
    write_file(folder / "not-a-picture.png", std::vector<std::uint8_t>{1, 2, 3});
    for (const std::filesystem::path& path :
         {std::filesystem::path(), folder / "not-a-picture.png", folder / "gone.png"}) {
        GlbSummary summary;
        const Glb glb = written(make_small_bake(path), &summary);
        EXPECT_EQ(summary.images, 0u);
        EXPECT_EQ(summary.textures_left_out, 1u);
        for (const nlohmann::json& material : glb.json["materials"]) {
            EXPECT_FALSE(material["pbrMetallicRoughness"].contains("baseColorTexture"));
            if (material["name"] == "ground") {
                EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"][0], 0.5f);
            }
        }
    }
}

TEST_F(GlbTest, EmptySceneIsStillAGlb) {
    SmallBake bake;
    sky_view.clear();
    const Glb glb = written(bake);
    EXPECT_FALSE(glb.json.contains("meshes"));
    EXPECT_FALSE(glb.json.contains("buffers"));
}

// A chart of nearly coplanar triangles keeps its flat triangles' own normals, and so its vertices apart.
TEST_F(GlbTest, BentChartsKeepTheNormalsOfTheirTriangles) {
    SmallBake bake = make_small_bake(folder / "ground.png");
    bake.scene.triangles[1][2].z = 1.0f;  // one corner of the ground is lifted
    bake.atlas.charts[0].min_normal_cosine = 0.99f;
    const WeldedMesh mesh = weld(bake.scene, bake.atlas);
    EXPECT_EQ(mesh.vertex_corner.size(), 18u);  // 6 for the ground, 4 for each of the three others
    const Vec3f flat = vertex_at(bake.scene, bake.atlas, bake.atlas.charts[0], 0).normal;
    const Vec3f bent = vertex_at(bake.scene, bake.atlas, bake.atlas.charts[0], 3).normal;
    EXPECT_EQ(flat, Vec3f(0, 0, 1));
    EXPECT_LT(bent.z, 0.9999f);
    EXPECT_NEAR(glm::length(bent), 1.0f, 1e-6f);
}

TEST_F(GlbTest, TheUnlitCityHasTheSameTrianglesUnderThePagesPictures) {
    const Glb lit = written(make_small_bake(folder / "ground.png"));
    const std::vector<std::vector<std::uint8_t>> pages = {
        encode_png({96, 80, 3, std::vector<std::uint8_t>(96 * 80 * 3, 50)}),
        encode_png({64, 48, 3, std::vector<std::uint8_t>(64 * 48 * 3, 90)})};
    write_unlit_glb(folder / "city.glb", folder / "unlit.glb", pages, "skybake test");
    const Glb unlit(read_file(folder / "unlit.glb"));
    EXPECT_EQ(unlit.json["extensionsUsed"], nlohmann::json({"KHR_materials_unlit"}));
    EXPECT_EQ(unlit.json["scenes"][0]["extras"]["crs"], "EPSG:31256");
    const nlohmann::json& before = lit.json["meshes"][0]["primitives"];
    const nlohmann::json& after = unlit.json["meshes"][0]["primitives"];
    ASSERT_EQ(after.size(), before.size());
    const auto numbers = [](const Glb& glb, const nlohmann::json& primitive, const char* name) {
        return glb.read<float>(primitive["attributes"][name].get<std::size_t>());
    };
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_EQ(numbers(unlit, after[i], "POSITION"), numbers(lit, before[i], "POSITION"));
        EXPECT_EQ(numbers(unlit, after[i], "TEXCOORD_0"), numbers(lit, before[i], "TEXCOORD_1"));
        EXPECT_FALSE(after[i]["attributes"].contains("_CHART"));
        EXPECT_EQ(unlit.read<std::uint32_t>(after[i]["indices"].get<std::size_t>()),
                  lit.read<std::uint32_t>(before[i]["indices"].get<std::size_t>()));
        const nlohmann::json& material = unlit.json["materials"][after[i]["material"].get<std::size_t>()];
        EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
        const std::size_t base = material["pbrMetallicRoughness"]["baseColorTexture"]["index"];
        const std::size_t page =
            lit.json["materials"][before[i]["material"].get<std::size_t>()]["extensions"]["SKYBAKE_lightmap"]["page"];
        EXPECT_EQ(unlit.image(unlit.json["textures"][base]["source"].get<std::size_t>()), pages[page]);
    }
}

TEST_F(GlbTest, AnUnlitCityOfAForeignFileIsRefused) {
    const std::vector<std::uint8_t> whole = [&] {
        written(make_small_bake(folder / "ground.png"));
        return read_file(folder / "city.glb");
    }();
    for (const std::size_t size : {std::size_t{0}, std::size_t{11}, std::size_t{40}, whole.size() / 2}) {
        write_file(folder / "cut.glb", std::span(whole).first(size));
        EXPECT_THROW(write_unlit_glb(folder / "cut.glb", folder / "unlit.glb", sky_view, "test"), InputError) << size;
    }
    // A page that the bake does not have.
    EXPECT_THROW(write_unlit_glb(folder / "city.glb", folder / "unlit.glb", std::span(sky_view).first(1), "test"),
                 InputError);
    EXPECT_FALSE(std::filesystem::exists(folder / "unlit.glb"));
}

}  // namespace
}  // namespace skybake::io
