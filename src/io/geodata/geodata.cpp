#include "io/geodata/geodata.h"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/box.h"
#include "base/error.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

constexpr float kNoData = -9999.0f;

struct Closer {
    void operator()(GDALDataset* d) const { GDALClose(d); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

/// GDAL's messages go to nobody; failures are told by exceptions of ours, with its last words.
class QuietGdal {
  public:
    QuietGdal() {
        GDALAllRegister();
        CPLPushErrorHandler(CPLQuietErrorHandler);
    }
    ~QuietGdal() { CPLPopErrorHandler(); }
};

OGRSpatialReference reference_of(const std::string& crs) {
    OGRSpatialReference reference;
    if (!crs.empty()) {
        // "EPSG:25832+5783" is compound; GDAL knows that form.
        if (reference.SetFromUserInput(crs.c_str()) != OGRERR_NONE) reference.Clear();
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    return reference;
}

void add_rings(const OGRPolygon& polygon, AreaPolygon& area) {
    const auto add = [&](const OGRLinearRing* ring) {
        std::vector<Vec2d> points;
        for (int i = 0; i + 1 < ring->getNumPoints(); ++i) points.push_back({ring->getX(i), ring->getY(i)});
        if (points.size() >= 3) area.rings.push_back(std::move(points));
    };
    if (polygon.getExteriorRing()) add(polygon.getExteriorRing());
    for (int i = 0; i < polygon.getNumInteriorRings(); ++i) add(polygon.getInteriorRing(i));
}

std::string id_of(OGRFeature& feature) {
    for (const char* name : {"id", "name"}) {
        const int field = feature.GetFieldIndex(name);
        if (field >= 0 && feature.IsFieldSetAndNotNull(field)) return feature.GetFieldAsString(field);
    }
    return std::to_string(feature.GetFID());
}

[[noreturn]] void fail_writing(const std::filesystem::path& path) {
    throw InputError(fmt::format("{}: cannot be written: {}", path.string(), CPLGetLastErrorMsg()));
}

}  // namespace

std::vector<AreaPolygon> read_polygons(const std::filesystem::path& path, const std::string& crs, const Vec2d& lo,
                                       const Vec2d& hi) {
    const QuietGdal quiet;
    const Dataset file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
    if (!file) throw InputError(fmt::format("{}: cannot be read as polygons: {}", path.string(), CPLGetLastErrorMsg()));
    const OGRSpatialReference target = reference_of(crs);
    std::vector<AreaPolygon> areas;
    Box2d box;
    for (OGRLayer* layer : file->GetLayers()) {
        OGREnvelope extent;
        const OGRSpatialReference* source = layer->GetSpatialRef();
        const bool is_beyond_degrees = layer->GetExtent(&extent) == OGRERR_NONE &&
                                       (std::abs(extent.MaxX) > 360.0 || std::abs(extent.MaxY) > 90.0 ||
                                        std::abs(extent.MinX) > 360.0 || std::abs(extent.MinY) > 90.0);
        if (source && source->IsGeographic() && is_beyond_degrees) source = nullptr;
        std::unique_ptr<OGRCoordinateTransformation> transform;
        if (source && !target.IsEmpty() && !source->IsSame(&target))
            transform.reset(OGRCreateCoordinateTransformation(source, &target));
        for (auto& feature : *layer) {
            const OGRGeometry* shape = feature->GetGeometryRef();
            if (!shape) continue;
            std::unique_ptr<OGRGeometry> copy(shape->clone());
            copy->flattenTo2D();
            if (transform && copy->transform(transform.get()) != OGRERR_NONE) continue;
            AreaPolygon area{id_of(*feature), {}};
            const OGRwkbGeometryType type = wkbFlatten(copy->getGeometryType());
            if (type == wkbPolygon) add_rings(*copy->toPolygon(), area);
            if (type == wkbMultiPolygon) {
                for (const OGRPolygon* part : *copy->toMultiPolygon()) add_rings(*part, area);
            }
            if (area.rings.empty()) continue;
            for (const std::vector<Vec2d>& ring : area.rings) {
                for (const Vec2d& p : ring) box.extend(p);
            }
            areas.push_back(std::move(area));
        }
    }
    if (areas.empty())
        throw InputError(fmt::format("{}: has no polygon. Give areas such as parks as polygons.", path.string()));
    if (box.lo.x > hi.x || box.lo.y > hi.y || box.hi.x < lo.x || box.hi.y < lo.y) {
        throw InputError(fmt::format(
            "{}: its polygons lie at ({:.1f}, {:.1f})…({:.1f}, {:.1f}), the city at ({:.1f}, {:.1f})…({:.1f}, {:.1f}) "
            "({}). Give them in the city's reference system, or name theirs in the file.",
            path.string(), box.lo.x, box.lo.y, box.hi.x, box.hi.y, lo.x, lo.y, hi.x, hi.y,
            crs.empty() ? "of no known reference system" : crs));
    }
    return areas;
}

bool write_geotiff(const std::filesystem::path& path, const ReceiverSet& set, const std::vector<RasterBand>& bands,
                   const std::string& crs) {
    std::int64_t left = INT64_MAX, right = INT64_MIN, bottom = INT64_MAX, top = INT64_MIN;
    const auto cell_of = [&](double x) { return static_cast<std::int64_t>(std::floor(x / set.cell_m)); };
    const auto is_on_ground = [&](const Sample& sample) {
        const ReceiverKind kind = set.receivers[sample.receiver].kind;
        return kind == ReceiverKind::ground || kind == ReceiverKind::polygon;
    };
    for (const Sample& sample : set.samples) {
        if (!is_on_ground(sample)) continue;
        left = std::min(left, cell_of(sample.position.x)), right = std::max(right, cell_of(sample.position.x));
        bottom = std::min(bottom, cell_of(sample.position.y)), top = std::max(top, cell_of(sample.position.y));
    }
    if (left > right || bands.empty()) return false;
    const QuietGdal quiet;
    const int width = static_cast<int>(right - left + 1), height = static_cast<int>(top - bottom + 1);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    FileReplacement replacement(path);
    const char* options[] = {"COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", nullptr};
    Dataset file(driver->Create(replacement.part_path().c_str(), width, height, static_cast<int>(bands.size()),
                                GDT_Float32, const_cast<char**>(options)));
    if (!file) fail_writing(path);
    double place[6] = {static_cast<double>(left) * set.cell_m,    set.cell_m, 0.0,
                       static_cast<double>(top + 1) * set.cell_m, 0.0,        -set.cell_m};
    file->SetGeoTransform(place);
    const OGRSpatialReference reference = reference_of(crs);
    if (!reference.IsEmpty()) file->SetSpatialRef(&reference);
    for (std::size_t b = 0; b < bands.size(); ++b) {
        std::vector<float> pixels(static_cast<std::size_t>(width) * height, kNoData);
        for (std::size_t i = 0; i < set.samples.size(); ++i) {
            const Sample& sample = set.samples[i];
            if (!is_on_ground(sample)) continue;
            pixels[static_cast<std::size_t>(top - cell_of(sample.position.y)) * width +
                   static_cast<std::size_t>(cell_of(sample.position.x) - left)] = (*bands[b].values)[i];
        }
        GDALRasterBand* band = file->GetRasterBand(static_cast<int>(b) + 1);
        band->SetNoDataValue(static_cast<double>(kNoData));
        band->SetDescription(bands[b].name.c_str());
        band->SetUnitType(bands[b].unit.c_str());
        if (band->RasterIO(GF_Write, 0, 0, width, height, pixels.data(), width, height, GDT_Float32, 0, 0) != CE_None)
            fail_writing(path);
    }
    file.reset();
    replacement.commit();
    return true;
}

void write_geopackage(const std::filesystem::path& path, const ReceiverSet& set, const std::vector<CellColumn>& columns,
                      const std::string& crs) {
    const QuietGdal quiet;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    // The driver wants its own ending, so the part is beside under another name.
    const std::filesystem::path part = path.parent_path() / (path.stem().string() + ".part.gpkg");
    std::filesystem::remove(part);
    CPLSetThreadLocalConfigOption("OGR_SQLITE_SYNCHRONOUS", "OFF");
    Dataset file(driver->Create(part.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!file) fail_writing(path);
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
        for (const auto& [name, type] : {std::pair{"receiver", OFTString},
                                         {"kind", OFTString},
                                         {"building", OFTString},
                                         {"storey", OFTInteger},
                                         {"area_m2", OFTReal}}) {
            OGRFieldDefn field(name, type);
            layer->CreateField(&field);
        }
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
    if (file->CommitTransaction() != OGRERR_NONE) fail_writing(path);
    file.reset();
    std::filesystem::rename(part, path);
}

}  // namespace skybake::io
