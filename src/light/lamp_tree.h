// Which of many lamps matter to a patch of a surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "light/lamp.h"

namespace skybake {

/// Points that receive light: where they are, and, when they lie in one plane and face one way, which way.
struct ReceiverPatch {
    Box3f box;
    bool is_planar = false;
    Vec3f normal{0.0f, 0.0f, 1.0f};
    float plane_offset = 0.0f;  // the least of dot(normal, point) over the points
};

/// A binary tree over the lamps' places. Read-only after construction. `lamps` must outlive it.
class LampTree {
  public:
    explicit LampTree(std::span<const Lamp> lamps);

    std::span<const Lamp> lamps() const { return lamps_; }

    /// Indices, ascending, of lamps such that all others together give no point of the patch more than `cutoff_lx`,
    /// were nothing in their way. The bounds of lamps and of whole branches (I h / d³ on a plane that a lamp stands h
    /// above, I / d² otherwise, d the least distance, I the most intensity towards the patch) are opened from the
    /// largest down until what is left adds up to the cutoff; so far lamps cost next to nothing. With a cutoff of 0 all
    /// that can reach the patch.
    /// Based on: B. Walter et al., "Lightcuts: a scalable approach to illumination", 2005 (the tree and its bounds).
    std::vector<std::uint32_t> relevant(const ReceiverPatch& patch, double cutoff_lx) const;

  private:
    struct Node {
        Box3f box;
        double intensity_cd = 0.0;  // sum of the peaks of the largest channel or luminance
        std::uint32_t lamp = 0;     // of a leaf
        std::uint32_t right = 0;    // the left child follows its parent; 0: a leaf
    };
    void build(std::span<std::uint32_t> order);
    double bound(const Node& node, const ReceiverPatch& patch) const;

    std::span<const Lamp> lamps_;
    std::vector<Node> nodes_;
};

}  // namespace skybake
