#include "io/gdal/gdal_file.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <mutex>
#include <vector>

#include "base/error.h"

namespace skybake::io {

void register_drivers() {
    static std::once_flag once;
    std::call_once(once, [] {
        GDALAllRegister();
        CPLSetConfigOption("OGR_SQLITE_LOAD_EXTENSIONS", "");  // a GeoPackage brings no code
    });
}

DatasetPtr open_dataset(const std::filesystem::path& path, unsigned kind, std::span<const char* const> drivers) {
    register_drivers();
    std::vector<const char*> allowed(drivers.begin(), drivers.end());
    allowed.push_back(nullptr);
    const QuietErrors quiet;
    CPLErrorReset();
    DatasetPtr dataset(GDALDataset::Open(path.c_str(), kind | GDAL_OF_READONLY, allowed.data(), nullptr, nullptr));
    const std::string reason = CPLGetLastErrorMsg();
    if (!dataset) {
        throw InputError(fmt::format("{}: cannot be opened ({}). Write it anew with GDAL.", path.string(),
                                     reason.empty() ? "it is damaged or of another kind" : reason.substr(0, 300)));
    }
    return dataset;
}

NamedSystem named_system(const OGRSpatialReference* system) {
    NamedSystem named;
    if (!system || system->IsEmpty()) return named;
    named.is_latitude_first = system->IsGeographic() && system->EPSGTreatsAsLatLong();
    const char* authority = system->GetAuthorityName(nullptr);
    const char* code = system->GetAuthorityCode(nullptr);
    if (authority && code && std::string_view(authority) == "EPSG") {
        named.name = fmt::format("EPSG:{}", code);
        return named;
    }
    char* wkt = nullptr;
    const char* options[] = {"FORMAT=WKT2_2019", nullptr};
    if (system->exportToWkt(&wkt, options) == OGRERR_NONE && wkt) named.name = wkt;
    CPLFree(wkt);
    return named;
}

OGRSpatialReference reference_of(const std::string& crs) {
    OGRSpatialReference reference;
    if (!crs.empty()) {
        // "EPSG:25832+5783" is compound; GDAL knows that form.
        // The name may come from a stranger's file: it opens no other file.
        const char* const limits[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
        if (reference.SetFromUserInput(crs.c_str(), limits) != OGRERR_NONE) reference.Clear();
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    return reference;
}

}  // namespace skybake::io
