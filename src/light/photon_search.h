// The nearest photons of a surface, for one point after another.
#pragma once

#include <span>
#include <vector>

#include "light/photon_map.h"

namespace skybake {

/// How far two points of a surface are apart; u and v of the offset along the surface.
enum class SurfaceMetric {
    circle,  // Euclid's
    octagon  // the largest of |u|, |v|, |u + v|/√2, |u − v|/√2: its balls are regular octagons, their inner radius the
             // distance
};

/// The axes that octagons and feelers are laid along: u level, v up the wall; on level ground u east, v north.
struct SurfaceAxes {
    Vec3f u, v;
};
SurfaceAxes surface_axes(const Vec3f& normal);

/// How far a surface is looked at along each of eight directions, k · 45° from u towards v: metres, infinite where
/// nothing limits.
using SurfaceLimits = std::array<float, 8>;
SurfaceLimits no_limits();
/// Unit direction k in the plane.
Vec2f surface_direction(std::size_t k);

/// A photon found: where it lies in the plane of the point that asked.
struct NearPhoton {
    float distance = 0.0f;  // in the metric asked for, metres
    Vec2f offset{0.0f};     // along surface_axes, metres
    std::uint32_t photon = 0;
};

/// What a point asks for. `normal` is unit.
struct PhotonQuery {
    Vec3f position, normal;
    SurfaceMetric metric = SurfaceMetric::octagon;
    std::size_t count = 100;            // at least 1
    float max_distance = 0.0f;          // metres
    SurfaceLimits limit = no_limits();  // no photon counts that lies farther along direction k
};

/// Takes a patch of the surface about the point from the map, as arrays; it serves the points that follow as long as
/// they lie in it: points in the order of their places cost less than points at random. The answers are the same in
/// any order. One object a thread.
class PhotonSearch {
  public:
    explicit PhotonSearch(const PhotonMap& map) : map_(map) {}

    const PhotonMap& map() const { return map_; }

    /// The nearest photons that arrived on the same side of the same surface as the point: their normal differs from
    /// its own by less than 25°, and they lie off its plane by less than 2 cm and a tenth of their distance along it.
    /// The farthest stands first, the others in the map's order. Valid until the next call.
    std::span<const NearPhoton> nearest(const PhotonQuery& query);

  private:
    bool covers(const PhotonQuery& query, float radius) const;
    void take_patch(const PhotonQuery& query, float radius, bool is_shared);
    void find_within(const PhotonQuery& query, float radius);
    void keep_nearest(std::size_t count);

    const PhotonMap& map_;

    // The patch: its photons, and which points they answer for.
    Vec3f center_{0.0f}, normal_{0.0f};
    SurfaceAxes axes_;
    float reach_ = 0.0f;        // along the axes, metres; 0: there is none
    float most_radius_ = 0.0f;  // that photons are looked for within, metres
    std::vector<float> x_, y_, z_, normal_x_, normal_y_, normal_z_;
    std::vector<std::uint32_t> photon_;

    Vec3f last_position_{0.0f};
    float last_radius_ = 0.0f;  // 0: no point has asked yet
    std::vector<NearPhoton> found_;
    std::vector<float> distance_;        // scratch
    std::vector<std::uint32_t> in_box_;  // scratch
};

}  // namespace skybake
