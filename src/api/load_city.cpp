#include "api/load_city.h"

#include <fmt/format.h>

#include <chrono>

#include "city/finding_codes.h"
#include "io/cityjson/read_cityjson.h"

namespace skybake {

LoadedCity load_city(std::span<const std::filesystem::path> files, const LoadOptions& options, Progress& progress) {
    const auto begun = std::chrono::steady_clock::now();
    LoadedCity loaded;
    for (const std::filesystem::path& file : files) {
        const io::CityJsonFile read = io::read_cityjson(file, {options.lod}, loaded.city, loaded.findings, progress);
        loaded.inputs.push_back({file.string(), read.bytes, fmt::format("fnv1a:{:016x}", read.content_hash)});
    }
    // Degrees become metres first: the repair's tolerances are lengths.
    loaded.georeference = georeference(loaded.city, loaded.findings);
    loaded.summary = repair(loaded.city, loaded.findings, progress);
    loaded.has_own_ground = has_ground(loaded.city);
    if (loaded.summary.surfaces == 0) {
        const std::string where = files.empty() ? "city" : files.front().filename().string();
        loaded.findings.add(make_finding("SB117", where, "the city has no surface that light could fall on."));
    } else {
        add_ground(loaded.city, options.ground, options.ground_margin_m, loaded.findings);
    }
    loaded.read_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return loaded;
}

}  // namespace skybake
