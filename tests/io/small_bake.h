// A small city by hand, with atlas and light: a textured ground, two walls of a corner and a roof on two pages.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "atlas/atlas.h"
#include "bake/lightmap.h"
#include "base/hash_rng.h"
#include "scene/scene.h"

namespace skybake {

struct SmallBake {
    Scene scene;
    Atlas atlas;
    Lightmaps light;
};

/// Adds the rectangle corner, corner + a, corner + a + b, corner + b as two triangles, one face and one chart at
/// `position` of a page. `a` and `b` are whole texels long; `−b` is the image's downward direction, so that row 0 is at
/// corner + b.
inline void add_rectangle(SmallBake& bake, Vec3f corner, Vec3f a, Vec3f b, std::uint32_t material, std::uint32_t page,
                          Vec2i position) {
    const float texel = bake.atlas.texel_m;
    const std::uint32_t face = static_cast<std::uint32_t>(bake.scene.faces.size());
    const std::uint32_t first = static_cast<std::uint32_t>(bake.scene.triangles.size());
    bake.scene.faces.push_back({0, SurfaceType::wall, MaterialId(material), first, 2, face});
    Chart chart;
    chart.page = PageId(page);
    chart.position = position;
    chart.size = {static_cast<int>(std::lround(glm::length(a) / texel)),
                  static_cast<int>(std::lround(glm::length(b) / texel))};
    chart.u = glm::normalize(a) * texel;
    chart.v = -glm::normalize(b) * texel;
    chart.origin = corner + b;
    chart.normal = glm::normalize(glm::cross(a, b));
    chart.triangles = {first, first + 1};
    chart.stable_id = face + 1;
    const std::array<Vec3f, 4> points = {corner, corner + a, corner + a + b, corner + b};
    const std::array<Vec2f, 4> uvs = {Vec2f(0, 0), Vec2f(2, 0), Vec2f(2, 1), Vec2f(0, 1)};
    const Vec2f p(position);
    const Vec2f s(chart.size);
    const std::array<Vec2f, 4> texels = {p + Vec2f(0, s.y), p + s, p + Vec2f(s.x, 0), p};
    for (const auto& [i, j, k] : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
        bake.scene.triangles.push_back({points[i], points[j], points[k]});
        bake.scene.triangle_uvs.push_back({uvs[i], uvs[j], uvs[k]});
        bake.scene.triangle_face.push_back(FaceId(face));
        bake.atlas.triangle_chart.push_back(ChartId(bake.atlas.charts.size()));
        bake.atlas.triangle_texels.push_back({texels[i], texels[j], texels[k]});
    }
    for (const Vec3f& point : points) bake.scene.bounds.extend(point);
    bake.atlas.charts.push_back(chart);
}

/// Light that differs from texel to texel: a stated function of place, so that tests know every value.
inline Rgb small_bake_sky(std::size_t instant, std::size_t page, std::size_t texel) {
    const float noise = uniform_float(7, page, texel, instant);
    return Rgb(9000.0f, 10000.0f, 12000.0f) * (0.5f + 0.5f * noise);
}

/// `texture_path` may be empty: then the ground's texture is missing.
inline SmallBake make_small_bake(const std::filesystem::path& texture_path, std::size_t instants = 2) {
    SmallBake bake;
    bake.atlas.texel_m = 0.5f;
    bake.atlas.pages = {{48, 40}, {32, 24}};
    bake.scene.origin = {-67000.0, 215000.0, 350.0};
    bake.scene.objects = {{"house", "house", ObjectType::building}};
    bake.scene.textures = {{texture_path.string(), "ground.png", TextureWrap::repeat, Rgb(1.0f), texture_path.empty()}};
    bake.scene.materials = {{"plaster", Rgb(0.6f, 0.55f, 0.5f), {}, TextureWrap::repeat},
                            {"ground", Rgb(1.0f), TextureId(0), TextureWrap::repeat}};
    add_rectangle(bake, {0, 0, 0}, {20, 0, 0}, {0, 16, 0}, 1, 0, {3, 3});  // ground, 40 × 32
    add_rectangle(bake, {5, 5, 0}, {8, 0, 0}, {0, 0, 6}, 0, 1, {3, 3});    // wall to the south, 16 × 12
    add_rectangle(bake, {5, 9, 0}, {0, -4, 0}, {0, 0, 6}, 0, 1, {22, 3});  // wall to the west, 8 × 12
    add_rectangle(bake, {5, 5, 6}, {8, 0, 0}, {0, 2, 0}, 0, 1, {3, 18});   // roof, 16 × 4
    for (const AtlasPage& size : bake.atlas.pages) {
        LightmapPage page;
        page.width = size.width;
        page.height = size.height;
        const std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        page.state.assign(count, TexelState::empty);
        page.chart.assign(count, ChartId(0));
        page.sky_view_factor.assign(count, 0.0f);
        bake.light.pages.push_back(page);
    }
    for (std::size_t c = 0; c < bake.atlas.charts.size(); ++c) {
        const Chart& chart = bake.atlas.charts[c];
        LightmapPage& page = bake.light.pages[chart.page.index()];
        for (int y = -kGutter; y < chart.size.y + kGutter; ++y) {
            for (int x = -kGutter; x < chart.size.x + kGutter; ++x) {
                const std::size_t texel =
                    static_cast<std::size_t>((chart.position.y + y) * page.width + chart.position.x + x);
                const bool is_inside = x >= 0 && y >= 0 && x < chart.size.x && y < chart.size.y;
                page.state[texel] = is_inside ? TexelState::chart : TexelState::gutter;
                page.chart[texel] = ChartId(c);
                page.sky_view_factor[texel] = 0.5f + 0.5f * chart.normal.z;
            }
        }
    }
    bake.light.pages[1].state[static_cast<std::size_t>(4 * bake.light.pages[1].width + 4)] = TexelState::buried;
    for (std::size_t i = 0; i < instants; ++i) {
        BakedInstant instant;
        instant.daylight.label = i == 0 ? "2026-06-21T12:00+02:00" : "sun 180,45";
        instant.daylight.sky = UniformSky{3000.0f};
        instant.daylight.sun.direction = glm::normalize(Vec3f(0.0f, -1.0f, 1.0f + static_cast<float>(i)));
        instant.daylight.sun.normal_illuminance = Rgb(90000.0f, 85000.0f, 80000.0f);
        instant.daylight.sun.dni_w_m2 = 800.0f;
        for (std::size_t p = 0; p < bake.light.pages.size(); ++p) {
            LightmapLayer layer;
            for (std::size_t t = 0; t < bake.light.pages[p].state.size(); ++t) {
                const bool is_empty = bake.light.pages[p].state[t] == TexelState::empty;
                layer.sky.push_back(is_empty ? Rgb(0.0f) : small_bake_sky(i, p, t));
                layer.sun_cosine.push_back(is_empty || t % 3 == 0 ? 0.0f : 0.25f * static_cast<float>(t % 4));
            }
            instant.pages.push_back(layer);
        }
        bake.light.instants.push_back(instant);
    }
    return bake;
}

}  // namespace skybake
