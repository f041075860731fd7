// Vessels whose reflected light is known in closed form.
#pragma once

#include <cmath>

#include "bake/scenes.h"
#include "light/light_sources.h"

namespace skybake {

inline double area_of(const Scene& scene) {
    double area = 0.0;
    for (const auto& t : scene.triangles)
        area += 0.5 * glm::length(glm::cross(Vec3d(t[1]) - Vec3d(t[0]), Vec3d(t[2]) - Vec3d(t[0])));
    return area;
}

/// The inside of a sphere about (0, 0, 5), or of its part below a polar angle: π is the whole, π/2 the lower half.
/// 128 × 64 quads of the whole: its area is 0.1 % short of the sphere's.
inline Scene sphere_inside(float radius, float albedo, float polar_end = static_cast<float>(kPi)) {
    constexpr int kAround = 128;
    const int up = static_cast<int>(std::lround(64.0 * static_cast<double>(polar_end) / kPi));
    const auto point = [&](int i, int j) {
        const float azimuth = static_cast<float>(2.0 * kPi) * static_cast<float>(i % kAround) / kAround;
        const float polar = polar_end * static_cast<float>(j) / static_cast<float>(up);
        return Vec3f(0, 0, 5) + radius * Vec3f(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                               -std::cos(polar));
    };
    QuadScene sphere;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < up; ++j) sphere.quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
    }
    Scene scene = sphere.scene();
    scene.materials[0].albedo = Rgb(albedo);
    return scene;
}

/// The centre of the quad that triangle `index` belongs to, facing the way that light can come from. A triangle's own
/// centre is off the quad's by a sixth, and its normal off the sphere's: half a per cent of light.
inline std::pair<Vec3f, Vec3f> inner_point(const Scene& scene, std::size_t index, const Vec3f& center) {
    const auto& t = scene.triangles[index / 2 * 2];
    const Vec3f position = 0.5f * (t[0] + t[2]);
    const Vec3f normal = glm::normalize(glm::cross(t[2] - t[0], scene.triangles[index / 2 * 2 + 1][2] - t[1]));
    return {position, glm::dot(normal, center - position) > 0.0f ? normal : -normal};
}

inline Daylight night() {
    Daylight night{"night", NoSky{}, {}};
    night.sun.shape = SunShape::none;
    return night;
}

inline Daylight uniform_sky(float luminance_cd_m2) {
    Daylight day = night();
    day.sky = UniformSky{luminance_cd_m2};
    return day;
}

inline Daylight sun_only(const Vec3f& direction, float normal_lx) {
    Daylight day = night();
    day.sun = {glm::normalize(direction), Rgb(normal_lx), 700.0f, 0.00465f, SunShape::point};
    return day;
}

inline Lamp point_lamp(const Vec3f& position, float candela) {
    return {"lamp", Lamp::Type::point, position, Rgb(candela)};
}

}  // namespace skybake
