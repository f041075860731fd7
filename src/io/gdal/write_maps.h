// Maps of a study for geographic information systems: rasters, cells and shadows.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/receivers.h"
#include "study/study_pictures.h"

namespace skybake::io {

/// One band of a raster: a value for each of some samples.
struct RasterBand {
    std::string name;                            // "sun_hours_03-21"
    std::string unit;                            // "h"
    const std::vector<float>* values = nullptr;  // one a sample
};

/// The cells of the lattice that a raster of the ground and polygon samples spans.
struct RasterExtent {
    std::int64_t left = 0, top = 0;  // of the lattice through the map's origin
    std::int64_t width = 0, height = 0;
};
/// None without such samples.
std::optional<RasterExtent> raster_extent(const ReceiverSet& set);

/// Writes the ground and polygon samples of a set as a GeoTIFF, a band a column: cell size and place as in the lattice,
/// 32-bit floats, deflate, nodata −9999, the bands with names and units. `crs` may be empty. Throws InputError when it
/// cannot be written. Nothing is written (and false returned) when there is no such sample.
bool write_geotiff(const std::filesystem::path& path, const ReceiverSet& set, const std::vector<RasterBand>& bands,
                   const std::string& crs);

/// A column of the table of cells: numbers, or words.
struct CellColumn {
    std::string name;
    const std::vector<float>* numbers = nullptr;
    std::vector<std::string> words;  // one a sample where there are no numbers
};

/// Writes all cells as a GeoPackage: the layer "cells" of 3D polygons (upright ones for façades), "points" for free
/// points; attributes receiver, kind, building, storey and the columns. Throws InputError when it cannot be written.
void write_geopackage(const std::filesystem::path& path, const ReceiverSet& set, const std::vector<CellColumn>& columns,
                      const std::string& crs);

/// Writes the shadows at whole hours as a GeoPackage: the layer "shadows" of multipolygons with kind ("city", "plan",
/// "new"), day, clock, UTC, the sun's place (as seen; azimuth from true north) and the area in m². Throws InputError
/// when it cannot be written.
void write_shadows_gpkg(const std::filesystem::path& path, const StudyPictures& pictures, const Study& study,
                        double convergence_rad, const std::string& crs);

}  // namespace skybake::io
