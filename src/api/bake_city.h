// From city files to the folder of a bake: what the program and the library do alike.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/crown_settings.h"
#include "api/load_city.h"
#include "bake/bake_lightmaps.h"
#include "bake/bake_report.h"
#include "io/manifest/write_bake.h"
#include "sky/daylight_settings.h"

namespace skybake {

struct BakeCityOptions {
    std::vector<std::filesystem::path> files;
    LoadOptions load;
    DaylightSettings daylight;
    std::optional<Site> site;                         // instead of what the CRS says
    std::vector<std::pair<std::string, Rgb>> albedo;  // by the name of the surface type, and "default"
    CrownSettings crowns;
    float texel_m = 0.5f;
    BakeOptions bake;
    std::filesystem::path lamps;        // file; empty: none, or those of `bake`
    std::optional<Vec3d> lamps_origin;  // io::read_lamps
    std::uint64_t seed = 0;
    std::string version;
    std::vector<std::pair<std::string, std::string>> settings;  // as given, for the manifest
    std::filesystem::path output;
};

struct BakeCityResult {
    BakeReport report;
    FindingLog findings;
    io::WrittenBake written;
};

/// Reads, builds, bakes and writes. Throws InputError for unusable input, among it a city without any surface, and
/// Interrupted.
BakeCityResult bake_city(const BakeCityOptions& options, Progress& progress);

/// How the scene of a loaded city is made for texels of `texel_m` metres: used by everything that computes light.
SceneOptions scene_options(const std::vector<std::pair<std::string, Rgb>>& albedo, float texel_m);

}  // namespace skybake
