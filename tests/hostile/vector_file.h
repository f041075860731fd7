// Footprints in any of GDAL's vector formats, for tests.
#pragma once

#include <ogrsf_frmts.h>

#include <filesystem>

namespace skybake {

/// Writes `count` squares of 8 m with a height of 10 m in a row, EPSG:25832.
inline void write_squares(const std::filesystem::path& path, const char* driver, int count) {
    GDALAllRegister();
    const GDALDatasetUniquePtr dataset(
        GetGDALDriverManager()->GetDriverByName(driver)->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference system;
    system.importFromEPSG(25832);
    OGRLayer* layer = dataset->CreateLayer("houses", &system, wkbPolygon);
    OGRFieldDefn height("height", OFTReal);
    layer->CreateField(&height);
    [[maybe_unused]] OGRErr fault = layer->StartTransaction();
    for (int i = 0; i < count; ++i) {
        OGRFeature feature(layer->GetLayerDefn());
        feature.SetField("height", 10.0);
        OGRLinearRing ring;
        for (const auto& [x, y] : {std::pair(0, 0), {8, 0}, {8, 8}, {0, 8}, {0, 0}})
            ring.addPoint(500000.0 + 10 * i + x, 5300000.0 + y);
        OGRPolygon square;
        square.addRing(&ring);
        feature.SetGeometry(&square);
        fault = layer->CreateFeature(&feature);
    }
    fault = layer->CommitTransaction();
}

}  // namespace skybake
