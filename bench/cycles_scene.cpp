// The scene of bench/cycles: mesh, sky, sun and points for another renderer, with our own light at the points.
//   bench_cycles_scene CITY OUT_FOLDER [RADIUS_M [POINTS [PATHS [BOUNCES]]]]
#include <fmt/format.h>
#include <fmt/os.h>

#include <cstdlib>
#include <numbers>

#include "api/load_albedo.h"
#include "bench_city.h"
#include "io/exr/exr.h"
#include "light/path_reference.h"
#include "sky/sky_panorama.h"
#include "surface_points.h"

namespace skybake::bench {
namespace {

constexpr int kSkyWidth = 2048;
constexpr int kSkySamples = 16384;
// Above the surface: farther than either program lifts its rays, so that both start outside.
constexpr float kPointHeight = 0.002f;

/// Each material's mean albedo in place of its picture: both programs then know the same constants.
void flatten_materials(Scene& scene) {
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
ImageSky picture_of(const SkyModel& sky) {
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

void write_mesh(const std::filesystem::path& folder, const Scene& scene) {
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
    }
}

int run(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: bench_cycles_scene CITY OUT_FOLDER [RADIUS_M [POINTS [PATHS [BOUNCES]]]]\n");
        return 2;
    }
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    const double radius = argc > 3 ? std::atof(argv[3]) : 1e6;
    const std::size_t count = argc > 4 ? static_cast<std::size_t>(std::atoll(argv[4])) : 1000;
    const int paths = argc > 5 ? std::atoi(argv[5]) : 16384;
    const int bounces = argc > 6 ? std::atoi(argv[6]) : 4;

    Scene scene = load_scene(argv[1], radius, 0.5f);
    flatten_materials(scene);
    Daylight daylight = afternoon();
    const ImageSky sky = picture_of(daylight.sky);
    io::write_exr_rgb(folder / "sky.exr", {sky.image->width, sky.image->height, sky.image->pixels});
    daylight.sky = sky;
    write_mesh(folder, scene);

    const RayScene rays(scene);
    const SurfacePoints points = surface_points(scene, rays, daylight, count, kPointHeight, kSkySamples);
    const LightSources sources{daylight, {}};
    SilentProgress silent;
    const std::vector<IndirectLight> indirect =
        PathReference(sources, scene, rays, {paths, bounces, 0}).light(points.points, silent);

    const SunBeam& sun = daylight.sun;
    fmt::output_file((folder / "sun.csv").string())
        .print("x,y,z,r,g,b\n{},{},{},{},{},{}\n", sun.direction.x, sun.direction.y, sun.direction.z,
               sun.normal_illuminance.x, sun.normal_illuminance.y, sun.normal_illuminance.z);
    fmt::ostream csv = fmt::output_file((folder / "points.csv").string());
    csv.print("x,y,z,nx,ny,nz,kind,sun_lx,sky_lx,indirect_lx,indirect_error_lx\n");
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        const ReceiverPoint& p = points.points[i];
        csv.print("{},{},{},{},{},{},{},{},{},{},{}\n", p.position.x, p.position.y, p.position.z, p.normal.x,
                  p.normal.y, p.normal.z, name_of(scene.faces[points.faces[i].index()].type),
                  luminance(points.direct[i].sun), luminance(points.direct[i].sky), luminance(indirect[i].irradiance),
                  indirect[i].standard_error_lx);
    }
    fmt::print("{} triangles, {} points\n", scene.triangles.size(), points.points.size());
    return 0;
}

}  // namespace
}  // namespace skybake::bench

int main(int argc, char** argv) {
    return skybake::bench::run(argc, argv);
}
