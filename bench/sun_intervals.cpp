// How exact and how fast sunny intervals are: against a ray at every second for façade points of a city, and for all
// its cells. Usage: bench_sun_intervals CITY [CELL_M]
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "api/load_city.h"
#include "base/hash_rng.h"
#include "study/receivers.h"
#include "study/sun_intervals.h"

namespace skybake {
namespace {

constexpr std::size_t kPoints = 1000;

struct Agreement {
    std::uint64_t ends = 0, found = 0;
    double missed_s = 0.0;                           // sun or shade that the intervals get wrong
    double worst_sun_min = 0.0, mean_sun_min = 0.0;  // error of a point's sun hours
};

Agreement agreement(const SunIntervals& intervals, const std::vector<std::vector<char>>& sunny) {
    Agreement a;
    for (std::size_t i = 0; i < sunny.size(); ++i) {
        const auto own = intervals.of(i);
        double brute_s = 0.0, own_s = 0.0;
        for (const SunInterval& interval : own) own_s += static_cast<double>(interval.end_s - interval.begin_s);
        for (std::size_t s = 1; s < sunny[i].size(); ++s) {
            if (s > 1) brute_s += sunny[i][s];
            if (sunny[i][s] == sunny[i][s - 1]) continue;
            ++a.ends;
            const float at = static_cast<float>(s) - 0.5f;
            a.found += std::any_of(own.begin(), own.end(), [&](const SunInterval& interval) {
                return std::abs((sunny[i][s] ? interval.begin_s : interval.end_s) - at) <= 2.0f;
            });
        }
        const double error_min = std::abs(own_s - brute_s) / 60.0;
        a.worst_sun_min = std::max(a.worst_sun_min, error_min);
        a.mean_sun_min += error_min / static_cast<double>(sunny.size());
        std::size_t next = 0;
        for (std::size_t s = 0; s < sunny[i].size(); ++s) {
            const float t = static_cast<float>(s);
            while (next < own.size() && own[next].end_s <= t) ++next;
            const bool is_in = next < own.size() && own[next].begin_s <= t;
            a.missed_s += is_in != static_cast<bool>(sunny[i][s]);
        }
    }
    return a;
}

void print(const char* name, double step, const Agreement& a, std::uint64_t rays, std::size_t points) {
    fmt::print("| {} {:g} s | {} | {:.3f} % | {:.2f} s | {:.3f} min | {:.1f} min | {:.0f} |\n", name, step, a.ends,
               100.0 * static_cast<double>(a.found) / static_cast<double>(a.ends),
               a.missed_s / static_cast<double>(points), a.mean_sun_min, a.worst_sun_min,
               static_cast<double>(rays) / static_cast<double>(points));
}

int run(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: {} CITY [CELL_M]\n", argv[0]);
        return 2;
    }
    const double cell_m = argc > 2 ? std::atof(argv[2]) : 1.0;
    SilentProgress silent;
    const std::array<std::filesystem::path, 1> files{argv[1]};
    LoadedCity loaded = load_city(files, {}, silent);
    const Scene scene = build_scene(loaded.city, {}, loaded.findings);
    const RayScene rays(scene);
    const Site site = loaded.georeference.site.value();
    const double convergence = loaded.georeference.convergence_rad;
    const ReceiverSet facades = make_receivers(scene, rays, {.kinds = {ReceiverKind::facade}, .cell_m = 1.0});
    // Whole packets, as a study traces them, from all over the city.
    const std::vector<PacketRange> packets = packet_ranges(facades.samples);
    std::vector<Sample> points;
    for (std::size_t i = 0; points.size() < kPoints; ++i) {
        const double u = static_cast<double>(uniform_float(0, i, 0, 0));
        const PacketRange& range = packets[static_cast<std::size_t>(u * static_cast<double>(packets.size()))];
        points.insert(points.end(), facades.samples.begin() + range.begin, facades.samples.begin() + range.end);
    }
    fmt::print("{} points of {} facade cells, in whole packets\n", points.size(), facades.samples.size());
    for (const CalendarDay date : {CalendarDay{3, 21}, CalendarDay{6, 21}, CalendarDay{12, 21}}) {
        const SunDay day(2026, date, site, convergence, {});
        std::vector<std::vector<char>> sunny(points.size());
        tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
            const Sample& point = points[i];
            const Vec3f origin = Vec3f(point.position - scene.origin) + rays.surface_offset() * point.normal;
            for (int s = 0; s <= day.length_s(); ++s) {
                const Vec3f direction = day.direction(s);
                sunny[i].push_back(glm::dot(direction, point.normal) > 0.0f && !rays.is_occluded(origin, direction));
            }
        });
        fmt::print(
            "\n{:02}-{:02}, {:.2f} h\n| step | ends | within 2 s | wrong a point | sun hours off, mean | most | rays a "
            "point |\n"
            "|---|---|---|---|---|---|---|\n",
            date.month, date.day, day.hours());
        for (const double scan : {30.0, 60.0, 120.0, 240.0}) {
            const SunIntervals found = sun_intervals(points, day, scene.origin, rays, {.scan_s = scan}, silent);
            print("exact, scan", scan, agreement(found, sunny), found.rays, points.size());
        }
        for (const double step : {360.0, 900.0, 3600.0}) {
            const SunIntervals found =
                sun_intervals(points, day, scene.origin, rays,
                              {.sampled = SampledConstruction{step, BetweenSamples::nearest}}, silent);
            print("sampled", step, agreement(found, sunny), found.rays, points.size());
        }
    }
    const SunDay day(2026, {3, 21}, site, convergence, {});
    fmt::print("\nAll cells, one day:\n| cells | of m | rays | s | million rays/s |\n|---|---|---|---|---|\n");
    const ReceiverSet all = make_receivers(
        scene, rays, {.kinds = {ReceiverKind::ground, ReceiverKind::roof, ReceiverKind::facade}, .cell_m = cell_m});
    const auto begin = std::chrono::steady_clock::now();
    const SunIntervals found = sun_intervals(all.samples, day, scene.origin, rays, {}, silent);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fmt::print("| {} | {} | {:.3g} | {:.1f} | {:.1f} |\n", all.samples.size(), cell_m, static_cast<double>(found.rays),
               seconds, 1e-6 * static_cast<double>(found.rays) / seconds);
    return 0;
}

}  // namespace
}  // namespace skybake

int main(int argc, char** argv) {
    return skybake::run(argc, argv);
}
