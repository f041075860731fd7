// Footprints into bodies with simple roofs.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "city/city_model.h"

namespace skybake {

enum class RoofShape : std::uint8_t { flat, gabled, hipped, pyramidal };

struct Footprint {
    std::vector<std::vector<Vec2d>>
        rings;                   // the outer one, then holes; either direction, the first corner not repeated
    Vec2d metres_per_unit{1.0};  // of the map coordinates, where they are degrees
    double base_m = 0.0;         // of the underside
    double eaves_m = 0.0;        // where walls end
    double ridge_m = 0.0;        // the roof's highest; not below the eaves
    RoofShape roof = RoofShape::flat;
    bool is_ridge_across = false;  // along the shorter sides of a gabled roof (OSM: roof:orientation=across)
};

/// True when `shape` can be built on the footprint: anything flat, convex outlines without holes pyramidal, convex ones
/// of four corners gabled or hipped.
bool fits(RoofShape shape, const Footprint& footprint);

/// Appends the body to `geometry` as the outer shell of a solid: underside, walls, roof. A roof that does not fit is
/// built flat, at the ridge. Roofs of even pitch for rectangles; hips fall as steeply as the long sides.
void extrude(const Footprint& footprint, Geometry& geometry);

}  // namespace skybake
