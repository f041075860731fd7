// skybake probe: sun and sky at free points, by the estimators of the bake.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "api/bake_city.h"
#include "base/error.h"
#include "base/threads.h"
#include "city_options.h"
#include "io/points/points_csv.h"
#include "light/point_light.h"
#include "light_options.h"
#include "program.h"

namespace skybake::cli {

namespace {

struct Options {
    CityOptions city;
    LightOptions light;
    std::filesystem::path points;
    std::filesystem::path output;
};

int run(const CommonOptions& common, const Options& options) {
    check_light_options(options.light);
    const ThreadLimit threads(common.threads);
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<io::ProbePoint> points = io::read_points(options.points);
    ConsoleProgress progress(common);
    LoadedCity loaded = load_city(options.city.files, options.city.load_options(), progress);
    const std::vector<Daylight> daylights =
        daylights_of(options.light, loaded.georeference.site, loaded.georeference.convergence_rad, loaded.findings);
    if (daylights.size() != 1)
        throw InputError("probe answers for one instant: give --at a single time, or call it once for each.");
    const Scene scene =
        build_scene(loaded.city, scene_options(parse_albedo(options.light.albedo), 0.5f), loaded.findings);
    const RayScene rays(scene);

    std::vector<ReceiverPoint> receivers;
    for (const io::ProbePoint& point : points)
        receivers.push_back({Vec3f(point.position - scene.origin), Vec3f(point.normal)});
    const DomeSampler sampler(daylights);
    const Daylight& daylight = daylights.front();
    const std::vector<PointLight> light =
        light_points(receivers, sampler, 0, daylight.sun, rays, {options.light.sky_samples, 64});
    std::vector<io::ProbeLight> rows;
    for (const PointLight& point : light) {
        io::ProbeLight row;
        row.sun_lx = static_cast<double>(luminance(point.sun));
        row.sky_lx = static_cast<double>(luminance(point.sky));
        row.total = point.sun + point.sky;
        row.sun_visible = static_cast<double>(point.sun_visible);
        row.sky_view_factor = static_cast<double>(point.sky_view_factor);
        rows.push_back(row);
    }
    const int exit_code = report_findings(common, loaded.findings);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    say(common,
        fmt::format("{} points, {} directions each, {:.1f} s", points.size(), options.light.sky_samples, seconds));
    if (!options.output.empty()) {
        io::write_probe_csv(options.output, points, rows);
    } else if (!common.wants_json) {
        fmt::print("{}", io::probe_csv(points, rows));
    }
    if (common.wants_json) {
        print_json({{"points", points.size()},
                    {"instant", daylight.label},
                    {"sky_samples", options.light.sky_samples},
                    {"seconds", seconds},
                    {"findings", to_json(loaded.findings)}});
    }
    return exit_code;
}

}  // namespace

void add_probe(CLI::App& app, Program& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* verb = add_verb(
        app, program, "probe", "Light at points of a CSV (id,x,y,z,nx,ny,nz in map coordinates), without a lightmap.",
        "  skybake probe town.city.json --points points.csv --at 2026-06-21T12:00+02:00\n"
        "  skybake probe town.city.json --points points.csv --sky uniform:luminance=1000 --sun none -o light.csv",
        [&program, options] { return run(program.common, *options); });
    add_city_options(verb, options->city);
    add_light_options(verb, options->light);
    verb->add_option("--points", options->points, "CSV with the points")->required();
    verb->add_option("-o,--output", options->output, "CSV to write; without it, stdout");
}

}  // namespace skybake::cli
