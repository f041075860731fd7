#include "io/manifest/write_bake.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <system_error>

#include "base/check.h"
#include "base/error.h"
#include "io/exr/exr.h"
#include "io/file/replace_file.h"
#include "io/manifest/compare_bakes.h"
#include "io/manifest/names.h"
#include "io/manifest/sha256.h"
#include "io/manifest/web_pages.h"

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
std::vector<std::uint8_t> bytes_of(const std::vector<T>& values) {
    std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

void write_base(const std::filesystem::path& path, const LightmapPage& page) {
    std::vector<ExrChannel> channels{
        {"state", ExrType::uint32}, {"chart", ExrType::uint32}, {"sky_view_factor", ExrType::float32}};
    if (!page.lamps.empty()) {
        for (const char* name : {"lamps.R", "lamps.G", "lamps.B"}) channels.push_back({name, ExrType::float32});
    }
    const std::size_t width = static_cast<std::size_t>(page.width);
    write_exr(path, page.width, page.height, channels,
              [&](int row, std::span<std::uint32_t> samples) {
                  const std::size_t first = static_cast<std::size_t>(row) * width;
                  for (std::size_t x = 0; x < width; ++x) {
                      const bool is_empty = page.state[first + x] == TexelState::empty;
                      samples[x] = static_cast<std::uint32_t>(page.state[first + x]);
                      samples[width + x] = is_empty ? 0 : page.chart[first + x].value;
                      samples[2 * width + x] =
                          std::bit_cast<std::uint32_t>(is_empty ? 0.0f : page.sky_view_factor[first + x]);
                      for (int c = 0; c < 3 && !page.lamps.empty(); ++c)
                          samples[static_cast<std::size_t>(3 + c) * width + x] =
                              std::bit_cast<std::uint32_t>(page.lamps[first + x][c]);
                  }
              },
              {{"skybake.state", "0 empty, 1 chart, 2 buried, 3 gutter"}});
}

/// Reflected light was asked for.
bool has_indirect(const Lightmaps& light) {
    return !light.instants.empty() && !light.instants[0].pages.empty() && !light.instants[0].pages[0].indirect.empty();
}

bool has_lamps(const Lightmaps& light) {
    return !light.pages.empty() && !light.pages[0].lamps.empty();
}

void write_light(const std::filesystem::path& path, const Lightmaps& light, std::size_t instant, std::size_t page) {
    std::vector<ExrChannel> channels;
    std::vector<std::string> layers{"", "sun.", "sky."};
    if (has_indirect(light)) layers.emplace_back("indirect.");
    for (const std::string& layer : layers) {
        for (const char* color : {"R", "G", "B"}) channels.push_back({layer + color, ExrType::float32});
    }
    const std::size_t width = static_cast<std::size_t>(light.pages[page].width);
    const LightmapLayer& layer = light.instants[instant].pages[page];
    std::vector<const std::vector<float>*> extras;
    for (const auto& [name, values] :
         {std::pair("indirect.error", &layer.indirect_error), {"indirect.leak", &layer.leak}}) {
        if (values->empty()) continue;
        channels.push_back({name, ExrType::float32});
        extras.push_back(values);
    }
    const std::size_t colors = 3 * layers.size();
    const Rgb beam = light.instants[instant].daylight.sun.normal_illuminance;
    write_exr(path, light.pages[page].width, light.pages[page].height, channels,
              [&](int row, std::span<std::uint32_t> samples) {
                  const std::size_t first = static_cast<std::size_t>(row) * width;
                  for (std::size_t x = 0; x < width; ++x) {
                      const Rgb total = total_irradiance(light, instant, page, first + x);
                      const Rgb sun = layer.sun_cosine[first + x] * beam;
                      const Rgb& sky = layer.sky[first + x];
                      for (int c = 0; c < 3; ++c) {
                          const std::size_t at = static_cast<std::size_t>(c) * width + x;
                          samples[at] = std::bit_cast<std::uint32_t>(total[c]);
                          samples[3 * width + at] = std::bit_cast<std::uint32_t>(sun[c]);
                          samples[6 * width + at] = std::bit_cast<std::uint32_t>(sky[c]);
                          if (!layer.indirect.empty())
                              samples[9 * width + at] = std::bit_cast<std::uint32_t>(layer.indirect[first + x][c]);
                      }
                      for (std::size_t k = 0; k < extras.size(); ++k)
                          samples[(colors + k) * width + x] = std::bit_cast<std::uint32_t>((*extras[k])[first + x]);
                  }
              },
              {{"skybake.unit", "lx per channel, linear Rec. 709"},
               {"skybake.instant", light.instants[instant].daylight.label}});
}

/// Luminances in kcd/m² as R, G, B, 1.
void append_halves(std::vector<std::uint16_t>& halves, const std::vector<Rgb>& luminances) {
    for (const Rgb& pixel : luminances) {
        for (int c = 0; c < 3; ++c) halves.push_back(half_from_float(1e-3f * pixel[c]));
        halves.push_back(half_from_float(1.0f));
    }
}

std::vector<std::uint8_t> panorama_bytes(const std::vector<Rgb>& panorama) {
    std::vector<std::uint16_t> halves;
    append_halves(halves, panorama);
    return bytes_of(halves);
}

std::vector<std::uint8_t> air_bytes(const Air& air) {
    std::vector<std::uint16_t> halves;
    append_halves(halves, air.molecule_airlight);
    append_halves(halves, air.haze_airlight);
    return bytes_of(halves);
}

std::vector<std::uint8_t> scale_bytes(const std::vector<ChartScale>& scales) {
    std::vector<float> values;
    values.reserve(2 * scales.size());
    for (const ChartScale& scale : scales) values.insert(values.end(), {scale.sky_klx, scale.sun_cosine});
    return bytes_of(values);
}

/// Takes away what makes the folder a bake, then what an older bake, or one that was killed, wrote below the names that
/// are ours.
void clear_old_bake(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder / names::kLightFolder, error);
    if (error)
        throw InputError(fmt::format("{}: cannot be made ({}). Choose another place.",
                                     (folder / names::kLightFolder).string(), error.message()));
    const auto remove = [&](const std::filesystem::path& path) {
        std::filesystem::remove(path, error);
        if (error)
            throw InputError(
                fmt::format("{}: of an older bake, cannot be removed ({}).", path.string(), error.message()));
    };
    remove(folder / names::kManifest);
    for (const char* name : {names::kManifest, names::kCity, names::kObjects})
        remove(folder / (std::string(name) + ".part"));
    for (const char* name : {names::kCity, names::kObjects}) remove(folder / name);
    static const std::regex ours(
        "(p[0-9]+_(base\\.exr|svf\\.png|lamps\\.png)|lamp_scales\\.bin|i[0-9]+_(p[0-9]+(\\.exr|_sky\\.png|_sun\\.png|_"
        "indirect\\.png|_leaks\\.png)|scales\\.bin|"
        "indirect_scales\\.bin|sky\\.bin|air\\.bin))(\\."
        "part)?");
    static const std::regex layers("[a-z0-9_.-]+_[0-9]+\\.(png|exr)(\\.part)?");
    std::vector<std::filesystem::path> old;
    const auto find_old = [&](const std::filesystem::path& below, const std::regex& names) {
        for (const auto& entry : std::filesystem::directory_iterator(below, error)) {
            if (std::regex_match(entry.path().filename().string(), names)) old.push_back(entry.path());
        }
    };
    find_old(folder / names::kLightFolder, ours);
    find_old(folder / names::kLayerFolder, layers);
    for (const std::filesystem::path& path : old) remove(path);
}

/// The double that has the float's shortest decimals: 0.1, not 0.10000000149011612.
double shortest(float value) {
    return std::stod(fmt::format("{}", value));
}

Json to_json(const Vec3f& v) {
    return {shortest(v.x), shortest(v.y), shortest(v.z)};
}
Json to_json(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

const char* name_of(SunShape shape) {
    switch (shape) {
        case SunShape::point:
            return "point";
        case SunShape::disc:
            return "disc";
        case SunShape::none:
            break;
    }
    return "none";
}

Json sun_json(const SunBeam& sun) {
    const Vec3d d(sun.direction);
    const double azimuth = degrees_from_radians(std::atan2(d.x, d.y));
    return {{"shape", name_of(sun.shape)},
            {"azimuth_deg", azimuth < 0.0 ? azimuth + 360.0 : azimuth},
            {"elevation_deg", degrees_from_radians(std::asin(std::clamp(d.z, -1.0, 1.0)))},
            {"direction", to_json(sun.direction)},
            {"normal_illuminance_klx", to_json(1e-3 * Vec3d(sun.normal_illuminance))},
            {"dni_w_m2", shortest(sun.dni_w_m2)},
            {"angular_radius_deg", degrees_from_radians(static_cast<double>(sun.angular_radius_rad))}};
}

Json to_json(const LeakReport& leaks) {
    const LeakReport::Place& w = leaks.worst;
    return {{"texels", leaks.texels},
            {"area_m2", leaks.area_m2},
            {"lumen", leaks.lumen},
            {"picture_range_lx", leaks.picture_range_lx},
            {"worst",
             {{"instant", w.instant},
              {"page", w.page},
              {"column", w.column},
              {"row", w.row},
              {"leak_lx", w.leak_lx},
              {"total_lx", w.total_lx}}}};
}

/// The figures that come out the same whenever the bake is repeated.
Json report_json(const BakeReport& r) {
    Json json = {{"buildings", r.buildings},
                 {"triangles", r.triangles},
                 {"charts", r.charts},
                 {"pages", r.pages},
                 {"texels", r.texels},
                 {"texel_m", r.texel_m},
                 {"rays",
                  {{"sun", r.rays.sun},
                   {"sky", r.rays.sky},
                   {"lamp", r.rays.lamp},
                   {"photon", r.rays.photon},
                   {"feeler", r.rays.feeler}}},
                 {"evaluated_fraction", r.evaluated_fraction},
                 {"predicted_rmse_over_mean", r.predicted_rmse_over_mean}};
    if (r.lamps > 0) {
        json["lamps"] = r.lamps;
        json["lamps_refined_fraction"] = r.lamps_refined_fraction;
    }
    if (r.indirect_evaluated_fraction > 0.0) {
        json["indirect_evaluated_fraction"] = r.indirect_evaluated_fraction;
        json["indirect_lx"] = {{"mean", r.indirect.mean_lx}, {"standard_error", r.indirect.error_lx}};
    }
    if (r.leaks) json["leaks"] = to_json(*r.leaks);
    if (r.photons.emitted > 0.0) {
        json["photons_stored"] = r.photons.stored;
        json["photon_lumen"] = {{"emitted", r.photons.emitted},
                                {"absorbed", r.photons.absorbed},
                                {"escaped", r.photons.escaped},
                                {"at_limit", r.photons.at_limit}};
    }
    return json;
}

Json findings_json(const FindingLog& findings) {
    Json list = Json::array();
    for (const Finding& f : findings.list()) {
        list.push_back({{"code", f.code},
                        {"severity", skybake::name_of(f.severity)},
                        {"where", f.where},
                        {"what", f.what},
                        {"remedy", f.remedy},
                        {"count", f.count}});
    }
    return list;
}

Box3f bounds_of(const Scene& scene) {
    return scene.bounds.is_empty() ? Box3f{Vec3f(0.0f), Vec3f(0.0f)} : scene.bounds;
}

Json air_json(const Air& air, const BakeOutput& output, std::size_t instant) {
    return {{"turbidity", output.light.instants[instant].daylight.turbidity},
            {"base_m", shortest(bounds_of(output.scene).lo.z)},
            {"molecules_per_m", to_json(air.scattering.molecules)},
            {"haze_per_m", to_json(air.scattering.haze)},
            {"molecule_height_m", kMoleculeHeight},
            {"haze_height_m", kHazeHeight},
            {"airlight",
             {{"uri", names::air(instant)},
              {"columns", air.columns},
              {"rows", air.rows},
              {"format", "rgba16f"},
              {"unit", "kcd/m2"}}}};
}

Json instant_json(const BakeOutput& output, std::size_t instant, double exposure) {
    const InstantDescription& description = output.description.instants[instant];
    Json pages = Json::array();
    for (std::size_t p = 0; p < output.light.pages.size(); ++p) {
        pages.push_back(
            {{"exr", names::light(instant, p)}, {"sky", names::sky(instant, p)}, {"sun", names::sun(instant, p)}});
    }
    if (has_indirect(output.light)) {
        for (std::size_t p = 0; p < pages.size(); ++p) pages[p]["indirect"] = names::indirect(instant, p);
    }
    Json json = {{"label", output.light.instants[instant].daylight.label}};
    if (description.utc) json["utc"] = *description.utc;
    json["sun"] = sun_json(output.light.instants[instant].daylight.sun);
    json["sky"] = {{"model", description.sky_model},
                   {"panorama",
                    {{"uri", names::panorama(instant)},
                     {"width", kPanoramaWidth},
                     {"height", kPanoramaHeight},
                     {"format", "rgba16f"},
                     {"unit", "kcd/m2"}}},
                   {"land_kcd_m2", to_json(1e-3f * description.land_luminance)}};
    if (description.air) json["air"] = air_json(*description.air, output, instant);
    json["scales"] = {{"uri", names::scales(instant)}};
    if (has_indirect(output.light)) json["indirect_scales"] = {{"uri", names::indirect_scales(instant)}};
    json["exposure_hint"] = exposure;
    json["pages"] = pages;
    return json;
}

Json manifest_json(const BakeOutput& output, const std::vector<FileHash>& hashes, const std::vector<double>& exposures,
                   const Json& files) {
    const BakeDescription& d = output.description;
    Json site = nullptr;
    if (d.site) {
        site = {{"latitude_deg", degrees_from_radians(d.site->latitude_rad)},
                {"longitude_deg", degrees_from_radians(d.site->longitude_rad)}};
    }
    Json settings = Json::object();
    for (const auto& [name, value] : d.settings) settings[name] = value;
    Json inputs = Json::array();
    for (std::size_t i = 0; i < hashes.size(); ++i) {
        inputs.push_back(
            {{"file", d.inputs[i].filename().string()}, {"bytes", hashes[i].bytes}, {"sha256", hashes[i].sha256}});
    }
    Json pages = Json::array();
    for (std::size_t p = 0; p < output.light.pages.size(); ++p) {
        pages.push_back({{"width", output.light.pages[p].width},
                         {"height", output.light.pages[p].height},
                         {"base", names::base(p)},
                         {"svf", names::sky_view(p)}});
        if (has_lamps(output.light)) pages.back()["lamps"] = names::lamps(p);
    }
    Json instants = Json::array();
    for (std::size_t i = 0; i < output.light.instants.size(); ++i)
        instants.push_back(instant_json(output, i, exposures[i]));
    Json views = Json::array();
    for (const BakeView& view : d.views)
        views.push_back({{"name", view.name}, {"position", to_json(view.position)}, {"target", to_json(view.target)}});
    const Box3f bounds = bounds_of(output.scene);
    Json manifest = {
        {"format", "skybake-bake"},
        {"version", 1},
        {"generator", {{"name", "skybake"}, {"version", d.version}}},
        {"title", d.title},
        {"crs", d.crs},
        {"site", site},
        {"convergence_deg", degrees_from_radians(d.convergence_rad)},
        {"origin", to_json(output.scene.origin)},
        {"bounds", {{"min", to_json(bounds.lo)}, {"max", to_json(bounds.hi)}}},
        {"texel_m", shortest(output.atlas.texel_m)},
        {"seed", d.seed},
        {"sky_samples", d.sky_samples},
        {"sampling", d.sampling},
        {"tolerance", d.tolerance},
        {"settings", settings},
        {"inputs", inputs},
        {"isa", d.isa},
        {"units",
         {{"illuminance", "lx"},
          {"luminance", "cd/m2"},
          {"length", "m"},
          {"angle", "degree"},
          {"color", "linear Rec. 709, photometric: 0.2126 R + 0.7152 G + 0.0722 B is the illuminance or luminance"}}},
        {"pages", pages},
        {"charts", output.atlas.charts.size()},
        {"objects", {{"uri", names::kObjects}}},
        {"instants", instants},
        {"views", views},
        {"files", files},
        {"report", report_json(output.report)},
        {"findings", findings_json(output.findings)}};
    if (has_lamps(output.light)) manifest["lamp_scales"] = {{"uri", names::kLampScales}};
    return manifest;
}

/// A file, or a group of files that share work; `steps` is a guess of its cost for the progress.
struct Job {
    std::uint64_t steps = 1;
    std::function<void()> run;
};

}  // namespace

void check_output_folder(const std::filesystem::path& folder) {
    std::filesystem::path there = std::filesystem::absolute(folder);
    std::error_code error;
    while (!std::filesystem::exists(there, error) && there.has_relative_path()) there = there.parent_path();
    if (!std::filesystem::is_directory(there, error))
        throw InputError(
            fmt::format("{}: cannot be made: {} is no folder. Choose another place.", folder.string(), there.string()));
    if (access(there.c_str(), W_OK | X_OK) != 0)
        throw InputError(fmt::format("{}: cannot be written: {}: {}. Choose another place.", folder.string(),
                                     there.string(), std::generic_category().message(errno)));
}

WrittenBake write_bake(const std::filesystem::path& folder, const BakeOutput& output, Progress& progress) {
    const Lightmaps& light = output.light;
    const BakeDescription& description = output.description;
    const std::size_t page_count = light.pages.size();
    const std::size_t instant_count = light.instants.size();
    SKYBAKE_CHECK_EQ(output.atlas.pages.size(), page_count);
    SKYBAKE_CHECK_EQ(description.instants.size(), instant_count);
    for (const InstantDescription& instant : description.instants) {
        SKYBAKE_CHECK_EQ(instant.sky_panorama.size(), std::size_t{kPanoramaWidth} * kPanoramaHeight);
    }
    clear_old_bake(folder);

    WrittenBake written;
    std::vector<FileHash> hashes(description.inputs.size());
    std::vector<double> exposures(instant_count);
    std::vector<std::string> files = {names::kCity, names::kObjects};
    std::vector<Job> jobs;
    // The GLB comes first: it is the longest piece of work that one thread does alone.
    jobs.push_back({4, [&] {
                        std::vector<std::vector<std::uint8_t>> sky_view_pngs(page_count);
                        tbb::parallel_for(std::size_t{0}, page_count, [&](std::size_t p) {
                            sky_view_pngs[p] = encode_png(sky_view_picture(light.pages[p]));
                            write_file(folder / names::sky_view(p), sky_view_pngs[p]);
                        });
                        const GlbInfo info{"skybake " + description.version, description.crs};
                        written.glb = write_glb(folder / names::kCity, output.scene, output.atlas, sky_view_pngs, info);
                    }});
    jobs.push_back({1, [&] {
                        FileReplacement file(folder / names::kObjects);
                        file.write(objects_json(output.scene, output.atlas, description.attributes));
                        file.commit();
                    }});
    for (std::size_t f = 0; f < description.inputs.size(); ++f) {
        jobs.push_back({1, [&, f] { hashes[f] = hash_file(description.inputs[f]); }});
    }
    if (has_lamps(light)) {
        files.push_back(names::kLampScales);
        for (std::size_t p = 0; p < page_count; ++p) files.push_back(names::lamps(p));
        jobs.push_back({1 + page_count, [&] {
                            const std::vector<float> scales = lamp_scales_klx(light, output.atlas.charts.size());
                            write_file(folder / names::kLampScales, bytes_of(scales));
                            tbb::parallel_for(std::size_t{0}, page_count, [&](std::size_t p) {
                                write_png(folder / names::lamps(p), lamps_picture(light.pages[p], scales));
                            });
                        }});
    }
    for (std::size_t i = 0; i < instant_count; ++i) {
        files.push_back(names::scales(i));
        files.push_back(names::panorama(i));
        if (description.instants[i].air) files.push_back(names::air(i));
        if (has_indirect(light)) files.push_back(names::indirect_scales(i));
        jobs.push_back(
            {1 + page_count, [&, i] {
                 exposures[i] = exposure_hint(light, i);
                 const std::vector<ChartScale> scales = chart_scales(light, i, output.atlas.charts.size());
                 write_file(folder / names::scales(i), scale_bytes(scales));
                 write_file(folder / names::panorama(i), panorama_bytes(description.instants[i].sky_panorama));
                 if (description.instants[i].air)
                     write_file(folder / names::air(i), air_bytes(*description.instants[i].air));
                 std::vector<float> indirect_scales;
                 if (has_indirect(light)) {
                     indirect_scales = indirect_scales_klx(light, i, output.atlas.charts.size());
                     write_file(folder / names::indirect_scales(i), bytes_of(indirect_scales));
                 }
                 const std::size_t kinds = has_indirect(light) ? 3 : 2;
                 tbb::parallel_for(std::size_t{0}, kinds * page_count, [&](std::size_t k) {
                     const std::size_t p = k / kinds;
                     if (k % kinds == 0) write_png(folder / names::sky(i, p), sky_picture(light, i, p, scales));
                     if (k % kinds == 1) write_png(folder / names::sun(i, p), sun_picture(light, i, p, scales));
                     if (k % kinds == 2)
                         write_png(folder / names::indirect(i, p), indirect_picture(light, i, p, indirect_scales));
                 });
             }});
    }
    for (std::size_t p = 0; p < page_count; ++p) {
        files.push_back(names::base(p));
        files.push_back(names::sky_view(p));
        jobs.push_back({1, [&, p] { write_base(folder / names::base(p), light.pages[p]); }});
        for (std::size_t i = 0; i < instant_count; ++i) {
            files.insert(files.end(), {names::light(i, p), names::sky(i, p), names::sun(i, p)});
            if (has_indirect(light)) files.push_back(names::indirect(i, p));
            if (output.report.leaks) {
                files.push_back(names::leaks(i, p));
                jobs.push_back({1, [&, i, p] {
                                    write_png(folder / names::leaks(i, p),
                                              leak_picture(light, i, p, output.report.leaks->picture_range_lx));
                                }});
            }
            jobs.push_back({4, [&, i, p] { write_light(folder / names::light(i, p), light, i, p); }});
        }
    }
    std::uint64_t steps = 0;
    for (const Job& job : jobs) steps += job.steps;
    progress.begin("write", steps);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, jobs.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t j = range.begin(); j < range.end(); ++j) {
                if (progress.stop_requested()) throw Interrupted();
                jobs[j].run();
                progress.advance(jobs[j].steps);
            }
        },
        tbb::simple_partitioner());
    if (progress.stop_requested()) throw Interrupted();

    std::sort(files.begin(), files.end());
    Json file_list = Json::array();
    for (const std::string& name : files) {
        const std::uint64_t bytes = std::filesystem::file_size(folder / name);
        file_list.push_back({{"name", name}, {"bytes", bytes}});
        written.bytes += bytes;
    }
    written.files = files.size();
    const Json manifest = manifest_json(output, hashes, exposures, file_list);
    FileReplacement file(folder / names::kManifest);
    file.write(manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    file.commit();
    return written;
}

}  // namespace skybake::io
