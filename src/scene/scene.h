// The city as triangles in a local frame: what rays hit and what gets light.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/ids.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "city/city_model.h"
#include "scene/albedo_image.h"

namespace skybake {

/// What a surface looks like and how much it reflects.
struct SceneMaterial {
    std::string name;
    Rgb albedo{0.5f};  // linear, 0…1; with a texture, the factor 1 and the texture's own albedo
    std::optional<TextureId> texture;
    TextureWrap wrap = TextureWrap::repeat;
    friend bool operator==(const SceneMaterial&, const SceneMaterial&) = default;
};

/// One planar polygon of the city, as a run of triangles.
struct Face {
    std::uint32_t object = 0;  // index into Scene::objects
    SurfaceType type = SurfaceType::unknown;
    MaterialId material;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    std::uint32_t source_index = 0;  // Surface::source_index
};

struct SceneObject {
    std::string id;
    std::string building_id;  // the topmost parent's id, or its own
    ObjectType type = ObjectType::other;
};

struct Scene {
    Vec3d origin{0.0};                 // map coordinates of the local frame's (0, 0, 0)
    std::vector<SceneObject> objects;  // sorted by id
    std::vector<Face> faces;           // sorted by object and source index
    std::vector<SceneMaterial> materials;
    std::vector<Texture> textures;
    std::vector<AlbedoImage> albedo_images;  // one a texture; none where nobody asked for reflected light

    std::vector<std::array<Vec3f, 3>> triangles;     // local metres, counter-clockwise seen from outside
    std::vector<std::array<Vec2f, 3>> triangle_uvs;  // texture coordinates, (0, 0) lower left; zeros without a texture
    std::vector<FaceId> triangle_face;
    Box3f bounds;
};

struct SceneOptions {
    /// A face larger than this along x, y or z is cut into pieces, so that each fits a lightmap page. Metres.
    float max_piece_m = 256.0f;
    /// Albedo of surfaces without material and texture, by type; see default_albedo.
    std::vector<std::pair<SurfaceType, Rgb>> albedo_override;
};

/// Believable linear albedo of a surface that states none. Source: the table in docs/physics.md.
Rgb default_albedo(SurfaceType type);

/// Triangulates and moves the repaired city into the local frame. Objects are sorted by id, so their order in the file
/// does not matter. Polygons that cannot be triangulated are left out with finding SB212.
Scene build_scene(const CityModel& city, const SceneOptions& options, class FindingLog& findings);

}  // namespace skybake
