// Which texels of a tile see a direction: the shadows that everything else throws on the tile along it, found without
// rays (docs/decisions/0007-projected-shadows.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/projection_tile.h"
#include "base/vec.h"
#include "trace/occluder_tree.h"

namespace skybake {

struct TilePoints;

/// False for directions below the plane of a chart, and so low above it (a cosine below 0.01) that the projection would
/// lose its digits.
bool can_project(const Vec3f& normal, const Vec3f& direction);

/// Shadows on one tile. A texel is blocked when its point lies in the projection of a quad and below it: the same
/// question that a ray asks, for all texels of the tile at once. A quad's projection is widened by the rounding of its
/// corners (2⁻²¹ of their coordinates), so that light does not leak between neighbours.
class ShadowProjector {
  public:
    /// So many neighbouring directions share a look into the tree.
    static constexpr std::size_t kBundle = 16;

    ShadowProjector(const OccluderTree& tree, const TilePoints& points) : tree_(tree), tile_(points) {}

    /// The directions that follow are those of the bundle; all of them can be projected.
    void set_bundle(std::span<const Vec3f> directions, std::span<const std::uint32_t> bundle);

    /// For a direction of the bundle: bit c of visible[row] is set when the covered texel c sees it. False, and nothing
    /// done, when so many quads may shade the tile that rays are cheaper, as under a scanned mesh.
    bool find_visible(const Vec3f& direction, std::span<std::uint64_t> visible);

  private:
    Vec2f slopes(const Vec3f& direction) const;
    enum class Answer { open, dark, crowded };
    Answer cast_shadows(const Vec2f& slope);
    void remember_blockers();

    const OccluderTree& tree_;
    ProjectionTile tile_;
    Box2f slopes_;                 // of the bundle's directions
    bool has_candidates_ = false;  // of the bundle; they are looked for when a direction needs them
};

}  // namespace skybake
