#include "api/load_city.h"

#include <fmt/format.h>

#include <chrono>

#include "base/error.h"
#include "city/finding_codes.h"
#include "io/assembly/file_format.h"
#include "io/citygml/read_citygml.h"
#include "io/cityjson/read_cityjson.h"
#include "io/obj/read_obj.h"

namespace skybake {
namespace {

io::ReadFile read_file(const std::filesystem::path& file, const io::ReadOptions& options, LoadedCity& loaded,
                       Progress& progress) {
    io::checked_file_size(file);
    const std::string format = io::format_of(io::head_of(file));
    if (format == "XML" || format == "GML" || format == "CityGML")
        return io::read_citygml(file, options, loaded.city, loaded.findings, progress);
    if (format == "Wavefront OBJ") return io::read_obj(file, options, loaded.city, loaded.findings, progress);
    if (!format.empty()) {
        throw InputError(fmt::format(
            "{}: is {}, which this version does not read. It reads CityGML 1.0, 2.0, 3.0, CityJSON 1.0, 1.1, 2.0, "
            "CityJSONSeq and Wavefront OBJ.",
            file.string(), format));
    }
    return io::read_cityjson(file, options, loaded.city, loaded.findings, progress);
}

}  // namespace

LoadedCity load_city(std::span<const std::filesystem::path> files, const LoadOptions& options, Progress& progress) {
    const auto begun = std::chrono::steady_clock::now();
    LoadedCity loaded;
    for (const std::filesystem::path& file : files) {
        const io::ReadFile read = read_file(file, {options.lod, options.placement}, loaded, progress);
        loaded.inputs.push_back({file.string(), read.bytes, fmt::format("fnv1a:{:016x}", read.content_hash)});
    }
    if (options.crs) loaded.city.crs = *options.crs;
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
