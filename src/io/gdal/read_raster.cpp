#include "io/gdal/read_raster.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "city/finding_codes.h"
#include "city/height_mesh.h"
#include "city/polygon.h"
#include "io/assembly/file_format.h"
#include "io/gdal/gdal_file.h"

namespace skybake::io {
namespace {

constexpr std::array<const char*, 2> kDrivers = {"GTiff", "AAIGrid"};
/// No height on Earth, whatever the unit: stands for "no data" where the raster does not say so.
constexpr float kNoHeight = 1e5f;
/// Heights that a file may hold for its size. Deflate, the usual packing, makes 1032 bytes of one at best, thus 258
/// heights or 1032 codes of a byte; a file of many more is a header and nothing.
constexpr std::uint64_t kMostCellsPerByte = 1032, kFreeCells = 1u << 22;
constexpr double kSteepWall = 0.5;  // cosine of 60°

HeightGrid read_heights(const std::filesystem::path& path, std::uint64_t file_bytes, GDALDataset& dataset) {
    const auto fail = [&](std::string_view what) {
        throw InputError(fmt::format("{}: {} Write it anew with gdalwarp.", path.string(), what));
    };
    HeightGrid grid;
    grid.columns = static_cast<std::size_t>(std::max(dataset.GetRasterXSize(), 0));
    grid.rows = static_cast<std::size_t>(std::max(dataset.GetRasterYSize(), 0));
    if (dataset.GetRasterCount() < 1 || grid.columns < 2 || grid.rows < 2)
        fail("is no raster of two by two cells or more.");
    if (grid.columns > kLongestGrid || grid.rows > kLongestGrid)
        fail(fmt::format("has {} x {} cells; up to {} a side are read.", grid.columns, grid.rows, kLongestGrid));
    if (grid.columns * grid.rows > kFreeCells + kMostCellsPerByte * file_bytes)
        fail(fmt::format("has {} x {} cells in {} bytes: nearly all of it must be empty.", grid.columns, grid.rows,
                         file_bytes));
    std::array<double, 6> place{};
    if (dataset.GetGeoTransform(place.data()) != CE_None) fail("does not say where it lies.");
    if (place[2] != 0.0 || place[4] != 0.0 || !(place[1] > 0.0) || !(place[5] < 0.0) ||
        !std::isfinite(place[0] + place[1] + place[3] + place[5]))
        fail("is turned, or its rows do not run from north to south.");
    grid.step = {place[1], -place[5]};
    grid.north_west = Vec2d(place[0], place[3]) + Vec2d(0.5, -0.5) * grid.step;  // middles of cells
    grid.heights.resize(grid.columns * grid.rows);
    GDALRasterBand* band = dataset.GetRasterBand(1);
    const int columns = static_cast<int>(grid.columns), rows = static_cast<int>(grid.rows);
    if (band->RasterIO(GF_Read, 0, 0, columns, rows, grid.heights.data(), columns, rows, GDT_Float32, 0, 0, nullptr) !=
        CE_None)
        fail("is damaged: its values cannot be read.");
    int has_no_data = 0;
    const auto no_data = static_cast<float>(band->GetNoDataValue(&has_no_data));
    const auto scale = static_cast<float>(band->GetScale()), offset = static_cast<float>(band->GetOffset());
    for (float& z : grid.heights) {
        if ((has_no_data && z == no_data) || !(std::abs(z) < kNoHeight)) {
            z = std::numeric_limits<float>::quiet_NaN();
        } else {
            z = z * scale + offset;
        }
    }
    return grid;
}

/// Steep triangles of a raster that shows houses are their walls.
void find_walls(Geometry& geometry) {
    for (Surface& surface : geometry.surfaces) {
        const Vec3d area = surface_area_vector(geometry, surface);
        if (area.z < kSteepWall * glm::length(area)) surface.type = SurfaceType::wall;
    }
}

}  // namespace

ReadFile read_raster(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                     FindingLog& findings, Progress& progress) {
    ReadFile file{checked_file_size(path), hash_of_file(path)};
    CityAssembly assembly(path, city, findings);
    progress.begin("read " + assembly.name(), 1);
    const QuietErrors quiet;
    const DatasetPtr dataset = open_dataset(path, GDAL_OF_RASTER, kDrivers);
    const HeightGrid grid = read_heights(path, file.bytes, *dataset);
    const NamedSystem system = named_system(dataset->GetSpatialRef());
    if (progress.stop_requested()) throw Interrupted();
    ReadObject read;
    CityObject& object = read.object;
    object.id = path.stem().string();
    object.type = ObjectType::terrain;
    object.type_name = "TINRelief";
    object.lod = std::string("1");
    object.where = assembly.name();
    object.geometry = height_mesh(grid, options.raster.max_error_m);
    if (options.raster.content == RasterContent::surface) find_walls(object.geometry);
    for (Vec3d& p : object.geometry.vertices) p = Vec3d(system.place(p.x, p.y), p.z);
    findings.add(make_finding("SB503", assembly.name(),
                              fmt::format("{} x {} cells became {} triangles, no more than {} m off.", grid.columns,
                                          grid.rows, object.geometry.surfaces.size(), options.raster.max_error_m)));
    read.lods = {object.lod};
    assembly.add(std::move(read), {});
    FileFacts facts;
    facts.crs = system.name;
    assembly.finish(facts);
    progress.advance(1);
    return file;
}

}  // namespace skybake::io
