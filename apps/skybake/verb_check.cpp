// skybake check: reads a city and tells what is in it, what is wrong with it, and what was done about that.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "base/error.h"
#include "city/finding_codes.h"
#include "city_options.h"
#include "io/cityjson/place_pictures.h"
#include "io/cityjson/write_city_json.h"
#include "program.h"

namespace skybake::cli {
namespace {

struct CheckOptions {
    CityOptions city;
    bool wants_codes = false;
    bool wants_repair = false;
    std::filesystem::path output;  // of the repaired city
};

/// What the report counts.
struct Figures {
    std::map<std::string, std::size_t> objects_by_type;                       // all objects, by type
    std::map<std::string, std::map<std::string, std::size_t>> shown_by_type;  // objects with surfaces, by type and LoD
    std::map<std::string, std::size_t> surfaces_by_type;
    std::size_t buildings = 0;  // topmost objects that are buildings
    std::size_t surfaces = 0;
    std::size_t textured_surfaces = 0;
    std::size_t textures_found = 0;
    std::size_t textures_missing = 0;
};

Figures count(const CityModel& city) {
    Figures figures;
    std::set<std::string_view> building_ids;
    for (const CityObject& object : city.objects) {
        if (is_building(object.type)) building_ids.insert(object.id);
    }
    for (const CityObject& object : city.objects) {
        ++figures.objects_by_type[name_of(object.type)];
        if (is_building(object.type) && building_ids.count(object.parent_id) == 0) ++figures.buildings;
        if (object.geometry.is_empty()) continue;
        ++figures.shown_by_type[name_of(object.type)][object.lod];
        for (const Surface& surface : object.geometry.surfaces) {
            ++figures.surfaces_by_type[name_of(surface.type)];
            ++figures.surfaces;
            figures.textured_surfaces += surface.texture && !city.textures[surface.texture->index()].is_missing;
        }
    }
    for (const Texture& texture : city.textures)
        ++(texture.is_missing ? figures.textures_missing : figures.textures_found);
    return figures;
}

std::string join(const std::map<std::string, std::size_t>& counts) {
    std::string text;
    for (const auto& [name, number] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", number, name);
    return text.empty() ? "none" : text;
}

std::string degrees_text(const Georeference& georeference) {
    if (!georeference.site) return "unknown; pass --site LAT,LON to bake";
    const double lat = degrees_from_radians(georeference.site->latitude_rad);
    const double lon = degrees_from_radians(georeference.site->longitude_rad);
    return fmt::format("{:.4f}° {}, {:.4f}° {}; grid north lies {:.3f}° {} of true north", std::abs(lat),
                       lat < 0 ? "S" : "N", std::abs(lon), lon < 0 ? "W" : "E",
                       std::abs(degrees_from_radians(georeference.convergence_rad)),
                       georeference.convergence_rad < 0 ? "west" : "east");
}

void print_report(const LoadedCity& loaded, const Figures& figures) {
    const CityModel& city = loaded.city;
    const auto line = [](std::string_view name, const std::string& text) { fmt::print("{:<11} {}\n", name, text); };
    for (const InputFile& file : loaded.inputs)
        line("file", fmt::format("{} ({:.1f} MB, {})", file.path, static_cast<double>(file.bytes) * 1e-6, file.hash));
    line("buildings", fmt::format("{}", figures.buildings));
    line("objects", join(figures.objects_by_type));
    for (const auto& [type, lods] : figures.shown_by_type) {
        std::string text;
        for (const auto& [lod, number] : lods)
            text += fmt::format("{}{} at LoD {}", text.empty() ? "" : ", ", number, lod);
        line("  shown", fmt::format("{}: {}", type, text));
    }
    std::string lods;
    for (const std::string& lod : city.lods) lods += (lods.empty() ? "" : ", ") + lod;
    line("LoDs", lods.empty() ? "none" : lods);
    line("surfaces", fmt::format("{} ({})", figures.surfaces, join(figures.surfaces_by_type)));
    line("triangles", fmt::format("{}", loaded.summary.triangles));
    line("solids", fmt::format("{} closed, {} not", loaded.summary.closed_shells, loaded.summary.open_shells));
    line("textures", fmt::format("{} images found, {} missing; {} surfaces textured", figures.textures_found,
                                 figures.textures_missing, figures.textured_surfaces));
    line("CRS", loaded.georeference.crs_name.empty() ? (city.crs.empty() ? "not stated" : city.crs + " (unknown)")
                                                     : loaded.georeference.crs_name);
    line("site", degrees_text(loaded.georeference));
    const Box3d box = extent_of(city);
    if (!box.is_empty()) {
        line("extent",
             fmt::format("{:.2f} {:.2f} {:.2f} to {:.2f} {:.2f} {:.2f} ({:.0f} × {:.0f} × {:.0f} m)", box.lo.x,
                         box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z, box.size().x, box.size().y, box.size().z));
    }
    line("ground", loaded.has_own_ground ? "yes" : has_ground(city) ? "added" : "none");
    line("read in", fmt::format("{:.2f} s", loaded.read_seconds));

    constexpr std::size_t kShownPerCode = 3;
    std::string code;
    std::size_t shown = 0;
    for (const Finding& finding : loaded.findings.list()) {
        if (finding.code != code) {
            code = finding.code;
            shown = 0;
            const FindingCode* entry = find_code(code);
            fmt::print("\n{} {}: {} ({})\n", code, name_of(finding.severity), entry ? entry->title : "",
                       loaded.findings.count(code));
            if (!finding.remedy.empty()) fmt::print("  {}\n", finding.remedy);
        }
        if (++shown <= kShownPerCode) fmt::print("  {}: {}\n", finding.where, finding.what);
    }
    if (loaded.findings.empty()) fmt::print("\nno findings\n");
}

nlohmann::json report_json(const LoadedCity& loaded, const Figures& figures) {
    const CityModel& city = loaded.city;
    nlohmann::json files = nlohmann::json::array();
    for (const InputFile& file : loaded.inputs)
        files.push_back({{"path", file.path}, {"bytes", file.bytes}, {"hash", file.hash}});
    nlohmann::json extent = nullptr;
    const Box3d box = extent_of(city);
    if (!box.is_empty()) extent = {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
    nlohmann::json site = nullptr;
    if (loaded.georeference.site) {
        site = {{"latitude_deg", degrees_from_radians(loaded.georeference.site->latitude_rad)},
                {"longitude_deg", degrees_from_radians(loaded.georeference.site->longitude_rad)}};
    }
    return {{"schema", "skybake.check/1"},
            {"files", files},
            {"buildings", figures.buildings},
            {"objects", city.objects.size()},
            {"objects_by_type", figures.objects_by_type},
            {"shown_by_type_and_lod", figures.shown_by_type},
            {"surfaces", figures.surfaces},
            {"surfaces_by_type", figures.surfaces_by_type},
            {"triangles", loaded.summary.triangles},
            {"closed_solids", loaded.summary.closed_shells},
            {"open_solids", loaded.summary.open_shells},
            {"lods", city.lods},
            {"crs", loaded.georeference.crs_name.empty() ? nlohmann::json(nullptr)
                                                         : nlohmann::json(loaded.georeference.crs_name)},
            {"crs_stated", city.crs},
            {"site", site},
            {"convergence_deg", degrees_from_radians(loaded.georeference.convergence_rad)},
            {"extent", extent},
            {"textures_found", figures.textures_found},
            {"textures_missing", figures.textures_missing},
            {"textured_surfaces", figures.textured_surfaces},
            {"has_ground", loaded.has_own_ground},
            {"read_seconds", loaded.read_seconds},
            {"findings", to_json(loaded.findings)}};
}

int print_codes(const CommonOptions& common) {
    if (common.wants_json) {
        nlohmann::json codes = nlohmann::json::array();
        for (const FindingCode& code : kFindingCodes) {
            codes.push_back({{"code", code.code},
                             {"severity", name_of(code.severity)},
                             {"title", code.title},
                             {"remedy", code.remedy}});
        }
        print_json({{"codes", codes}});
        return kDone;
    }
    for (const FindingCode& code : kFindingCodes)
        fmt::print("{} {:<8} {}. {}\n", code.code, name_of(code.severity), code.title, code.remedy);
    return kDone;
}

void write_repaired(LoadedCity& loaded, const std::filesystem::path& output) {
    to_named_system(loaded.city, loaded.georeference);
    io::place_pictures(loaded.city, output);
    io::write_city_json(loaded.city, output);
}

int run_check(const CheckOptions& options, const CommonOptions& common) {
    if (options.wants_codes) return print_codes(common);
    LoadedCity loaded;
    {
        ConsoleProgress progress(common);
        loaded = load_city(options.city.files, options.city.load_options(), progress);
    }
    const Figures figures = count(loaded.city);
    if (options.wants_repair) write_repaired(loaded, options.output);
    if (common.wants_json) {
        print_json(report_json(loaded, figures));
    } else {
        print_report(loaded, figures);
    }
    return common.is_strict && loaded.findings.count(Severity::error) > 0 ? kDifference : kDone;
}

}  // namespace

void add_check(CLI::App& app, Program& program) {
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* verb = add_verb(app, program, "check", "Read a city and report what is in it and what is wrong with it.",
                              "  skybake check city.city.json\n"
                              "  skybake check tile1.city.jsonl tile2.city.jsonl --lod 1.3 --json\n"
                              "  skybake check city.gml --repair -o city.city.json\n"
                              "  skybake check --codes",
                              [options, &program] {
                                  if (options->wants_repair == options->output.empty())
                                      throw InputError("--repair and -o FILE belong together.");
                                  if (!options->wants_codes && options->city.files.empty())
                                      throw InputError("check needs the name of a city file: skybake check CITY…");
                                  return run_check(*options, program.common);
                              });
    add_city_options(verb, options->city, false);
    verb->add_flag("--repair", options->wants_repair, "write the repaired city as CityJSON 2.0; pictures are copied");
    verb->add_option("-o,--output", options->output,
                     "where the repaired city goes (.city.json, or .jsonl for a sequence)");
    verb->add_flag("--codes", options->wants_codes, "list all findings by code, with remedies");
}

}  // namespace skybake::cli
