// Roof planes with dormers and chimneys joined into them: the plane gets a hole, the fitting stands in it, and the
// shell stays closed.
#pragma once

#include <vector>

#include "city/town/object_builder.h"
#include "city/town/styles.h"

namespace skybake::town {

/// A vertical plane's finish: u runs along `u` (unit, in plan) from `origin`.
Finish wall_finish(SurfaceType type, TextureId texture, Vec3d origin, Vec2d u, double u_per_m, double v_per_m);

/// A sloping plane over plan coordinates (x along the eave, y up the slope), z = z0 + slope · y.
struct RoofPlane {
    Vec2d origin{0.0};
    Vec2d u{1.0, 0.0};
    Vec2d v{0.0, 1.0};
    double z0 = 0.0;
    double slope = 1.0;
    std::vector<Vec2d> outline;             // plan coordinates, counter-clockwise, convex
    std::vector<std::vector<Vec2d>> holes;  // clockwise

    Vec3d at(double x, double y) const { return lifted(x, y, z0 + slope * y); }
    Vec3d lifted(double x, double y, double z) const;
    bool has_room(double x0, double x1, double y0, double y1) const;
};

struct DormerShape {
    double width = 1.3;
    double height = 1.35;
    double gable = 0.6;  // of its ridge above its eaves; 0 for a dormer with a lean-to roof
};

/// False when there is no room, and nothing is added.
bool add_dormer(ObjectBuilder& builder, RoofPlane& plane, double x, double y, const DormerShape& shape, int facade,
                int tiles);
bool add_chimney(ObjectBuilder& builder, RoofPlane& plane, double x, double y, double size_x, double size_y,
                 double top_above, int plaster);
/// The plane itself, with the holes of what was added before.
void add_plane(ObjectBuilder& builder, const RoofPlane& plane, TextureId texture, double period_m);

}  // namespace skybake::town
