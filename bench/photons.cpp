// Photons against the path-traced reference: every estimator at points of a city, error against the number of photons,
// and the scenes in which light leaks.
//   bench_photons CITY [RADIUS_M [POINTS [PATHS [SVG]]]]
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "api/load_albedo.h"
#include "bake/scenes.h"
#include "bench_city.h"
#include "light/photon_tracer.h"
#include "surface_points.h"

namespace skybake::bench {
namespace {

constexpr int kBounces = 8;

/// Processor time of all threads: other programs on the machine do not count.
double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A scene with its points and the truth there.
struct Judge {
    Judge(Scene&& city, std::size_t point_count, int paths)
        : scene(std::move(city)), rays(scene), area_m2(surface_area(scene)) {
        SurfacePoints on_surfaces = surface_points(scene, rays, sources.daylight, point_count, 0.0f, 1024);
        points = std::move(on_surfaces.points);
        for (const PointLight& light : on_surfaces.direct)
            direct_mean += static_cast<double>(luminance(light.sun + light.sky));
        direct_mean /= static_cast<double>(points.size());
        find_truth(paths);
    }
    Judge(Scene&& made, std::vector<ReceiverPoint> at, int paths)
        : scene(std::move(made)), rays(scene), area_m2(surface_area(scene)), points(std::move(at)) {
        find_truth(paths);
    }

    void find_truth(int paths) {
        SilentProgress silent;
        truth = PathReference(sources, scene, rays, {paths, kBounces, 1}).light(points, silent);
        for (const IndirectLight& light : truth) {
            mean += static_cast<double>(luminance(light.irradiance)) / static_cast<double>(truth.size());
            noise += std::pow(static_cast<double>(light.standard_error_lx), 2) / static_cast<double>(truth.size());
        }
    }

    LightSources sources{afternoon(), {}};
    Scene scene;
    RayScene rays;
    double area_m2;
    std::vector<ReceiverPoint> points;
    std::vector<IndirectLight> truth;
    double direct_mean = 0.0, mean = 0.0, noise = 0.0;  // lx, lx, lx²
};

struct Photons {
    Photons(const Judge& judge, std::uint64_t count) {
        const double begin = processor_seconds();
        SilentProgress silent;
        PhotonRun run = trace_photons(judge.sources, judge.scene, judge.rays, {count, kBounces, 0}, silent);
        trace_s = (processor_seconds() - begin);
        rays = run.ledger.rays;
        const auto traced = processor_seconds();
        map.emplace(std::move(run.photons));
        map_s = (processor_seconds() - traced);
    }
    double trace_s = 0.0, map_s = 0.0;
    std::uint64_t rays = 0;
    std::optional<PhotonMap> map;
};

struct Error {
    double bias = 0.0, rms = 0.0, gather_us = 0.0;  // lx, lx without the truth's noise, µs a point
};

Error error_of(const Judge& judge, const PhotonMap& map, const GatherOptions& options) {
    const PhotonGatherer gatherer(map, judge.rays, judge.area_m2, options);
    std::uint64_t feelers = 0;
    const double begin = processor_seconds();
    const std::vector<IndirectLight> light = gather_indirect(judge.points, gatherer, feelers);
    Error error;
    error.gather_us = 1e6 * (processor_seconds() - begin) / static_cast<double>(light.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double off = static_cast<double>(luminance(light[i].irradiance - judge.truth[i].irradiance));
        error.bias += off / static_cast<double>(light.size());
        squares += off * off / static_cast<double>(light.size());
    }
    error.rms = std::sqrt(std::max(0.0, squares - judge.noise));
    return error;
}

void print_estimators(const Judge& judge, std::uint64_t count) {
    const Photons photons(judge, count);
    const double total = judge.direct_mean + judge.mean;
    fmt::print(
        "{} points, {:.0f} lx of which {:.0f} lx are reflected; the truth's noise is {:.1f} % of these. {} photons, "
        "{} at rest on {:.0f} m2; {:.2f} s, map {:.2f} s\n\n",
        judge.points.size(), total, judge.mean, 100.0 * std::sqrt(judge.noise) / judge.mean, count,
        photons.map->photons().size(), judge.area_m2, photons.trace_s, photons.map_s);
    fmt::print(
        "| area | feelers | nearest | reflected: bias, % | RMS, % | all light: bias, % | RMS, % | gather, µs a point "
        "|\n"
        "|---|---|---|---|---|---|---|---|\n");
    for (const int nearest : {100, 200}) {
        for (std::size_t area = 0; area < kPhotonAreaNames.size(); ++area) {
            for (const int feelers : {0, 4, 8}) {
                const Error e = error_of(judge, *photons.map, {nearest, static_cast<PhotonArea>(area), feelers});
                fmt::print("| {} | {} | {} | {:+.1f} | {:.1f} | {:+.2f} | {:.2f} | {:.0f} |\n", kPhotonAreaNames[area],
                           feelers, nearest, 100.0 * e.bias / judge.mean, 100.0 * e.rms / judge.mean,
                           100.0 * e.bias / total, 100.0 * e.rms / total, e.gather_us);
            }
        }
    }
    fmt::print("\n");
}

/// Error against the time that photons take, one line an area with eight feelers.
struct Curve {
    std::string name;
    std::vector<std::pair<double, double>> seconds_and_percent;
};

std::string plot(const std::vector<Curve>& curves) {
    constexpr double kLeft = 60.0, kWidth = 380.0, kTop = 30.0, kHeight = 250.0;
    constexpr double kMinS = 0.05, kMaxS = 100.0, kMin = 0.5, kMax = 20.0;
    const auto x = [&](double s) { return kLeft + kWidth * std::log(s / kMinS) / std::log(kMaxS / kMinS); };
    const auto y = [&](double e) { return kTop + kHeight * std::log(kMax / e) / std::log(kMax / kMin); };
    std::string svg =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 560 330' font-family='sans-serif' font-size='11'>\n"
        "<rect width='560' height='330' fill='white'/>\n";
    for (const double e : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0})
        svg += fmt::format(
            "<line x1='{0:.0f}' x2='{1:.0f}' y1='{2:.1f}' y2='{2:.1f}' stroke='#ddd'/>"
            "<text x='{3:.0f}' y='{4:.1f}' text-anchor='end'>{5:g} %</text>\n",
            kLeft, kLeft + kWidth, y(e), kLeft - 6.0, y(e) + 4.0, e);
    for (const double s : {0.1, 1.0, 10.0, 100.0})
        svg += fmt::format("<text x='{:.1f}' y='{:.0f}' text-anchor='middle'>{:g} s</text>\n", x(s),
                           kTop + kHeight + 18.0, s);
    constexpr std::array kColors{"#2060c0", "#208040", "#d03030"};
    constexpr std::array kLabelOff{0.0, 12.0, 4.0};  // octagon and hull end in one place
    for (std::size_t i = 0; i < curves.size(); ++i) {
        std::string line, dots;
        for (const auto& [s, e] : curves[i].seconds_and_percent) {
            line += fmt::format("{:.1f},{:.1f} ", x(s), y(e));
            dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'/>", x(s), y(e), kColors[i]);
        }
        const auto [s, e] = curves[i].seconds_and_percent.back();
        svg += fmt::format(
            "<polyline fill='none' stroke='{0}' stroke-width='1.5' points='{1}'/>{2}"
            "<text x='{3:.1f}' y='{4:.1f}' fill='{0}'>{5}</text>\n",
            kColors[i], line, dots, x(s) + 8.0, y(e) + kLabelOff[i], curves[i].name);
    }
    return svg + fmt::format(
                     "<text x='{:.0f}' y='18'>RMS error of all light over its mean</text>"
                     "<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>photons and map, processor seconds: 0.1, 0.3, "
                     "1, 3, 10 "
                     "million photons</text>\n</svg>\n",
                     kLeft, kLeft + 0.5 * kWidth, kTop + kHeight + 38.0);
}

void print_counts(const Judge& judge, const char* svg) {
    const double total = judge.direct_mean + judge.mean;
    fmt::print(
        "| photons | at rest | a m2 | photons, CPU s | million rays a CPU s | map, CPU s | octagon: bias, RMS, % of "
        "all light | µs | "
        "hull | µs | circle | µs |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    std::vector<Curve> curves{{"octagon", {}}, {"hull", {}}, {"circle", {}}};
    for (const std::uint64_t count : {100'000, 300'000, 1'000'000, 3'000'000, 10'000'000}) {
        const Photons photons(judge, count);
        const double stored = static_cast<double>(photons.map->photons().size());
        fmt::print("| {} | {:.0f} | {:.1f} | {:.2f} | {:.1f} | {:.2f} |", count, stored, stored / judge.area_m2,
                   photons.trace_s, 1e-6 * static_cast<double>(photons.rays) / photons.trace_s, photons.map_s);
        for (std::size_t area = 0; area < curves.size(); ++area) {
            const Error e = error_of(judge, *photons.map, {200, static_cast<PhotonArea>(area), 8});
            fmt::print(" {:+.2f}, {:.2f} | {:.0f} |", 100.0 * e.bias / total, 100.0 * e.rms / total, e.gather_us);
            curves[area].seconds_and_percent.emplace_back(photons.trace_s + photons.map_s, 100.0 * e.rms / total);
        }
        fmt::print("\n");
    }
    fmt::print("\n");
    if (svg) std::ofstream(svg) << plot(curves);
}

std::vector<ReceiverPoint> grid(const Vec3f& lo, const Vec3f& u, const Vec3f& v, const Vec3f& normal) {
    constexpr int kSide = 16;
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < kSide * kSide; ++i)
        points.push_back({lo + (static_cast<float>(i % kSide) + 0.5f) / kSide * u +
                              (static_cast<float>(i / kSide) + 0.5f) / kSide * v,
                          normal});
    return points;
}

/// Where the plain circle errs: a dark passage behind the thin wall of a sunlit court, the foot of a wall, the edge of
/// a roof below a higher house.
void print_leaks(int paths) {
    struct Place {
        const char* name;
        Scene scene;
        std::vector<ReceiverPoint> points;
    };
    const Vec3f up(0, 0, 1);
    std::vector<Place> places;
    places.push_back({"passage behind a wall of 5 cm",
                      QuadScene()
                          .ground(30)
                          .box({-20, 0, 0}, {20, 0.05f, 3})
                          .box({-20, 3, 0}, {20, 3.5f, 3})
                          .box({-20, 0, 3}, {20, 3.5f, 3.2f})
                          .box({-20, -12, 0}, {20, -11, 1})
                          .scene(),
                      grid({-5, 0.2f, 0}, {10, 0, 0}, {0, 2.6f, 0}, up)});
    const Scene houses = QuadScene().ground(30).box({-6, 0, 0}, {6, 8, 6}).box({-6, 8, 0}, {6, 14, 14}).scene();
    places.push_back({"ground within 1 m of a sunlit wall", houses, grid({-5, -1, 0}, {10, 0, 0}, {0, 1, 0}, up)});
    places.push_back({"wall within 1 m of its foot", houses, grid({-5, 0, 0}, {10, 0, 0}, {0, 0, 1}, {0, -1, 0})});
    places.push_back({"roof within 1 m of its edge", houses, grid({-5, 0, 6}, {10, 0, 0}, {0, 1, 0}, up)});
    fmt::print(
        "| place | truth, lx | area | bias without feelers, % | 4 feelers | 8 feelers |\n|---|---|---|---|---|---|\n");
    for (Place& place : places) {
        const Judge judge(std::move(place.scene), place.points, paths);
        const Photons photons(judge, 1'000'000);
        for (std::size_t area = 0; area < kPhotonAreaNames.size(); ++area) {
            fmt::print("| {} | {:.0f} | {} |", place.name, judge.mean, kPhotonAreaNames[area]);
            for (const int feelers : {0, 4, 8})
                fmt::print(" {:+.1f} |",
                           100.0 * error_of(judge, *photons.map, {200, static_cast<PhotonArea>(area), feelers}).bias /
                               judge.mean);
            fmt::print("\n");
        }
    }
    fmt::print("\n");
}

int run(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: bench_photons CITY [RADIUS_M [POINTS [PATHS [SVG]]]]\n");
        return 2;
    }
    const int paths = argc > 4 ? std::atoi(argv[4]) : 4096;
    print_leaks(paths);
    Scene scene = load_scene(argv[1], argc > 2 ? std::atof(argv[2]) : 1e6, 0.5f);
    FindingLog findings;
    SilentProgress silent;
    load_albedo_images(scene, findings, silent);
    const Judge judge(std::move(scene), argc > 3 ? static_cast<std::size_t>(std::atoll(argv[3])) : 4000, paths);
    print_estimators(judge, default_photon_count(judge.scene));
    print_counts(judge, argc > 5 ? argv[5] : nullptr);
    return 0;
}

}  // namespace
}  // namespace skybake::bench

int main(int argc, char** argv) {
    return skybake::bench::run(argc, argv);
}
