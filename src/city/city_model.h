// A city as data: what the readers produce and everything else starts from. No file format and no ray is known here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/ids.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

/// What an object is, as far as light cares. `other` keeps its original name in CityObject::type_name.
enum class ObjectType : std::uint8_t {
    building,
    building_part,
    building_installation,
    bridge,
    tunnel,
    road,
    railway,
    square,
    land_use,
    plant_cover,
    solitary_vegetation,
    water,
    terrain,
    furniture,
    generic,
    other
};

/// What a surface is for the default albedo, the reports and the receivers.
enum class SurfaceType : std::uint8_t {
    unknown,
    ground,  // the underside of a building
    wall,
    roof,
    closure,
    floor,    // outer floor
    ceiling,  // outer ceiling
    window,
    door,
    terrain,
    road,
    water,
    vegetation,
    other
};

const char* name_of(ObjectType type);
const char* name_of(SurfaceType type);

/// How texture coordinates outside [0, 1] are answered.
enum class TextureWrap : std::uint8_t { none, repeat, mirror, clamp, border };

struct Texture {
    std::string path;  // resolved, readable file; empty when missing
    std::string uri;   // as the file names it
    TextureWrap wrap = TextureWrap::repeat;
    Rgb border_color{1.0f};  // linear; for TextureWrap::border
    bool is_missing = false;
    /// The encoded picture where it stands in the city file itself; `path` is empty then, and `uri` names its content.
    std::shared_ptr<const std::vector<std::uint8_t>> embedded{};
};

struct Material {
    std::string name;
    Rgb albedo{0.5f};  // linear, 0…1
    float transparency = 0.0f;
};

/// One planar polygon: rings [ring_begin, ring_end) of its geometry, the outer one first, then the holes.
struct Surface {
    std::uint32_t ring_begin = 0;
    std::uint32_t ring_end = 0;
    SurfaceType type = SurfaceType::unknown;
    std::optional<MaterialId> material;
    std::optional<TextureId> texture;
    std::uint32_t source_index =
        0;  // which polygon of the geometry in its file, counted through; part of stable ids and places
};

/// Surfaces that belong together: a shell of a solid encloses a volume, a loose set does not.
struct Shell {
    enum class Kind : std::uint8_t { outer, inner, loose };
    std::uint32_t surface_begin = 0;
    std::uint32_t surface_end = 0;
    Kind kind = Kind::loose;
};

/// Polygons in flat arrays. Ring r is corners [ring_first[r], ring_first[r + 1]); it is not closed (no repeated last
/// corner).
struct Geometry {
    std::vector<Vec3d> vertices;         // map coordinates, metres
    std::vector<std::uint32_t> corners;  // indices into vertices
    std::vector<Vec2f>
        corner_uv;  // empty, or one a corner; (0, 0) is the image's lower left as in CityJSON and CityGML
    std::vector<std::uint32_t> ring_first{0};  // one more than there are rings
    std::vector<Surface> surfaces;
    std::vector<Shell> shells;  // cover all surfaces, in order

    bool is_empty() const { return surfaces.empty(); }
};

struct CityObject {
    std::string id;
    std::string parent_id;  // empty at the top
    ObjectType type = ObjectType::other;
    std::string type_name;  // as the file names it, without "+"
    std::string lod;        // of `geometry`; empty when it has none
    Geometry geometry;
    std::string attributes_json = "{}";
    std::string where;  // "file: #/CityObjects/ID", for findings
};

struct CityModel {
    std::vector<CityObject> objects;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::string crs;                // as the file names it ("EPSG:7415", a URL or a URN); empty when it names none
    std::vector<std::string> lods;  // all that the files offer, sorted
    std::vector<std::string> files;
    std::optional<Box3d> stated_extent;  // geographicalExtent of the metadata
};

/// The box of all vertices that a surface uses; empty for a city without surfaces.
Box3d extent_of(const CityModel& city);

/// True for objects that are or belong to a building.
bool is_building(ObjectType type);
/// True for objects on which people walk: terrain, roads, squares, land use, plant cover, water.
bool is_ground(ObjectType type);

}  // namespace skybake
