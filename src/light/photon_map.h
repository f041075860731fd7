// Photons in space, sorted so that those of a box are found fast.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "light/photon.h"

namespace skybake {

/// A box along three orthogonal unit axes.
struct OrientedBox {
    Vec3f center{0.0f};
    std::array<Vec3f, 3> axis{};
    Vec3f half{0.0f};  // metres along each axis

    Box3f bounds() const;
    bool contains(const Vec3f& p) const;
    /// True only when the other box lies wholly outside one pair of sides.
    bool misses(const Box3f& box) const;
};

/// A kd-tree without pointers: each range of the array has its cut at the middle (J. L. Bentley, "Multidimensional
/// binary search trees used for associative searching", 1975), along the longest side of the range's box. Read-only
/// after construction.
class PhotonMap {
  public:
    /// Sorts the photons into the tree, in parallel; the same order for any number of threads.
    explicit PhotonMap(std::vector<Photon> photons);

    std::span<const Photon> photons() const { return photons_; }

    /// Appends the indices of the photons in the box, ascending.
    void find_in(const OrientedBox& box, std::vector<std::uint32_t>& found) const;

  private:
    std::vector<Photon> photons_;
};

}  // namespace skybake
