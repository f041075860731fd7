#include "io/gdal/read_areas.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <memory>

#include "base/box.h"
#include "base/error.h"
#include "io/gdal/gdal_file.h"

namespace skybake::io {
namespace {

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

}  // namespace

std::vector<AreaPolygon> read_polygons(const std::filesystem::path& path, const std::string& crs, const Vec2d& lo,
                                       const Vec2d& hi) {
    const DatasetPtr file = open_dataset(path, GDAL_OF_VECTOR, kVectorDrivers);
    const QuietErrors quiet;
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

}  // namespace skybake::io
