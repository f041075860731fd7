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

/// The leaves of a plant as a body that dims light on its way through. Its surface stays in the scene and gets light
/// like any other, but does not stop rays (trace/crown_volume.h).
struct Crown {
    std::uint32_t object = 0;  // index into Scene::objects
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    /// Of a closed body: optical depth a metre of way within it, m⁻¹.
    float extinction = 0.0f;
    /// Of an open surface, such as crossed boards: optical depth of each crossing.
    float depth_per_crossing = 0.0f;
    Vec3f center{0.0f};   // of its box, local metres
    float radius = 0.0f;  // of the sphere about it
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
    std::vector<Crown> crowns;  // none where they are opaque
    Box3f bounds;
};

/// How trees and hedges meet light.
enum class CrownTreatment : std::uint8_t { transparent, opaque };

/// Share of light that passes a crown along its mean chord. Source: J. Konarska et al., "Transmissivity of solar
/// radiation through crowns of single urban trees", Theoretical and Applied Climatology 117, 2014: 1.3–5.3 % with
/// leaves, 40.2–51.9 % without.
inline constexpr float kTransmissivityInLeaf = 0.03f;
inline constexpr float kTransmissivityBare = 0.46f;

struct SceneOptions {
    /// A face larger than this along x, y or z is cut into pieces, so that each fits a lightmap page. Metres.
    float max_piece_m = 256.0f;
    /// Albedo of surfaces without material and texture, by type; see default_albedo.
    std::vector<std::pair<SurfaceType, Rgb>> albedo_override;
    CrownTreatment crowns = CrownTreatment::opaque;
    float crown_transmissivity = kTransmissivityInLeaf;  // along the mean chord, above 0 and below 1
};

/// Believable linear albedo of a surface that states none. Source: the table in docs/physics.md.
Rgb default_albedo(SurfaceType type);

/// Triangulates and moves the repaired city into the local frame. Objects are sorted by id, so their order in the file
/// does not matter. Polygons that cannot be triangulated are left out with finding SB212.
///
/// Crowns are solitary plants, and plant covers that are closed bodies; a flat plant cover is ground. A closed body of
/// volume V and surface S has the mean chord 4 V / S (Cauchy), along which `crown_transmissivity` is left; an open
/// surface dims by its square root at each crossing (in and out), with finding SB218.
Scene build_scene(const CityModel& city, const SceneOptions& options, class FindingLog& findings);

}  // namespace skybake
