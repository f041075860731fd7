// The scene of bench/cycles: mesh, sky, sun and points for another renderer, with our own light at the points.
//   bench_cycles_scene CITY OUT_FOLDER [RADIUS_M [POINTS [PATHS [BOUNCES]]]]
#include <cstdlib>

#include "cycles_export.h"
#include "light/path_reference.h"
#include "surface_points.h"

namespace skybake::bench {
namespace {

constexpr int kSkySamples = 16384;

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
    const Daylight daylight = write_daylight(folder);
    write_mesh(folder, scene);

    const RayScene rays(scene);
    const SurfacePoints points = surface_points(scene, rays, daylight, count, kPointHeight, kSkySamples);
    const LightSources sources{daylight, {}};
    SilentProgress silent;
    const std::vector<IndirectLight> indirect =
        PathReference(sources, scene, rays, {paths, bounces, 0}).light(points.points, silent);

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
