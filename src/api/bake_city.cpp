#include "api/bake_city.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "api/default_views.h"
#include "api/load_albedo.h"
#include "base/error.h"
#include "io/lamps/read_lamps.h"
#include "sky/sky_panorama.h"
#include "sky/utc_time.h"

namespace skybake {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

std::size_t count_buildings(const Scene& scene) {
    std::set<std::string_view> buildings;
    for (const SceneObject& object : scene.objects) {
        if (is_building(object.type)) buildings.insert(object.building_id);
    }
    return buildings.size();
}

io::BakeDescription describe(const BakeCityOptions& options, const LoadedCity& loaded, const RayScene& rays,
                             const std::vector<Daylight>& daylights, std::vector<io::BakeView> views) {
    io::BakeDescription description;
    description.version = options.version;
    description.title = options.files.front().stem().stem().string();
    description.crs = loaded.georeference.crs_name;
    description.site = site_of_light(options.daylight, options.site ? options.site : loaded.georeference.site);
    description.convergence_rad = loaded.georeference.convergence_rad;
    description.seed = options.seed;
    description.sky_samples = static_cast<std::uint64_t>(options.bake.sky_samples);
    description.sampling = kSkySamplingNames[static_cast<std::size_t>(options.bake.sampling)];
    description.tolerance =
        options.bake.sampling == SkySampling::hierarchical ? static_cast<double>(options.bake.tolerance) : 0.0;
    description.settings = options.settings;
    description.inputs = options.files;
    if (options.daylight.weather) description.inputs.push_back(options.daylight.weather->file);
    description.isa = rays.isa();
    description.views = std::move(views);
    for (std::size_t k = 0; k < daylights.size(); ++k) {
        io::InstantDescription instant;
        if (k < options.daylight.instants.size()) instant.utc = to_iso8601({options.daylight.instants[k].utc, 0});
        instant.sky_model = to_text(sky_at(options.daylight, k));
        instant.sky_panorama = sky_panorama(daylights[k].sky, io::kPanoramaWidth, io::kPanoramaHeight);
        instant.land_luminance = land_luminance(daylights[k]);
        if (!std::holds_alternative<NoSky>(daylights[k].sky)) instant.air = air_under(daylights[k]);
        description.instants.push_back(std::move(instant));
    }
    return description;
}

}  // namespace

SceneOptions scene_options(const std::vector<std::pair<std::string, Rgb>>& albedo, float texel_m) {
    SceneOptions options;
    // A piece of a thousand texels fits a page however its chart is turned.
    options.max_piece_m = std::min(options.max_piece_m, 1000.0f * texel_m);
    const auto stated = [&](const std::string& name) {
        return std::find_if(albedo.begin(), albedo.end(), [&](const auto& entry) { return entry.first == name; });
    };
    for (int i = 0; i <= static_cast<int>(SurfaceType::other); ++i) {
        const SurfaceType type = static_cast<SurfaceType>(i);
        auto entry = stated(name_of(type));
        // Who says "ground" means what one walks on.
        if (entry == albedo.end() && (type == SurfaceType::terrain || type == SurfaceType::road))
            entry = stated(name_of(SurfaceType::ground));
        if (entry == albedo.end()) entry = stated("default");
        if (entry != albedo.end()) options.albedo_override.emplace_back(type, entry->second);
    }
    return options;
}

BakeCityResult bake_city(const BakeCityOptions& options, Progress& progress) {
    io::check_output_folder(options.output);
    const auto begin = Clock::now();
    BakeCityResult result;
    LoadedCity loaded = load_city(options.files, options.load, progress);
    result.findings = std::move(loaded.findings);
    result.report.seconds.read = seconds_since(begin);

    const std::optional<Site> site = options.site ? options.site : loaded.georeference.site;
    const std::vector<Daylight> daylights =
        make_daylights(options.daylight, site, loaded.georeference.convergence_rad, result.findings);

    const auto build_begin = Clock::now();
    SceneOptions how = scene_options(options.albedo, options.texel_m);
    apply_crown_settings(options.crowns, options.daylight, site_of_light(options.daylight, site), how);
    Scene scene = build_scene(loaded.city, how, result.findings);
    io::AttributesOf attributes = io::attributes_of(loaded.city);
    loaded.city = CityModel();  // its memory is wanted for the light
    if (scene.triangles.empty())
        throw InputError(fmt::format("{}: no surface is left to light; see the findings of skybake check.",
                                     options.files.front().string()));
    if (options.bake.bounces) load_albedo_images(scene, result.findings, progress);
    BakeOptions bake = options.bake;
    io::LampFile lamps;
    if (!options.lamps.empty()) {
        lamps = io::read_lamps(options.lamps, scene.origin, options.lamps_origin, result.findings);
        bake.lamps = lamps.lamps;
    }
    const RayScene rays(scene);
    result.report.seconds.build = seconds_since(build_begin);

    const auto charts_begin = Clock::now();
    const Atlas atlas = build_atlas(scene, {options.texel_m});
    result.report.seconds.charts = seconds_since(charts_begin);
    result.report.buildings = count_buildings(scene);
    result.report.triangles = scene.triangles.size();
    result.report.charts = atlas.charts.size();
    result.report.pages = atlas.pages.size();
    result.report.texels = atlas.texel_count();
    result.report.texel_m = static_cast<double>(options.texel_m);

    const Lightmaps light = bake_lightmaps(scene, atlas, rays, daylights, bake, progress, result.report);

    const auto write_begin = Clock::now();
    io::BakeDescription description =
        describe(options, loaded, rays, daylights, default_views(scene, atlas, light, rays));
    description.attributes = std::move(attributes);
    // The season may have been taken from the instants.
    if (!scene.crowns.empty())
        description.settings.emplace_back("crown-transmissivity-taken", fmt::format("{}", how.crown_transmissivity));
    description.inputs.insert(description.inputs.end(), lamps.files.begin(), lamps.files.end());
    result.written =
        io::write_bake(options.output, {scene, atlas, light, description, result.report, result.findings}, progress);
    result.report.seconds.write = seconds_since(write_begin);
    result.report.seconds.total = seconds_since(begin);
    result.report.peak_rss_bytes = peak_rss_bytes();
    return result;
}

}  // namespace skybake
