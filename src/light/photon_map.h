// Photons in space, and the nearest of them about a point of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "light/photon.h"

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

/// /// How far a surface is looked at along each of eight directions, k · 45° from u towards v: metres, infinite where
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

/// A kd-tree without pointers: each range of the array has its cut at the middle (J. L. Bentley, "Multidimensional
/// binary search trees used for associative searching", 1975), along the longest side of the range's box. Read-only
/// after construction.
class PhotonMap {
  public:
    /// Sorts the photons into the tree, in parallel; the same order for any number of threads.
    explicit PhotonMap(std::vector<Photon> photons);

    std::span<const Photon> photons() const { return photons_; }

    /// The `count` nearest photons within `max_distance` that arrived on the same side of the same surface as the
    /// point: their normal differs from `normal` by less than 25°, and they lie off its plane by less than 2 cm and a
    /// tenth of /// their distance along it. None lies farther than `limit[k]` along direction k, at k · 45° from u.
    /// Replaces `found`, the farthest first.
    void find_nearest(const Vec3f& position, const Vec3f& normal, SurfaceMetric metric, std::size_t count,
                      float max_distance, const SurfaceLimits& limit, std::vector<NearPhoton>& found) const;

  private:
    std::vector<Photon> photons_;
};

}  // namespace skybake
