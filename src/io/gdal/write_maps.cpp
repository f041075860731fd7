#include "io/gdal/write_maps.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <utility>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/gdal/gdal_file.h"

namespace skybake::io {
namespace {

constexpr float kNoData = -9999.0f;

std::int64_t cell_of(const ReceiverSet& set, double x) {
    return static_cast<std::int64_t>(std::floor(x / set.cell_m));
}

bool is_on_ground(const ReceiverSet& set, const Sample& sample) {
    const ReceiverKind kind = set.receivers[sample.receiver].kind;
    return kind == ReceiverKind::ground || kind == ReceiverKind::polygon;
}

[[noreturn]] void fail_writing(const std::filesystem::path& path) {
    throw InputError(fmt::format("{}: cannot be written: {}", path.string(), CPLGetLastErrorMsg()));
}

/// A GeoPackage in the making, beside its place: its driver wants its own ending.
struct NewGeoPackage {
    explicit NewGeoPackage(std::filesystem::path place)
        : path(std::move(place)), part(path.parent_path() / (path.stem().string() + ".part.gpkg")) {
        std::filesystem::remove(part);
        CPLSetThreadLocalConfigOption("OGR_SQLITE_SYNCHRONOUS", "OFF");
        dataset.reset(
            GetGDALDriverManager()->GetDriverByName("GPKG")->Create(part.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
        if (!dataset) fail_writing(path);
    }
    ~NewGeoPackage() {
        dataset.reset();
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
    }
    void commit() {
        if (dataset->CommitTransaction() != OGRERR_NONE) fail_writing(path);
        dataset.reset();
        std::filesystem::rename(part, path);
    }
    std::filesystem::path path, part;
    DatasetPtr dataset;
};

void add_fields(OGRLayer& layer, std::initializer_list<std::pair<const char*, OGRFieldType>> fields) {
    for (const auto& [name, type] : fields) {
        OGRFieldDefn field(name, type);
        layer.CreateField(&field);
    }
}

/// Rings by the even-odd rule as polygons with holes.
std::unique_ptr<OGRGeometry> shape_of(const ShadowOutline& outline) {
    std::vector<OGRGeometry*> rings;  // organizePolygons takes them over
    for (const std::vector<Vec2d>& points : outline.rings) {
        auto ring = std::make_unique<OGRLinearRing>();
        for (const Vec2d& p : points) ring->addPoint(p.x, p.y);
        ring->closeRings();
        auto polygon = std::make_unique<OGRPolygon>();
        polygon->addRingDirectly(ring.release());
        rings.push_back(polygon.release());
    }
    int is_valid = 0;
    std::unique_ptr<OGRGeometry> shape(
        OGRGeometryFactory::organizePolygons(rings.data(), static_cast<int>(rings.size()), &is_valid, nullptr));
    return std::unique_ptr<OGRGeometry>(OGRGeometryFactory::forceToMultiPolygon(shape.release()));
}

}  // namespace

std::optional<RasterExtent> raster_extent(const ReceiverSet& set) {
    std::int64_t left = INT64_MAX, right = INT64_MIN, bottom = INT64_MAX, top = INT64_MIN;
    for (const Sample& sample : set.samples) {
        if (!is_on_ground(set, sample)) continue;
        const std::int64_t x = cell_of(set, sample.position.x), y = cell_of(set, sample.position.y);
        left = std::min(left, x), right = std::max(right, x);
        bottom = std::min(bottom, y), top = std::max(top, y);
    }
    if (left > right) return std::nullopt;
    return RasterExtent{left, top, right - left + 1, top - bottom + 1};
}

bool write_geotiff(const std::filesystem::path& path, const ReceiverSet& set, const std::vector<RasterBand>& bands,
                   const std::string& crs) {
    const std::optional<RasterExtent> extent = raster_extent(set);
    if (!extent || bands.empty()) return false;
    const auto [left, top, width, height] = *extent;
    const QuietErrors quiet;
    register_drivers();
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    FileReplacement replacement(path);
    const char* options[] = {"COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", nullptr};
    DatasetPtr file(driver->Create(replacement.part_path().c_str(), static_cast<int>(width), static_cast<int>(height),
                                   static_cast<int>(bands.size()), GDT_Float32, const_cast<char**>(options)));
    if (!file) fail_writing(path);
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    double place[6] = {static_cast<double>(left) * set.cell_m,    set.cell_m, 0.0,
                       static_cast<double>(top + 1) * set.cell_m, 0.0,        -set.cell_m};
    file->SetGeoTransform(place);
    const OGRSpatialReference reference = reference_of(crs);
    if (!reference.IsEmpty()) file->SetSpatialRef(&reference);
    for (std::size_t b = 0; b < bands.size(); ++b) {
        std::vector<float> pixels(static_cast<std::size_t>(width) * height, kNoData);
        for (std::size_t i = 0; i < set.samples.size(); ++i) {
            const Sample& sample = set.samples[i];
            if (!is_on_ground(set, sample)) continue;
            pixels[static_cast<std::size_t>(top - cell_of(set, sample.position.y)) * width +
                   static_cast<std::size_t>(cell_of(set, sample.position.x) - left)] = (*bands[b].values)[i];
        }
        GDALRasterBand* band = file->GetRasterBand(static_cast<int>(b) + 1);
        band->SetNoDataValue(static_cast<double>(kNoData));
        band->SetDescription(bands[b].name.c_str());
        band->SetUnitType(bands[b].unit.c_str());
        if (band->RasterIO(GF_Write, 0, 0, w, h, pixels.data(), w, h, GDT_Float32, 0, 0) != CE_None) fail_writing(path);
    }
    file.reset();
    replacement.commit();
    return true;
}

void write_geopackage(const std::filesystem::path& path, const ReceiverSet& set, const std::vector<CellColumn>& columns,
                      const std::string& crs) {
    const QuietErrors quiet;
    register_drivers();
    NewGeoPackage package(path);
    GDALDataset* file = package.dataset.get();
    OGRSpatialReference reference = reference_of(crs);
    file->StartTransaction();
    for (const bool is_point : {false, true}) {
        const bool is_needed = std::any_of(set.receivers.begin(), set.receivers.end(), [&](const Receiver& r) {
            return (r.kind == ReceiverKind::point) == is_point && r.sample_begin < r.sample_end;
        });
        if (!is_needed) continue;
        OGRLayer* layer = file->CreateLayer(is_point ? "points" : "cells", reference.IsEmpty() ? nullptr : &reference,
                                            is_point ? wkbPoint25D : wkbPolygon25D, nullptr);
        if (!layer) fail_writing(path);
        add_fields(*layer, {{"receiver", OFTString},
                            {"kind", OFTString},
                            {"building", OFTString},
                            {"storey", OFTInteger},
                            {"area_m2", OFTReal}});
        for (const CellColumn& column : columns) {
            OGRFieldDefn field(column.name.c_str(), column.numbers ? OFTReal : OFTString);
            layer->CreateField(&field);
        }
        for (std::size_t i = 0; i < set.samples.size(); ++i) {
            const Sample& s = set.samples[i];
            const Receiver& receiver = set.receivers[s.receiver];
            if ((receiver.kind == ReceiverKind::point) != is_point) continue;
            OGRFeature feature(layer->GetLayerDefn());
            feature.SetField(0, receiver.id.c_str());
            feature.SetField(1, name_of(receiver.kind));
            if (!receiver.building_id.empty()) feature.SetField(2, receiver.building_id.c_str());
            if (receiver.storey) feature.SetField(3, *receiver.storey);
            feature.SetField(4, static_cast<double>(s.area_m2));
            for (std::size_t c = 0; c < columns.size(); ++c) {
                const int field = static_cast<int>(c) + 5;
                if (columns[c].numbers) {
                    feature.SetField(field, static_cast<double>((*columns[c].numbers)[i]));
                } else {
                    feature.SetField(field, columns[c].words[i].c_str());
                }
            }
            if (is_point) {
                OGRPoint point(s.position.x, s.position.y, s.position.z);
                feature.SetGeometry(&point);
            } else {
                OGRLinearRing ring;
                const Vec3d a = s.position + Vec3d(s.corner), u(s.u), v(s.v);
                for (const Vec3d& p : {a, a + u, a + u + v, a + v, a}) ring.addPoint(p.x, p.y, p.z);
                OGRPolygon polygon;
                polygon.addRing(&ring);
                feature.SetGeometry(&polygon);
            }
            if (layer->CreateFeature(&feature) != OGRERR_NONE) fail_writing(path);
        }
    }
    package.commit();
}

void write_shadows_gpkg(const std::filesystem::path& path, const StudyPictures& pictures, const Study& study,
                        double convergence_rad, const std::string& crs) {
    const QuietErrors quiet;
    register_drivers();
    NewGeoPackage package(path);
    OGRSpatialReference reference = reference_of(crs);
    package.dataset->StartTransaction();
    OGRLayer* layer =
        package.dataset->CreateLayer("shadows", reference.IsEmpty() ? nullptr : &reference, wkbMultiPolygon, nullptr);
    if (!layer) fail_writing(path);
    add_fields(*layer, {{"kind", OFTString},
                        {"day", OFTString},
                        {"clock", OFTString},
                        {"utc", OFTString},
                        {"sun_azimuth_deg", OFTReal},
                        {"sun_elevation_deg", OFTReal},
                        {"area_m2", OFTReal}});
    for (const HourShadow& shadow : pictures.shadows) {
        if (shadow.outline.rings.empty()) continue;
        const SunDay& day = study.days[shadow.day];
        const Vec3d sun(day.direction(shadow.second));
        const double azimuth = degrees_from_radians(std::atan2(sun.x, sun.y) + convergence_rad);
        OGRFeature feature(layer->GetLayerDefn());
        feature.SetField(0, name_of(shadow.kind));
        feature.SetField(1, fmt::format("{:04}-{:02}-{:02}", day.year(), day.day().month, day.day().day).c_str());
        feature.SetField(2, shadow.clock.c_str());
        feature.SetField(3, to_iso8601({{day.time_of(shadow.second).milliseconds / 1000 * 1000}, 0}).c_str());
        feature.SetField(4, azimuth < 0.0 ? azimuth + 360.0 : azimuth);
        feature.SetField(5, degrees_from_radians(std::asin(sun.z)));
        feature.SetField(6, shadow.outline.area_m2);
        const auto shape = shape_of(shadow.outline);
        feature.SetGeometry(shape.get());
        if (layer->CreateFeature(&feature) != OGRERR_NONE) fail_writing(path);
    }
    package.commit();
}

}  // namespace skybake::io
