// skybake probe: light at free points: sun and sky by the estimators of the bake, lamps, and reflected light.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "api/bake_city.h"
#include "api/load_albedo.h"
#include "base/error.h"
#include "base/threads.h"
#include "bounce_options.h"
#include "city_options.h"
#include "io/lamps/read_lamps.h"
#include "io/points/points_csv.h"
#include "lamp_options.h"
#include "light/point_light.h"
#include "light_options.h"
#include "program.h"

namespace skybake::cli {

namespace {

struct Options {
    CityOptions city;
    LightOptions light;
    BounceOptions bounce;
    LampOptions lamps;
    std::filesystem::path points;
    std::filesystem::path output;
};

std::vector<IndirectLight> indirect_by_photons(std::span<const ReceiverPoint> points, const LightSources& sources,
                                               const Scene& scene, const RayScene& rays, const BouncePhotons& settings,
                                               Progress& progress, nlohmann::json& report) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    PhotonRun run = trace_photons(sources, scene, rays, settings.photons, progress);
    const auto traced = Clock::now();
    const PhotonMap map(std::move(run.photons));
    const auto sorted = Clock::now();
    const PhotonGatherer gatherer(map, rays, surface_area(scene), settings.gather);
    std::uint64_t feelers = 0;
    std::vector<IndirectLight> light = gather_indirect(points, gatherer, feelers);
    const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
    const PhotonLedger& l = run.ledger;
    report = {
        {"photons", l.photons},
        {"stored", map.photons().size()},
        {"rays", {{"photon", l.rays}, {"feeler", feelers}}},
        {"lumen", {{"emitted", l.emitted}, {"absorbed", l.absorbed}, {"escaped", l.escaped}, {"at_limit", l.at_limit}}},
        {"seconds",
         {{"photons", seconds(traced - begin)},
          {"map", seconds(sorted - traced)},
          {"gather", seconds(Clock::now() - sorted)}}}};
    return light;
}

int run(const CommonOptions& common, const Options& options) {
    check_light_options(options.light);
    const Indirect indirect = indirect_of(options.bounce);
    const ThreadLimit threads(common.threads);
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<io::ProbePoint> points = io::read_points(options.points);
    ConsoleProgress progress(common);
    LoadedCity loaded = load_city(options.city.files, options.city.load_options(), progress);
    const std::vector<Daylight> daylights =
        daylights_of(options.light, loaded.georeference.site, loaded.georeference.convergence_rad, loaded.findings);
    if (daylights.size() != 1)
        throw InputError("probe answers for one instant: give --at a single time, or call it once for each.");
    SceneOptions how = scene_options(parse_albedo(options.light.albedo), 0.5f);
    const DaylightSettings asked = daylight_settings_of(options.light);
    apply_crown_settings(crown_settings_of(options.light), asked,
                         site_of_light(asked, site_of(options.light, loaded.georeference.site)), how);
    Scene scene = build_scene(loaded.city, how, loaded.findings);
    if (indirect != Indirect::none) load_albedo_images(scene, loaded.findings, progress);
    const RayScene rays(scene);

    std::vector<ReceiverPoint> receivers;
    for (const io::ProbePoint& point : points)
        receivers.push_back({Vec3f(point.position - scene.origin), Vec3f(point.normal)});
    const DomeSampler sampler(daylights);
    const Daylight& daylight = daylights.front();
    const std::vector<PointLight> light =
        light_points(receivers, sampler, 0, daylight.sun, rays, {options.light.sky_samples, 64});
    LightSources sources{daylight, {}};
    if (!options.lamps.file.empty())
        sources.lamps =
            io::read_lamps(options.lamps.file, scene.origin, origin_of(options.lamps), loaded.findings).lamps;
    const std::vector<Rgb> by_lamps = light_points_by_lamps(receivers, sources.lamps, rays);
    std::vector<IndirectLight> reflected(receivers.size());
    nlohmann::json bounces;
    if (indirect == Indirect::photons) {
        const BouncePhotons settings = photons_of(options.bounce, common.seed);
        reflected = indirect_by_photons(receivers, sources, scene, rays, settings, progress, bounces);
    }
    if (indirect == Indirect::reference)
        reflected = PathReference(sources, scene, rays, path_options_of(options.bounce, common.seed))
                        .light(receivers, progress);
    std::vector<io::ProbeLight> rows;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const PointLight& point = light[i];
        io::ProbeLight row;
        row.indirect_lx = static_cast<double>(luminance(reflected[i].irradiance));
        row.indirect_error_lx = static_cast<double>(reflected[i].standard_error_lx);
        row.sun_lx = static_cast<double>(luminance(point.sun));
        row.sky_lx = static_cast<double>(luminance(point.sky));
        row.lamps_lx = static_cast<double>(luminance(by_lamps[i]));
        row.total = point.sun + point.sky + by_lamps[i] + reflected[i].irradiance;
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
        nlohmann::json object = {{"points", points.size()},
                                 {"instant", daylight.label},
                                 {"sky_samples", options.light.sky_samples},
                                 {"seconds", seconds},
                                 {"findings", to_json(loaded.findings)}};
        if (!bounces.is_null()) object["bounces"] = bounces;
        print_json(object);
    }
    return exit_code;
}

}  // namespace

void add_probe(CLI::App& app, Program& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* verb = add_verb(
        app, program, "probe", "Light at points of a CSV (id,x,y,z,nx,ny,nz in map coordinates), without a lightmap.",
        "  skybake probe town.city.json --points points.csv --at 2026-06-21T12:00+02:00\n"
        "  skybake probe town.city.json --points points.csv --sky uniform:luminance=1000 --sun none -o light.csv\n"
        "  skybake probe town.city.json --points points.csv --sun-direction 200,35 --indirect reference --paths 4096",
        [&program, options] { return run(program.common, *options); });
    add_city_options(verb, options->city);
    add_light_options(verb, options->light);
    add_bounce_options(verb, options->bounce);
    add_lamp_options(verb, options->lamps);
    verb->add_option("--points", options->points, "CSV with the points")->required();
    verb->add_option("-o,--output", options->output, "CSV to write; without it, stdout");
}

}  // namespace skybake::cli
