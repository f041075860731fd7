// Where a study asks for light: points with normals and areas, grouped from the cell to the building.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/finding.h"
#include "base/vec.h"
#include "scene/scene.h"
#include "trace/ray_scene.h"

namespace skybake {

enum class ReceiverKind : std::uint8_t { ground, polygon, roof, facade, window, point };

/// "ground", "polygon", "roof", "facade", "window" or "point".
const char* name_of(ReceiverKind kind);

/// One cell of a receiver: the point that stands for it, and the parallelogram that it covers.
struct Sample {
    Vec3d position{0.0};          // map coordinates, metres
    Vec3f normal{0, 0, 1};        // unit, away from the surface
    float area_m2 = 0.0f;         // of the surface within the cell; 0 for a free point
    Vec3f corner{0}, u{0}, v{0};  // the cell is position + corner + [0, 1] u + [0, 1] v; zeros for a free point
    std::uint32_t receiver = 0;   // index into ReceiverSet::receivers
};

/// The smallest group that reports name: a storey of a façade, a roof, a window, a polygon, the ground, or a point.
struct Receiver {
    std::string id;  // stable: "OBJECT/SURFACE/STOREY" from the file's ids, a polygon's or point's id, or "ground"
    ReceiverKind kind = ReceiverKind::point;
    std::string building_id;               // empty for ground, polygons and points
    std::string object_id;                 // likewise
    std::optional<std::uint32_t> surface;  // the lowest source index of its polygons within the object
    std::vector<std::uint32_t> polygons;   // source indices of all of them, ascending
    std::optional<int> storey;             // 0 is the lowest
    double area_m2 = 0.0;
    std::uint32_t sample_begin = 0;
    std::uint32_t sample_end = 0;  // samples of one receiver stand together
};

struct ReceiverSet {
    std::vector<Sample> samples;
    std::vector<Receiver> receivers;
    double cell_m = 1.0;         // lattice of ground and polygons: cell edges at whole multiples in map coordinates
    std::uint64_t enclosed = 0;  // cells left out because they lie inside a building or below the ground
};

/// An area on the ground that is a receiver of its own: a park, a square, a garden. Even-odd rule over all rings.
struct AreaPolygon {
    std::string id;
    std::vector<std::vector<Vec2d>> rings;  // map coordinates; not closed
};

/// A free point; `normal` unit.
struct StudyPoint {
    std::string id;
    Vec3d position{0.0};
    Vec3d normal{0.0, 0.0, 1.0};
};

struct ReceiverOptions {
    std::vector<ReceiverKind> kinds = {};
    double cell_m = 1.0;           // at most this long along each side of a cell
    double height_m = 0.0;         // of ground and polygon samples above the ground
    double storey_height_m = 3.0;  // façades are cut at whole storeys above the building's lowest wall point
    std::vector<AreaPolygon> polygons = {};
    std::vector<StudyPoint> points = {};
    std::vector<std::string> excluded_objects = {};  // ids whose surfaces are no receivers, although they throw shadows
};

/// The receivers of a scene, in the order ground, polygons, roofs, façades, windows, points, and by object, surface and
/// storey within. Façades are the polygons of a building that share edges and a plane (1°, 2 cm); surfaces without
/// semantics count as walls where they stand within 10° of upright, as roofs where they face up. A cell that a surface
/// fills in part has the area of that part and its centroid as point. Cells that lie within a body are left out
/// (`ReceiverSet::enclosed`): those that see an inner side along their normal, or anything within 10 cm; an inner side
/// of the ground above, or of a roof without seeing the sky; or the underside of a building within 1 m above. Parallel;
/// the same for any number of threads.
ReceiverSet make_receivers(const Scene& scene, const RayScene& rays, const ReceiverOptions& options);

/// Height of the ground at the centre of each cell of a lattice over `lo`…`hi` (map coordinates), the highest where
/// several lie above each other; row by row from the south-west, NaN where there is none.
struct GroundHeights {
    std::int64_t first_column = 0, first_row = 0;  // of the lattice through the map's origin
    int columns = 0, rows = 0;
    std::vector<double> height_m;
};
GroundHeights ground_heights(const Scene& scene, double cell_m, const Vec2d& lo, const Vec2d& hi);

}  // namespace skybake
