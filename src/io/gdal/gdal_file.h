// GDAL behind values that free themselves. Private to the folder; the only header that shows GDAL.
#pragma once

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "base/vec.h"

namespace skybake::io {

/// While it lives, GDAL prints nothing in this thread: faults are told by what its functions return.
class QuietErrors {
  public:
    QuietErrors() { CPLPushErrorHandler(CPLQuietErrorHandler); }
    ~QuietErrors() { CPLPopErrorHandler(); }
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;
};

struct DatasetDeleter {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, DatasetDeleter>;

/// Makes GDAL know its formats; once is enough, more do not harm.
void register_drivers();

inline constexpr std::array<const char*, 3> kVectorDrivers = {"GPKG", "GeoJSON", "ESRI Shapefile"};

/// Opens `path` with one of the named drivers, silently and for reading only. Throws InputError with GDAL's reason.
/// `kind` is GDAL_OF_RASTER or GDAL_OF_VECTOR.
DatasetPtr open_dataset(const std::filesystem::path& path, unsigned kind, std::span<const char* const> drivers);

/// The reference system of a layer or raster as city models name it, and the order in which its coordinates go into the
/// model: the authority's, where latitude comes first in many geographic systems.
struct NamedSystem {
    std::string name;  // "EPSG:3007" or WKT; empty without a system
    bool is_latitude_first = false;

    Vec2d place(double x, double y) const { return is_latitude_first ? Vec2d(y, x) : Vec2d(x, y); }
};
NamedSystem named_system(const OGRSpatialReference* system);

/// The other way: what GDAL knows of a name, east before north; empty for a name that it does not know.
OGRSpatialReference reference_of(const std::string& crs);

}  // namespace skybake::io
