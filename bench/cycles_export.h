// What bench/cycles gives to another renderer: materials without pictures, sky and sun.
#pragma once

#include <fmt/format.h>
#include <fmt/os.h>

#include <filesystem>
#include <numbers>

#include "api/load_albedo.h"
#include "atlas/atlas.h"
#include "bench_city.h"
#include "io/exr/exr.h"
#include "sky/sky_panorama.h"

namespace skybake::bench {

inline constexpr int kSkyWidth = 2048;
// Above the surface: farther than either program lifts its rays, so that both start outside.
inline constexpr float kPointHeight = 0.002f;

/// Each material's mean albedo in place of its picture: both programs then know the same constants.
inline void flatten_materials(Scene& scene) {
    SilentProgress silent;
    FindingLog findings;
    load_albedo_images(scene, findings, silent);
    constexpr int kSide = 64;
    for (SceneMaterial& material : scene.materials) {
        if (!material.texture) continue;
        const AlbedoImage& image = scene.albedo_images[material.texture->index()];
        Rgb sum(0.0f);
        for (int i = 0; i < kSide * kSide; ++i) {
            const Vec2f uv((static_cast<float>(i % kSide) + 0.5f) / kSide,
                           (static_cast<float>(i / kSide) + 0.5f) / kSide);
            sum += albedo_at(image, uv, TextureWrap::repeat, Rgb(0.0f));
        }
        material.albedo *= sum / static_cast<float>(kSide * kSide);
        material.texture.reset();
    }
    scene.albedo_images.clear();
}

/// The sky as a picture, and that picture as the sky: both programs then interpolate the same values. Its left edge is
/// west, where Blender's is.
inline ImageSky picture_of(const SkyModel& sky) {
    auto image = std::make_shared<SkyImage>();
    image->width = kSkyWidth;
    image->height = kSkyWidth / 2;
    for (int row = 0; row < image->height; ++row) {
        for (int column = 0; column < image->width; ++column) {
            const double azimuth = 2.0 * std::numbers::pi * ((column + 0.5) / image->width + 0.75);
            const double zenith = std::numbers::pi * (row + 0.5) / image->height;
            image->pixels.push_back(
                sky_luminance(sky, Vec3f(Vec3d(std::sin(zenith) * std::sin(azimuth),
                                               std::sin(zenith) * std::cos(azimuth), std::cos(zenith)))));
        }
    }
    return {image, 1.5 * std::numbers::pi};
}

/// The afternoon with its sky as a picture; writes sky.exr and sun.csv.
inline Daylight write_daylight(const std::filesystem::path& folder) {
    Daylight daylight = afternoon();
    const ImageSky sky = picture_of(daylight.sky);
    io::write_exr_rgb(folder / "sky.exr", {sky.image->width, sky.image->height, sky.image->pixels});
    daylight.sky = sky;
    const SunBeam& sun = daylight.sun;
    fmt::output_file((folder / "sun.csv").string())
        .print("x,y,z,r,g,b\n{},{},{},{},{},{}\n", sun.direction.x, sun.direction.y, sun.direction.z,
               sun.normal_illuminance.x, sun.normal_illuminance.y, sun.normal_illuminance.z);
    return daylight;
}

/// scene.obj. With an atlas each corner has its place in its lightmap page, 0…1 from the lower left, and "page" lines
/// say which.
inline void write_mesh(const std::filesystem::path& folder, const Scene& scene, const Atlas* atlas = nullptr) {
    fmt::ostream obj = fmt::output_file((folder / "scene.obj").string());
    for (const auto& triangle : scene.triangles) {
        for (const Vec3f& v : triangle) obj.print("v {} {} {}\n", v.x, v.y, v.z);
    }
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Rgb& albedo = scene.materials[m].albedo;
        obj.print("# albedo m{} {} {} {}\n", m, albedo.x, albedo.y, albedo.z);
    }
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        obj.print("usemtl m{}\nf {} {} {}\n", scene.faces[scene.triangle_face[t].index()].material.index(), 3 * t + 1,
                  3 * t + 2, 3 * t + 3);
        if (!atlas) continue;
        const std::size_t page = atlas->charts[atlas->triangle_chart[t].index()].page.index();
        obj.print("page {}", page);
        for (const Vec2f& p : atlas->triangle_texels[t])
            obj.print(" {} {}", p.x / static_cast<float>(atlas->pages[page].width),
                      1.0f - p.y / static_cast<float>(atlas->pages[page].height));
        obj.print("\n");
    }
}

}  // namespace skybake::bench
