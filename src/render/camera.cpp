#include "render/camera.h"

#include <cmath>

namespace skybake {
namespace {

/// A frame with level horizon that looks along `gaze`.
Camera levelled(Projection projection, const Vec3f& position, const Vec3f& gaze) {
    Camera camera;
    camera.projection = projection;
    camera.position = position;
    const float length = glm::length(gaze);
    camera.forward = length > 0.0f ? gaze / length : Vec3f(0.0f, 1.0f, 0.0f);
    const Vec3f side = glm::cross(camera.forward, Vec3f(0.0f, 0.0f, 1.0f));
    // Straight up or down nothing is level; east to the right puts north on top of a plan.
    camera.right = glm::length(side) > 1e-6f ? glm::normalize(side) : Vec3f(1.0f, 0.0f, 0.0f);
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}

float ratio(const Vec2i& size) {
    return static_cast<float>(size.x) / static_cast<float>(size.y);
}

}  // namespace

Camera perspective_camera(const Vec3f& position, const Vec3f& target, float fov_rad, const Vec2i& size) {
    Camera camera = levelled(Projection::perspective, position, target - position);
    const float half_height = std::tan(0.5f * fov_rad);
    camera.half_extent = {half_height * ratio(size), half_height};
    return camera;
}

Camera orthographic_camera(const Vec3f& position, const Vec3f& target, float width_m, float reach_m,
                           const Vec2i& size) {
    Camera camera = levelled(Projection::orthographic, position, target - position);
    camera.position = target - reach_m * camera.forward;
    camera.half_extent = Vec2f(0.5f * width_m, 0.5f * width_m / ratio(size));
    return camera;
}

Camera panorama_camera(const Vec3f& position, const Vec3f& target) {
    const Vec3f gaze = target - position;
    return levelled(Projection::panorama, position, Vec3f(gaze.x, gaze.y, 0.0f));
}

CameraRay camera_ray(const Camera& camera, const Vec2f& place, const Vec2i& size) {
    const float x = 2.0f * place.x / static_cast<float>(size.x) - 1.0f;
    const float y = 1.0f - 2.0f * place.y / static_cast<float>(size.y);
    const Vec3f across = x * camera.half_extent.x * camera.right + y * camera.half_extent.y * camera.up;
    switch (camera.projection) {
        case Projection::perspective:
            return {camera.position, glm::normalize(camera.forward + across)};
        case Projection::orthographic:
            return {camera.position + across, camera.forward};
        case Projection::panorama:
            break;
    }
    const float azimuth = x * static_cast<float>(kPi);
    const float elevation = 0.5f * y * static_cast<float>(kPi);
    const Vec3f level = std::cos(azimuth) * camera.forward + std::sin(azimuth) * camera.right;
    return {camera.position, std::cos(elevation) * level + Vec3f(0.0f, 0.0f, std::sin(elevation))};
}

}  // namespace skybake
