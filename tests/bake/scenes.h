// Small scenes whose light is known.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace skybake {

/// A scene of quads, each an object of its own; corners counter-clockwise seen from outside.
class QuadScene {
  public:
    QuadScene& quad(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d,
                    ObjectType type = ObjectType::building) {
        const std::uint32_t object = static_cast<std::uint32_t>(scene_.objects.size());
        const std::string id = "quad-" + std::to_string(object);
        scene_.objects.push_back({id, id, type});
        scene_.faces.push_back({object, SurfaceType::wall, MaterialId(std::size_t{0}),
                                static_cast<std::uint32_t>(scene_.triangles.size()), 2, 0});
        for (const std::array<Vec3f, 3>& t : {std::array{a, b, c}, std::array{a, c, d}}) {
            scene_.triangles.push_back(t);
            scene_.triangle_uvs.push_back({Vec2f(0), Vec2f(0), Vec2f(0)});
            scene_.triangle_face.push_back(FaceId(scene_.faces.size() - 1));
            for (const Vec3f& p : t) scene_.bounds.extend(p);
        }
        return *this;
    }
    /// A horizontal square about the origin, facing up.
    QuadScene& ground(float half_size, float z = 0.0f, ObjectType type = ObjectType::terrain) {
        return quad({-half_size, -half_size, z}, {half_size, -half_size, z}, {half_size, half_size, z},
                    {-half_size, half_size, z}, type);
    }
    /// A closed box, facing outwards.
    QuadScene& box(const Vec3f& lo, const Vec3f& hi) {
        const auto p = [&](int x, int y, int z) { return Vec3f(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
        quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
        quad(p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
        quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
        quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
        quad(p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1));
        quad(p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1));
        return *this;
    }
    Scene scene() {
        if (scene_.materials.empty())
            scene_.materials.push_back({"white", Rgb(0.5f), std::nullopt, TextureWrap::repeat});
        return scene_;
    }

  private:
    Scene scene_;
};

}  // namespace skybake
