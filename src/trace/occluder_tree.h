// The city's surfaces in a wide hierarchy of boxes, laid out for asking which of them can stand between a patch of
// surface and a part of the sky (bake/shadow_projection.h).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace skybake {

/// Read-only after construction: any number of threads may read it.
class OccluderTree {
  public:
    static constexpr int kWidth = 16;
    static constexpr std::uint32_t kLeaf = 1u << 31;  // set in a child that is a leaf

    /// [axis][child]: the boxes of up to 16 children, local metres. A lane without child holds NaN: no comparison with
    /// it is true.
    struct alignas(64) Node {
        float center[3][kWidth];
        float extent[3][kWidth];  // half the box's size
        std::uint32_t child[kWidth];
    };
    /// [corner][axis][lane]: up to 16 convex quads, local metres: a triangle, its last corner given twice, or two of
    /// one face that share an edge. Lanes without quad hold NaN.
    struct alignas(64) Leaf {
        float corner[4][3][kWidth];
    };

    /// Without the crowns.
    explicit OccluderTree(const Scene& scene);

    const std::vector<Node>& nodes() const { return nodes_; }
    const std::vector<Leaf>& leaves() const { return leaves_; }
    /// The root: the index of a node, or of a leaf with kLeaf set; none for an empty scene.
    bool is_empty() const { return leaves_.empty(); }
    std::uint32_t root() const { return root_; }

  private:
    class Builder;

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
    std::uint32_t root_ = 0;
};

}  // namespace skybake
