// city.glb read back: every triangle, texel and texture as written; broken files are refused, never followed.
#include "io/gltf/read_glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/gltf/glb.h"
#include "io/image/image.h"
#include "scratch_folder.h"
#include "small_bake.h"

namespace skybake::io {
namespace {

using testing::HasSubstr;

class ReadGlbTest : public ::testing::Test {
  protected:
    void SetUp() override {
        write_png(folder / "ground.png", {2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}});
        bake = make_small_bake(folder / "ground.png");
        const std::vector<std::vector<std::uint8_t>> sky_view = {
            encode_png({48, 40, 1, std::vector<std::uint8_t>(48 * 40, 200)}),
            encode_png({32, 24, 1, std::vector<std::uint8_t>(32 * 24, 100)})};
        write_glb(path, bake.scene, bake.atlas, sky_view, {});
    }
    /// The message of the refusal; empty when the file was read.
    std::string refusal() {
        try {
            read_glb(path, sizes);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    ScratchFolder folder{"read-glb"};
    std::filesystem::path path = folder / "city.glb";
    std::vector<Vec2i> sizes = {{48, 40}, {32, 24}};
    SmallBake bake;
};

TEST_F(ReadGlbTest, GivesBackEveryTriangle) {
    const PictureScene city = read_glb(path, sizes);
    ASSERT_EQ(city.triangles.size(), bake.scene.triangles.size());
    ASSERT_EQ(city.surfaces.size(), city.triangles.size());
    EXPECT_EQ(city.bounds.lo, bake.scene.bounds.lo);
    EXPECT_EQ(city.bounds.hi, bake.scene.bounds.hi);
    for (std::size_t t = 0; t < city.triangles.size(); ++t) {
        // The writer sorts by material and page: the triangle is found by its corners.
        const auto found = std::find(bake.scene.triangles.begin(), bake.scene.triangles.end(), city.triangles[t]);
        ASSERT_NE(found, bake.scene.triangles.end());
        const std::size_t there = static_cast<std::size_t>(found - bake.scene.triangles.begin());
        const Chart& chart = bake.atlas.charts[bake.atlas.triangle_chart[there].index()];
        EXPECT_EQ(city.surfaces[t].page, chart.page.index());
        const bool is_ground = chart.page.index() == 0;
        const PictureMaterial& material = city.materials[city.surfaces[t].material];
        EXPECT_EQ(material.texture.has_value(), is_ground);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec2f texel = city.surfaces[t].texel[corner];
            EXPECT_LT(glm::length(texel - bake.atlas.triangle_texels[there][corner]), 1e-4f);
            if (!is_ground) continue;
            const Vec2f uv = city.surfaces[t].albedo_uv[corner];
            EXPECT_LT(glm::length(uv - bake.scene.triangle_uvs[there][corner]), 1e-6f);
        }
        if (!is_ground) {
            EXPECT_LT(glm::length(material.base_colour - Rgb(0.6f, 0.55f, 0.5f)), 1e-6f);
        }
    }
    ASSERT_EQ(city.textures.size(), 1u);
    const Rgb upper_left = city.textures[0].at({0.25f, 0.75f}, Vec2f(0.0f), TextureWrap::repeat);
    EXPECT_EQ(upper_left, Rgb(1.0f, 0.0f, 0.0f));
}

TEST_F(ReadGlbTest, RefusesWhatEndsEarlyAnywhere) {
    const std::vector<std::uint8_t> whole = read_file(path);
    for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 97) {
        write_file(path, std::span(whole).first(size));
        EXPECT_THAT(refusal(), HasSubstr("city.glb")) << size;
    }
}

TEST_F(ReadGlbTest, ABrokenByteEndsInAMessageOrAPicture) {
    const std::vector<std::uint8_t> whole = read_file(path);
    for (std::size_t at = 0; at < whole.size(); at += at < 4096 ? 5 : 41) {
        std::vector<std::uint8_t> broken = whole;
        broken[at] = static_cast<std::uint8_t>(broken[at] ^ (1u << at % 8));
        write_file(path, broken);
        const std::string message = refusal();  // reads outside are found by the sanitizers' run of this test
        if (!message.empty()) {
            EXPECT_THAT(message, HasSubstr("city.glb"));
        }
    }
}

TEST_F(ReadGlbTest, RefusesAPageThatTheManifestDoesNotHave) {
    sizes.pop_back();
    EXPECT_THAT(refusal(), HasSubstr("page 1 of 1"));
}

}  // namespace
}  // namespace skybake::io
