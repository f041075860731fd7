#include "city/town/roof.h"

#include <algorithm>
#include <cmath>

#include "city/town/plane_geometry.h"

namespace skybake::town {
namespace {

constexpr double kClear =
    0.25;  // between a fitting and the plane's rim or another fitting: half a texel of a coarse lightmap

/// A vertical side of a fitting, in the plane's own axes: along x (sign +1 or -1) or along y.
Finish plaster_on(const RoofPlane& plane, Vec3d origin, Vec2d along, int colour) {
    return wall_finish(SurfaceType::wall, id_of(Picture::plaster_first, colour), origin,
                       glm::normalize(plane.u * along.x + plane.v * along.y), 1.0 / kPlasterPeriod,
                       1.0 / kPlasterPeriod);
}

}  // namespace

Finish wall_finish(SurfaceType type, TextureId texture, Vec3d origin, Vec2d u, double u_per_m, double v_per_m) {
    return {type, texture, {origin, Vec3d(u * u_per_m, 0.0), Vec3d(0.0, 0.0, v_per_m), Vec2d(0.0)}};
}

Vec3d RoofPlane::lifted(double x, double y, double z) const {
    const Vec2d p = origin + u * x + v * y;
    return {p.x, p.y, z};
}

bool RoofPlane::has_room(double x0, double x1, double y0, double y1) const {
    for (const Vec2d& corner : {Vec2d(x0, y0), Vec2d(x1, y0), Vec2d(x1, y1), Vec2d(x0, y1)}) {
        if (depth_inside(outline, corner) < kClear) return false;
    }
    for (const std::vector<Vec2d>& hole : holes) {
        Vec2d lo = hole[0];
        Vec2d hi = hole[0];
        for (const Vec2d& p : hole) {
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
        }
        if (x0 < hi.x + kClear && x1 > lo.x - kClear && y0 < hi.y + kClear && y1 > lo.y - kClear) return false;
    }
    return true;
}

bool add_dormer(ObjectBuilder& builder, RoofPlane& plane, double x, double y, const DormerShape& shape, int facade,
                int tiles) {
    const double x0 = x - 0.5 * shape.width;
    const double x1 = x + 0.5 * shape.width;
    const double lean_slope = 0.3;  // of a lean-to roof
    const bool is_gabled = shape.gable > 0.0;
    const double y_back = y + shape.height / (is_gabled ? plane.slope : plane.slope - lean_slope);
    const double y_ridge = is_gabled ? y + (shape.height + shape.gable) / plane.slope : y_back;
    if (plane.slope < lean_slope + 0.2 || !plane.has_room(x0, x1, y, y_ridge)) return false;

    const double z = plane.z0 + plane.slope * y;
    const double top = z + shape.height;
    const Vec3d front0 = plane.at(x0, y);
    const Vec3d front1 = plane.at(x1, y);
    const Vec3d eave0 = plane.lifted(x0, y, top);
    const Vec3d eave1 = plane.lifted(x1, y, top);
    const Vec3d back0 = plane.at(x0, y_back);
    const Vec3d back1 = plane.at(x1, y_back);

    // The front shows one window of the façade's first floor, drawn smaller.
    Finish front = wall_finish(SurfaceType::wall, id_of(Picture::facade_first, facade), front0, plane.u,
                               1.2 / (kFacadeBays * kBayWidth), 1.36 / kFacadeHeight);
    front.frame.offset = {0.5 / kFacadeBays - 0.5 * shape.width * 1.2 / (kFacadeBays * kBayWidth),
                          (kGroundStorey + 0.72) / kFacadeHeight};
    const Finish cheek0 = plaster_on(plane, back0, {0.0, -1.0}, facade);
    const Finish cheek1 = plaster_on(plane, front1, {0.0, 1.0}, facade);
    const auto roof_finish = [&](Vec3d origin, Vec3d along, Vec3d up) {
        return Finish{SurfaceType::roof,
                      id_of(Picture::tiles_first, tiles),
                      {origin, glm::normalize(along) / kTilePeriod, glm::normalize(up) / kTilePeriod, Vec2d(0.0)}};
    };
    builder.add({back0, front0, eave0}, cheek0);
    builder.add({front1, back1, eave1}, cheek1);
    if (is_gabled) {
        const Vec3d apex = plane.lifted(x, y, top + shape.gable);
        const Vec3d ridge = plane.at(x, y_ridge);
        builder.add({front0, front1, eave1, apex, eave0}, front);
        builder.add({back0, eave0, apex, ridge}, roof_finish(back0, eave0 - back0, apex - eave0));
        builder.add({eave1, back1, ridge, apex}, roof_finish(eave1, back1 - eave1, apex - eave1));
        plane.holes.push_back({{x0, y}, {x0, y_back}, {x, y_ridge}, {x1, y_back}, {x1, y}});
    } else {
        builder.add({front0, front1, eave1, eave0}, front);
        builder.add({eave0, eave1, back1, back0}, roof_finish(eave0, eave1 - eave0, back0 - eave0));
        plane.holes.push_back({{x0, y}, {x0, y_back}, {x1, y_back}, {x1, y}});
    }
    return true;
}

bool add_chimney(ObjectBuilder& builder, RoofPlane& plane, double x, double y, double size_x, double size_y,
                 double top_above, int plaster) {
    const double x0 = x - 0.5 * size_x;
    const double x1 = x + 0.5 * size_x;
    const double y0 = y - 0.5 * size_y;
    const double y1 = y + 0.5 * size_y;
    if (!plane.has_room(x0, x1, y0, y1)) return false;
    const double top = plane.z0 + plane.slope * y1 + top_above;
    const Vec3d a = plane.at(x0, y0);
    const Vec3d b = plane.at(x1, y0);
    const Vec3d c = plane.at(x1, y1);
    const Vec3d d = plane.at(x0, y1);
    const Vec3d at = plane.lifted(x0, y0, top);
    const Vec3d bt = plane.lifted(x1, y0, top);
    const Vec3d ct = plane.lifted(x1, y1, top);
    const Vec3d dt = plane.lifted(x0, y1, top);
    builder.add({a, b, bt, at}, plaster_on(plane, a, {1.0, 0.0}, plaster));
    builder.add({b, c, ct, bt}, plaster_on(plane, b, {0.0, 1.0}, plaster));
    builder.add({c, d, dt, ct}, plaster_on(plane, c, {-1.0, 0.0}, plaster));
    builder.add({d, a, at, dt}, plaster_on(plane, d, {0.0, -1.0}, plaster));
    builder.add({at, bt, ct, dt}, {SurfaceType::roof, id_of(Picture::masonry), ground_frame(kMasonryPeriod)});
    plane.holes.push_back({{x0, y0}, {x0, y1}, {x1, y1}, {x1, y0}});
    return true;
}

void add_plane(ObjectBuilder& builder, const RoofPlane& plane, TextureId texture, double period_m) {
    std::vector<Vec3d> outer;
    for (const Vec2d& p : plane.outline) outer.push_back(plane.at(p.x, p.y));
    std::vector<std::vector<Vec3d>> holes;
    for (const std::vector<Vec2d>& hole : plane.holes) {
        std::vector<Vec3d>& ring = holes.emplace_back();
        for (const Vec2d& p : hole) ring.push_back(plane.at(p.x, p.y));
    }
    const double stretch = std::sqrt(1.0 + plane.slope * plane.slope);
    const Vec3d up = Vec3d(plane.v, plane.slope) / (stretch * period_m);
    builder.add(outer, holes,
                {SurfaceType::roof, texture, {plane.at(0.0, 0.0), Vec3d(plane.u / period_m, 0.0), up, Vec2d(0.0)}});
}

}  // namespace skybake::town
