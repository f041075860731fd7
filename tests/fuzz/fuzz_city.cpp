// A city file of one format, whatever its bytes: it loads, or ends in an InputError.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "api/load_city.h"
#include "base/error.h"
#include "io/assembly/file_format.h"

namespace {

using namespace skybake;

/// The formats that each reader answers for, by the names of io/assembly/file_format.h; empty means CityJSON.
bool is_of_this_reader(const std::string& format) {
    const std::string_view reader = SKYBAKE_FUZZ_FORMAT;
    static const std::set<std::string> kGltf = {"glTF", "binary glTF (GLB)", "3D Tiles (b3dm)"};
    static const std::set<std::string> kRaster = {"a TIFF raster", "an ESRI ASCII grid"};
    static const std::set<std::string> kFootprints = {"GeoJSON", "a GeoPackage", "an ESRI shapefile"};
    if (reader == "citygml") return format == "CityGML" || format == "GML" || format == "XML";
    if (reader == "cityjson") return format.empty();
    if (reader == "obj") return format == "Wavefront OBJ";
    if (reader == "gltf") return kGltf.count(format) > 0;
    if (reader == "raster") return kRaster.count(format) > 0;
    return kFootprints.count(format) > 0;
}

/// A file in a folder of its own, in memory where the system has such a place.
std::filesystem::path input_file() {
    const std::filesystem::path shared = "/dev/shm";
    const std::filesystem::path base =
        std::filesystem::is_directory(shared) ? shared : std::filesystem::temp_directory_path();
    const std::filesystem::path folder = base / ("skybake-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    return folder / "input";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (!is_of_this_reader(io::format_of(bytes.substr(0, 2048)))) return -1;  // not into the corpus
    static const std::filesystem::path path = input_file();
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(size));
    SilentProgress progress;
    LoadOptions options;
    options.ground = GroundChoice::draped;
    try {
        load_city(std::span(&path, 1), options, progress);
    } catch (const InputError&) {
    }
    return 0;
}
