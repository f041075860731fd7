// Makes one city object face by face, on a grid of whole millimetres so that file and memory agree.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "city/city_model.h"

namespace skybake::town {

/// The town's middle (its main square) in EPSG:31256: 47.070° N, 15.440° E, Graz. Whole metres, so that millimetres
/// stay whole.
inline const Vec3d kTownOrigin{-67770.0, 214930.0, 0.0};

/// Texture coordinates as an affine map of the place: (dot(p - origin, u) , dot(p - origin, v)) + offset; u and v in
/// 1/m.
struct TextureFrame {
    Vec3d origin{0.0};
    Vec3d u{0.0};
    Vec3d v{0.0};
    Vec2d offset{0.0};
};

struct Finish {
    SurfaceType type = SurfaceType::unknown;
    TextureId texture;
    TextureFrame frame;
};

class ObjectBuilder {
  public:
    ObjectBuilder(std::string id, ObjectType type, std::string type_name);

    /// A planar polygon in town coordinates (metres from kTownOrigin, heights absolute), counter-clockwise seen from
    /// outside; its holes clockwise.
    void add(std::span<const Vec3d> outer, std::span<const std::vector<Vec3d>> holes, const Finish& finish);
    void add(std::initializer_list<Vec3d> outer, const Finish& finish);
    /// Ends a shell: all faces since the last one.
    void close_shell(Shell::Kind kind);
    CityObject take();

    CityObject object;

  private:
    void add_ring(std::span<const Vec3d> ring, const TextureFrame& frame);
    std::uint32_t vertex(const Vec3d& p);

    struct Key {
        std::int64_t x, y, z;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& k) const;
    };
    std::unordered_map<Key, std::uint32_t, KeyHash> vertex_of_;
    std::uint32_t shell_begin_ = 0;
};

/// Level ground cover: u east, v north, one image every `period_m` metres.
TextureFrame ground_frame(double period_m);

}  // namespace skybake::town
