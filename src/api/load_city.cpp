#include "api/load_city.h"

#include <fmt/format.h>

#include <chrono>

#include "base/error.h"
#include "base/nearest_word.h"
#include "city/finding_codes.h"
#include "city/ground_height.h"
#include "city/select.h"
#include "io/assembly/file_format.h"
#include "io/citygml/read_citygml.h"
#include "io/cityjson/read_cityjson.h"
#include "io/gdal/orthophoto.h"
#include "io/gdal/read_footprints.h"
#include "io/gdal/read_raster.h"
#include "io/gltf/read_gltf.h"
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
    if (format == "glTF" || format == "binary glTF (GLB)" || format == "3D Tiles (b3dm)")
        return io::read_gltf(file, options, loaded.city, loaded.findings, progress);
    if (format == "a TIFF raster" || format == "an ESRI ASCII grid")
        return io::read_raster(file, options, loaded.city, loaded.findings, progress);
    if (format == "GeoJSON" || format == "a GeoPackage" || format == "an ESRI shapefile")
        return io::read_footprints(file, options, loaded.city, loaded.findings, progress);
    if (!format.empty()) {
        throw InputError(fmt::format(
            "{}: is {}, which this version does not read. It reads CityGML 1.0, 2.0, 3.0, CityJSON 1.0, 1.1, 2.0, "
            "CityJSONSeq, Wavefront OBJ, glTF 2.0, GLB, b3dm tiles, GeoTIFF and ASCII grids of heights, and "
            "GeoPackage, "
            "GeoJSON and Shapefile footprints.",
            file.string(), format));
    }
    return io::read_cityjson(file, options, loaded.city, loaded.findings, progress);
}

void leave_out(CityModel& city, const std::vector<std::string>& ids, FindingLog& findings) {
    const std::optional<std::string> unknown = exclude(city, ids, findings);
    if (!unknown) return;
    std::vector<std::string> known;
    for (const CityObject& object : city.objects) known.push_back(object.id);
    throw InputError(fmt::format("--exclude {}: no object has this id. The nearest one is '{}'.", *unknown,
                                 nearest_word(*unknown, known)));
}

}  // namespace

LoadedCity load_city(std::span<const std::filesystem::path> files, const LoadOptions& options, Progress& progress) {
    const auto begun = std::chrono::steady_clock::now();
    LoadedCity loaded;
    const io::ReadOptions how{options.lod, options.placement, options.raster, options.footprints};
    CityModel& city = loaded.city;
    std::vector<std::string> above_ground;
    for (const std::filesystem::path& file : files) {
        const std::size_t first_object = city.objects.size();
        const io::ReadFile read = read_file(file, how, loaded, progress);
        loaded.inputs.push_back({file.string(), read.bytes, fmt::format("fnv1a:{:016x}", read.content_hash)});
        if (options.crs) city.crs.clear();  // what the files name is not asked
        above_ground.insert(above_ground.end(), read.above_ground.begin(), read.above_ground.end());
        if (first_object > 0) drop_duplicates(city, first_object, loaded.findings);
    }
    if (options.crs) city.crs = *options.crs;
    stand_on_ground(city, above_ground, loaded.findings);
    if (options.bbox) keep_within(city, *options.bbox, loaded.findings);
    leave_out(city, options.excluded, loaded.findings);
    // Degrees become metres first: the repair's tolerances are lengths.
    loaded.georeference = georeference(loaded.city, loaded.findings);
    loaded.summary = repair(loaded.city, loaded.findings, progress);
    loaded.has_own_ground = has_ground(loaded.city);
    if (loaded.summary.surfaces == 0) {
        const std::string where = files.empty() ? "city" : files.front().filename().string();
        loaded.findings.add(make_finding("SB117", where, "the city has no surface that light could fall on."));
    } else {
        add_ground(loaded.city, options.ground, options.ground_margin_m, loaded.findings);
        for (const std::filesystem::path& photo : options.orthophotos) {
            io::drape_orthophoto(photo, loaded.georeference.coordinate_crs, loaded.city, loaded.findings);
            loaded.inputs.push_back(
                {photo.string(), io::checked_file_size(photo), fmt::format("fnv1a:{:016x}", io::hash_of_file(photo))});
        }
    }
    loaded.read_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return loaded;
}

}  // namespace skybake
