// Maps of a study: areas in, rasters and cells out, by GDAL.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/receivers.h"

namespace skybake::io {

/// The polygons of a GeoJSON, GeoPackage or any other vector file that GDAL reads, in the coordinates of `crs`
/// (whatever PROJ understands). The id is the attribute "id", or "name", or the feature's number. A file that names a
/// reference system is transformed from it; one that names none is taken to be in `crs` (GeoJSON without "crs" is in
/// WGS 84, RFC 7946, unless its numbers cannot be degrees). Throws InputError for a file that cannot be read, has no
/// polygon, or lies wholly outside `lo`…`hi`, naming both extents.
std::vector<AreaPolygon> read_polygons(const std::filesystem::path& path, const std::string& crs, const Vec2d& lo,
                                       const Vec2d& hi);

/// One band of a raster: a value for each of some samples.
struct RasterBand {
    std::string name;                            // "sun_hours_03-21"
    std::string unit;                            // "h"
    const std::vector<float>* values = nullptr;  // one a sample
};

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

}  // namespace skybake::io
