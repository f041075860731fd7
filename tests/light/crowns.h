// Crowns for scenes whose light is known.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/finding.h"
#include "scene/find_crowns.h"
#include "scene/scene.h"

namespace skybake {

/// Adds a plant of the given triangles, whose material has the albedo.
inline void add_plant(Scene& scene, const std::vector<std::array<Vec3f, 3>>& triangles, float albedo,
                      ObjectType type = ObjectType::solitary_vegetation) {
    const std::string id = "plant-" + std::to_string(scene.objects.size());
    scene.objects.push_back({id, id, type});
    scene.materials.push_back({id, Rgb(albedo), std::nullopt, TextureWrap::repeat});
    scene.faces.push_back({static_cast<std::uint32_t>(scene.objects.size() - 1), SurfaceType::vegetation,
                           MaterialId(scene.materials.size() - 1), static_cast<std::uint32_t>(scene.triangles.size()),
                           static_cast<std::uint32_t>(triangles.size()), 0});
    for (const std::array<Vec3f, 3>& t : triangles) {
        scene.triangles.push_back(t);
        scene.triangle_uvs.push_back({Vec2f(0), Vec2f(0), Vec2f(0)});
        scene.triangle_face.push_back(FaceId(scene.faces.size() - 1));
        for (const Vec3f& p : t) scene.bounds.extend(p);
    }
}

/// Lets the plants dim by `transmissivity` along their mean chord.
inline FindingLog grow_crowns(Scene& scene, float transmissivity) {
    FindingLog findings;
    scene.crowns = find_crowns(scene, transmissivity, findings);
    return findings;
}

/// Transmissivity along the mean chord of a body of extinction k (m⁻¹).
inline float transmissivity_of(double extinction, double volume, double surface) {
    return static_cast<float>(std::exp(-extinction * 4.0 * volume / surface));
}

inline std::vector<std::array<Vec3f, 3>> quad_triangles(const Vec3f& a, const Vec3f& b, const Vec3f& c,
                                                        const Vec3f& d) {
    return {{a, b, c}, {a, c, d}};
}

inline std::vector<std::array<Vec3f, 3>> box_triangles(const Vec3f& lo, const Vec3f& hi) {
    const auto p = [&](int x, int y, int z) { return Vec3f(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
    std::vector<std::array<Vec3f, 3>> all;
    const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
        for (const auto& t : quad_triangles(a, b, c, d)) all.push_back(t);
    };
    add(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
    add(p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
    add(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
    add(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
    add(p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1));
    add(p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1));
    return all;
}

/// 64 × 32 quads: its volume is 0.5 % short of the sphere's.
inline std::vector<std::array<Vec3f, 3>> sphere_triangles(const Vec3f& center, float radius) {
    constexpr int kAround = 64, kUp = 32;
    const auto point = [&](int i, int j) {
        const float azimuth = static_cast<float>(2.0 * kPi) * static_cast<float>(i % kAround) / kAround;
        const float polar = static_cast<float>(kPi) * static_cast<float>(j) / kUp;
        // The poles exactly, so that the surface is closed to the last bit.
        if (j == 0 || j == kUp) return center + Vec3f(0, 0, j == 0 ? -radius : radius);
        return center + radius * Vec3f(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                       -std::cos(polar));
    };
    std::vector<std::array<Vec3f, 3>> all;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kUp; ++j) {
            if (j > 0) all.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1)});
            if (j == 0) {
                all.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
            } else if (j + 1 < kUp) {
                all.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
            }
        }
    }
    return all;
}

}  // namespace skybake
