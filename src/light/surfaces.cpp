#include "light/surfaces.h"

#include <algorithm>
#include <cmath>

namespace skybake {

SurfacePoint surface_point(const Scene& scene, const Hit& hit) {
    const std::array<Vec3f, 3>& corner = scene.triangles[hit.triangle];
    const float w = 1.0f - hit.u - hit.v;
    SurfacePoint point;
    point.position = w * corner[0] + hit.u * corner[1] + hit.v * corner[2];
    // In double: a sliver's cross product would lose its direction.
    const Vec3d cross = glm::cross(Vec3d(corner[1]) - Vec3d(corner[0]), Vec3d(corner[2]) - Vec3d(corner[0]));
    const Vec3f normal(glm::normalize(cross));
    point.normal = hit.is_back_face ? -normal : normal;

    const SceneMaterial& material =
        scene.materials[scene.faces[scene.triangle_face[hit.triangle].index()].material.index()];
    point.albedo = material.albedo;
    if (material.texture && material.texture->index() < scene.albedo_images.size()) {
        const std::array<Vec2f, 3>& uv = scene.triangle_uvs[hit.triangle];
        point.albedo *=
            albedo_at(scene.albedo_images[material.texture->index()], w * uv[0] + hit.u * uv[1] + hit.v * uv[2],
                      material.wrap, scene.textures[material.texture->index()].border_color);
    }
    point.albedo = glm::clamp(point.albedo, 0.0f, 1.0f);
    return point;
}

float SurfacePoint::cosine(const Vec3f& direction) const {
    return is_leaf ? 0.25f : std::max(0.0f, glm::dot(normal, direction));
}

Vec3f SurfacePoint::reflected_direction(float u, float v) const {
    if (!is_leaf) return square_to_cosine_hemisphere(normal, u, v);
    const float z = 1.0f - 2.0f * u, r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const float azimuth = static_cast<float>(2.0 * kPi) * v;
    return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

Vec3f square_to_cosine_hemisphere(const Vec3f& normal, float u, float v) {
    const float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
    constexpr float kQuarter = static_cast<float>(kPi / 4.0);
    float x = 0.0f, y = 0.0f;
    if (std::abs(a) > std::abs(b)) {
        x = a * std::cos(kQuarter * (b / a));
        y = a * std::sin(kQuarter * (b / a));
    } else if (b != 0.0f) {
        x = b * std::sin(kQuarter * (a / b));
        y = b * std::cos(kQuarter * (a / b));
    }
    const float z = std::sqrt(std::max(0.0f, 1.0f - x * x - y * y));
    const TangentFrame frame = tangent_frame(normal);
    return glm::normalize(x * frame.u + y * frame.v + z * normal);
}

TangentFrame tangent_frame(const Vec3f& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

double surface_area(const Scene& scene) {
    double area = 0.0;
    for (const auto& t : scene.triangles)
        area += 0.5 * static_cast<double>(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])));
    return area;
}

}  // namespace skybake
