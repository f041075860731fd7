// From city files to a repaired city in true metres: what check, bake, probe and study start with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "city/georeference.h"
#include "city/ground.h"
#include "city/repair.h"
#include "io/assembly/city_assembly.h"

namespace skybake {

struct LoadOptions {
    std::optional<std::string> lod;  // "2.2"; without one the highest of each object
    GroundChoice ground = GroundChoice::none;
    double ground_margin_m = 30.0;
    std::optional<std::string> crs{};     // instead of what the files name
    io::MeshPlacement placement{};        // of files without a place (OBJ, glTF)
    std::optional<Box2d> bbox{};          // in the coordinates of the files; without one all of the city
    std::vector<std::string> excluded{};  // ids of objects that are left out, with all below them
    io::RasterOptions raster{};
    io::FootprintOptions footprints{};
    std::vector<std::filesystem::path> orthophotos{};  // on the ground; of several the first that covers a surface
};

struct InputFile {
    std::string path;
    std::uint64_t bytes = 0;
    std::string hash;  // 16 hexadecimal digits, "fnv1a:" before them
};

struct LoadedCity {
    CityModel city;
    Georeference georeference;
    RepairSummary summary;  // without added ground
    FindingLog findings;
    std::vector<InputFile> inputs;
    bool has_own_ground = false;
    double read_seconds = 0.0;  // all of it: reading, repair, projection, ground
};

/// Reads the files as one city in the reference system of the first that names one, each object once, repairs it,
/// brings it into metres and adds ground and orthophotos when asked. Footprints without heights of their own stand on
/// the terrain of the files. A city without any surface is finding SB117 and comes back empty. Throws InputError when a
/// file is unusable as a whole or an excluded object does not exist, Interrupted when `progress` wants to stop.
LoadedCity load_city(std::span<const std::filesystem::path> files, const LoadOptions& options, Progress& progress);

}  // namespace skybake
