#include "io/manifest/read_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/manifest/names.h"

namespace skybake::io {
namespace {

constexpr int kLargestPage = 1 << 16;

/// A file that the manifest names, which must lie inside the folder.
std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& uri) {
    const std::filesystem::path relative(uri);
    bool leaves = uri.empty() || relative.is_absolute();
    for (const std::filesystem::path& part : relative) leaves = leaves || part == "..";
    if (leaves)
        throw InputError(
            fmt::format("{}: names the file '{}' outside its folder.", (folder / names::kManifest).string(), uri));
    return folder / relative;
}

Vec3f vec3_of(const nlohmann::json& json) {
    return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
}

/// Sun, sky and exposure of an instant. `name` is the manifest's, for messages.
void read_daylight(const std::filesystem::path& folder, const nlohmann::json& json, const std::string& name,
                   StoredInstant& instant) {
    const nlohmann::json& sun = json.at("sun");
    const Vec3f direction = vec3_of(sun.at("direction"));
    if (direction != Vec3f(0.0f)) instant.sun.direction = glm::normalize(direction);  // none: a sky without sun
    instant.sun.angular_radius_rad =
        static_cast<float>(radians_from_degrees(sun.at("angular_radius_deg").get<double>()));
    if (sun.at("shape") != "none") instant.sun.normal_illuminance = 1e3f * vec3_of(sun.at("normal_illuminance_klx"));
    const nlohmann::json& panorama = json.at("sky").at("panorama");
    instant.panorama = {panorama.at("width").get<int>(), panorama.at("height").get<int>(),
                        file_in(folder, panorama.at("uri").get<std::string>())};
    instant.land.luminance = 1e3f * vec3_of(json.at("sky").at("land_kcd_m2"));
    if (json.contains("air")) {
        const nlohmann::json& air = json["air"];
        const nlohmann::json& airlight = air.at("airlight");
        StoredAir stored;
        stored.scattering = {Vec3d(vec3_of(air.at("molecules_per_m"))), Vec3d(vec3_of(air.at("haze_per_m")))};
        stored.columns = airlight.at("columns").get<int>();
        stored.rows = airlight.at("rows").get<int>();
        stored.file = file_in(folder, airlight.at("uri").get<std::string>());
        if (stored.columns < 1 || stored.rows < 2 || std::max(stored.columns, stored.rows) > kLargestPage)
            throw InputError(fmt::format("{}: the instant '{}' has impossible air. Bake again.", name, instant.label));
        instant.air = stored;
    }
    instant.exposure_hint = json.at("exposure_hint").get<float>();
    const bool is_lit = std::isfinite(instant.exposure_hint) && instant.exposure_hint > 0.0f &&
                        std::isfinite(glm::length(instant.sun.direction)) &&
                        std::isfinite(glm::length(instant.sun.normal_illuminance));
    if (!is_lit || instant.panorama.width < 1 || instant.panorama.height < 2 || instant.panorama.width > kLargestPage ||
        instant.panorama.height > kLargestPage)
        throw InputError(fmt::format("{}: the instant '{}' has an impossible sun, sky or exposure. Bake again.", name,
                                     instant.label));
}

StoredBake from_json(const std::filesystem::path& folder, const nlohmann::json& json) {
    const std::string name = (folder / names::kManifest).string();
    if (json.at("format") != "skybake-bake") throw InputError(fmt::format("{}: is not of a bake of skybake.", name));
    if (json.at("version") != 1) {
        throw InputError(fmt::format(
            "{}: has version {}, and this skybake reads version 1. Bake again, or use the skybake that made it.", name,
            json.at("version").dump()));
    }
    StoredBake bake;
    bake.folder = folder;
    bake.texel_m = json.at("texel_m").get<double>();
    bake.charts = json.at("charts").get<std::uint64_t>();
    for (const nlohmann::json& input : json.at("inputs"))
        bake.inputs.push_back({input.at("file").get<std::string>(), input.at("sha256").get<std::string>()});
    for (const nlohmann::json& page : json.at("pages")) {
        const int width = page.at("width").get<int>();
        const int height = page.at("height").get<int>();
        if (width <= 0 || height <= 0 || width > kLargestPage || height > kLargestPage) {
            throw InputError(fmt::format("{}: has a page of {} x {} texels.", name, width, height));
        }
        bake.pages.push_back({width, height, file_in(folder, page.at("base").get<std::string>())});
    }
    for (const nlohmann::json& instant : json.at("instants")) {
        StoredInstant stored;
        stored.label = instant.at("label").get<std::string>();
        for (const nlohmann::json& page : instant.at("pages"))
            stored.pages.push_back(file_in(folder, page.at("exr").get<std::string>()));
        stored.has_indirect = instant.contains("indirect_scales");
        read_daylight(folder, instant, name, stored);
        stored.land.height_m = json.at("bounds").at("min").at(2).get<float>();
        if (stored.pages.size() != bake.pages.size()) {
            throw InputError(fmt::format("{}: the instant '{}' has {} pages, and the atlas {}.", name, stored.label,
                                         stored.pages.size(), bake.pages.size()));
        }
        bake.instants.push_back(std::move(stored));
    }
    for (const nlohmann::json& view : json.at("views")) {
        bake.views.push_back(
            {view.at("name").get<std::string>(), vec3_of(view.at("position")), vec3_of(view.at("target"))});
    }
    bake.convergence_rad = radians_from_degrees(json.at("convergence_deg").get<double>());
    return bake;
}

}  // namespace

void check_size(const ExrReader& reader, const std::filesystem::path& path, const StoredPage& page) {
    if (reader.width() == page.width && reader.height() == page.height) return;
    throw InputError(fmt::format("{}: has {} x {} texels, and the manifest says {} x {}. Bake again.", path.string(),
                                 reader.width(), reader.height(), page.width, page.height));
}

std::array<std::string, 3> channel_names(LightPart part) {
    static constexpr std::array kLayers{"", "sun.", "sky.", "indirect."};
    const std::string layer = kLayers[static_cast<std::size_t>(part)];
    return {layer + "R", layer + "G", layer + "B"};
}

StoredBake open_bake(const std::filesystem::path& folder) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(fmt::format("{}: is no folder. Name the folder of a bake.", folder.string()));
    const std::filesystem::path manifest = folder / names::kManifest;
    if (!std::filesystem::exists(manifest, error)) {
        throw InputError(fmt::format(
            "{}: holds no whole bake (manifest.json is absent). Was the bake stopped? Bake again.", folder.string()));
    }
    const std::vector<std::uint8_t> bytes = read_file(manifest);
    try {
        return from_json(folder, nlohmann::json::parse(bytes.begin(), bytes.end()));
    } catch (const nlohmann::json::exception& fault) {
        throw InputError(
            fmt::format("{}: is no manifest of a bake ({}). Bake again.", manifest.string(), fault.what()));
    }
}

LightmapPage read_base(const StoredBake& bake, std::size_t page) {
    const StoredPage& stored = bake.pages[page];
    ExrReader reader(stored.base);
    check_size(reader, stored.base, stored);
    LightmapPage base{stored.width, stored.height, {}, {}, {}};
    const std::size_t count = static_cast<std::size_t>(stored.width) * static_cast<std::size_t>(stored.height);
    std::vector<std::uint32_t> state(count);
    std::vector<std::uint32_t> chart(count);
    base.sky_view_factor.resize(count);
    reader.read(
        std::vector<ExrReader::Target>{{{"state", ExrType::uint32}, state.data(), 1},
                                       {{"chart", ExrType::uint32}, chart.data(), 1},
                                       {{"sky_view_factor", ExrType::float32}, base.sky_view_factor.data(), 1}});
    base.state.resize(count);
    base.chart.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
        if (state[t] > static_cast<std::uint32_t>(TexelState::gutter))
            throw InputError(fmt::format("{}: has the texel state {}, which is none.", stored.base.string(), state[t]));
        if (state[t] != 0 && chart[t] >= bake.charts) {
            throw InputError(
                fmt::format("{}: names chart {} of {}. Bake again.", stored.base.string(), chart[t], bake.charts));
        }
        base.state[t] = static_cast<TexelState>(state[t]);
        base.chart[t] = ChartId(chart[t]);
    }
    return base;
}

StoredLight read_light(const StoredBake& bake, std::size_t instant, std::size_t page) {
    const std::filesystem::path& path = bake.instants[instant].pages[page];
    const StoredPage& stored = bake.pages[page];
    ExrReader reader(path);
    check_size(reader, path, stored);
    StoredLight light;
    std::vector<ExrReader::Target> targets;
    for (const auto& [part, pixels] : {std::pair{LightPart::total, &light.total},
                                       {LightPart::sun, &light.sun},
                                       {LightPart::sky, &light.sky},
                                       {LightPart::indirect, &light.indirect}}) {
        if (part == LightPart::indirect && !bake.instants[instant].has_indirect) continue;
        pixels->resize(static_cast<std::size_t>(stored.width) * static_cast<std::size_t>(stored.height));
        const std::array<std::string, 3> names = channel_names(part);
        for (std::size_t c = 0; c < 3; ++c)
            targets.push_back({{names[c], ExrType::float32}, &pixels->data()->x + c, 3});
    }
    reader.read(targets);
    return light;
}

}  // namespace skybake::io
