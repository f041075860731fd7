// Cameras against angles and lengths known from their definition.
#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skybake {
namespace {

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

const Vec2i kSize(200, 100);

TEST(Camera, PerspectiveLooksAtItsTargetAndOpensByItsAngle) {
    const float fov = static_cast<float>(radians_from_degrees(60.0));
    const Camera camera = perspective_camera({1, 2, 3}, {1, 12, 3}, fov, kSize);
    const CameraRay middle = camera_ray(camera, {100, 50}, kSize);
    expect_near(middle.origin, {1, 2, 3});
    expect_near(middle.direction, {0, 1, 0});
    expect_near(camera_ray(camera, {100, 0}, kSize).direction, {0, std::sqrt(0.75f), 0.5f});  // 30° up
    const Vec3f right = camera_ray(camera, {200, 50}, kSize).direction;  // twice the height's tangent, to the east
    EXPECT_NEAR(right.x / right.y, 2.0f * std::tan(0.5f * fov), 1e-5f);
}

TEST(Camera, TheHorizonIsLevelWhereverItLooks) {
    const Camera camera = perspective_camera({0, 0, 50}, {30, -20, 3}, 1.0f, kSize);
    EXPECT_NEAR(camera.right.z, 0.0f, 1e-6f);
    EXPECT_GT(camera.up.z, 0.0f);
    EXPECT_NEAR(glm::dot(camera.right, camera.forward), 0.0f, 1e-6f);
}

TEST(Camera, APlanHasNorthOnTop) {
    const Camera camera = orthographic_camera({10, 20, 100}, {10, 20, 0}, 400.0f, 70.0f, kSize);
    for (const auto& [place, foot] : {std::pair{Vec2f(100, 50), Vec3f(10, 20, 70)},
                                      {Vec2f(100, 0), Vec3f(10, 120, 70)},
                                      {Vec2f(200, 100), Vec3f(210, -80, 70)}}) {
        const CameraRay ray = camera_ray(camera, place, kSize);
        expect_near(ray.direction, {0, 0, -1});
        expect_near(ray.origin, foot, 1e-3f);
    }
}

TEST(Camera, ThePanoramaRunsClockwiseFromBehind) {
    const Camera camera = panorama_camera({0, 0, 2}, {0, 5, 9});  // north, whatever its height
    expect_near(camera_ray(camera, {100, 50}, kSize).direction, {0, 1, 0});
    expect_near(camera_ray(camera, {150, 50}, kSize).direction, {1, 0, 0});
    expect_near(camera_ray(camera, {0, 50}, kSize).direction, {0, -1, 0});
    expect_near(camera_ray(camera, {33, 0}, kSize).direction, {0, 0, 1});
    expect_near(camera_ray(camera, {100, 75}, kSize).direction, {0, std::sqrt(0.5f), -std::sqrt(0.5f)});
}

}  // namespace
}  // namespace skybake
