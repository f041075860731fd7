// What a ray finds on the city's surfaces: where it is, which way it faces, how much it reflects.
#pragma once

#include <cstdint>

#include "base/rgb.h"
#include "base/vec.h"
#include "scene/scene.h"
#include "trace/ray_scene.h"

namespace skybake {

/// A point that light meets. Surfaces are Lambertian and reflect on both sides alike. A leaf within a crown scatters to
/// all sides alike: its light is what it takes in of the irradiance from all around, a quarter of the sum over
/// directions, as the cosine's mean over all of a small body's faces has it.
struct SurfacePoint {
    Vec3f position{0.0f};  // on the surface (not lifted off it), local metres
    Vec3f normal{0.0f};    // unit, of the triangle, on the side that the ray came from; 0 for a leaf
    Rgb albedo{0.0f};      // linear, 0…1; of a leaf: of a single scattering
    bool is_leaf = false;

    /// What irradiance from the unit `direction` counts by: the cosine, or a leaf's quarter; not below 0.
    float cosine(const Vec3f& direction) const;
    /// A direction that reflected light takes: of density cosine / π (sr⁻¹); u and v in [0, 1).
    Vec3f reflected_direction(float u, float v) const;
};

/// The point that a ray hit, with the texture's albedo there (Scene::albedo_images), or the material's. The position
/// is taken from the triangle's corners, whose rounding does not grow with the ray's length.
SurfacePoint surface_point(const Scene& scene, const Hit& hit);

/// A cosine-distributed direction about the unit `normal`; u and v in [0, 1). Density cos θ / π (sr⁻¹).
/// Based on: P. Shirley, K. Chiu, "A low distortion map between disk and square", 1997 (Malley's method above it).
Vec3f square_to_cosine_hemisphere(const Vec3f& normal, float u, float v);
inline float square_to_cosine_hemisphere_pdf(float cosine) {
    return cosine > 0.0f ? cosine * static_cast<float>(1.0 / kPi) : 0.0f;
}

/// Two unit vectors that make a right-handed frame with the unit `normal`: continuous but at the south pole.
/// Based on: T. Duff et al., "Building an orthonormal basis, revisited", 2017.
struct TangentFrame {
    Vec3f u, v;
};
TangentFrame tangent_frame(const Vec3f& normal);

/// Surface of the scene, both-sided triangles counted once, m².
double surface_area(const Scene& scene);

}  // namespace skybake
