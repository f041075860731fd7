// Which texels of a tile see a direction: the shadows that everything else throws on the tile along it, found without
// rays (docs/decisions/0007-projected-shadows.md).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "trace/occluder_tree.h"

namespace skybake {

struct TilePoints;

/// Directions in runs of neighbours, so that one look into the tree serves a run.
class DirectionBundles {
  public:
    static constexpr std::size_t kSize = 16;

    /// Halves the chosen ones of the unit vectors `directions` at their longest side until no run is longer than kSize.
    DirectionBundles(std::span<const Vec3f> directions, std::span<const std::uint32_t> chosen);

    std::size_t size() const { return begin_.size() - 1; }
    /// Indices into the directions.
    std::span<const std::uint32_t> operator[](std::size_t bundle) const {
        return std::span(order_).subspan(begin_[bundle], begin_[bundle + 1] - begin_[bundle]);
    }

  private:
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> begin_;
};

/// Slopes of the directions of a bundle: mean ± spread, texels per metre.
struct SlopeRange {
    Vec2f mean{0.0f}, spread{0.0f};
};

/// What the projection works on: a tile's points and the quads that may shade them, in the tile's own frame: u and v
/// along columns and rows, in texels, h along the chart's normal above the lowest point, in metres. A parallel
/// projection along a direction of slopes (s_u, s_v) carries (u, v, h) to (u − h s_u, v − h s_v).
struct ProjectionTile {
    static constexpr int kMaxSize = 63;
    static constexpr int kBlock = OccluderTree::kWidth;

    using Rows = std::array<std::uint64_t, kMaxSize + 1 + kBlock>;  // bit c: column c

    /// Points of one plane h = slope · (u, v) + offset that lie at their texels' centres: u = column + 0.5, v = row +
    /// 0.5. A planar chart has one, a bent one one a triangle.
    struct Facet {
        Vec2f slope{0.0f};  // metres per texel
        float offset = 0.0f;
        Vec2f lo{0.0f}, hi{0.0f};  // of the points' u and v
        int row_begin = 0, row_end = 0;
        Rows points{};
        Rows open{};           // those that see the direction at hand
        bool is_dark = false;  // none is left
    };

    int width = 0, height = 0;
    float relief = 0.0f;                             // highest h of a point, metres
    Vec2f lo{0.0f}, hi{0.0f};                        // of the points' u and v
    Vec3f origin{0.0f};                              // of the frame, local metres
    Vec3f axis_u{0.0f}, axis_v{0.0f}, axis_h{0.0f};  // u = axis_u · (p − origin), and so on

    std::vector<Facet> facets;
    // The other points, row by row, in blocks of 16.
    std::vector<float> u, v, h;                   // NaN where a block has no point
    std::vector<std::uint16_t> texel;             // [point]: row × 64 + column
    std::vector<std::uint32_t> in_use;            // [block]: bit a point
    std::vector<std::uint32_t> open_block;        // those that see the direction at hand
    std::vector<std::uint32_t> first_row;         // [row]: first block with a point of this row or a later one
    std::vector<std::uint32_t> end_row;           // [row]: first block with no point of this row or an earlier one
    std::vector<float> projected_u, projected_v;  // along the direction at hand

    /// Quads in the tile's frame, in whole blocks: [3 corner + 0, 1, 2][quad] is u, v, h; NaN behind the last one.
    struct Quads {
        std::array<std::vector<float>, 12> corner;
        std::size_t count = 0;
    };
    Quads candidates;  // those that may shade the tile in some direction of the bundle
    Quads blockers;    // one block of those that left the tile dark the last time: the next direction asks them first
    std::vector<std::pair<float, std::uint32_t>> hits;  // of the direction at hand: shaded area (texels²), candidate

    std::vector<std::uint32_t> stack;  // of the walk through the tree
};

/// False for directions below the plane of a chart, and so low above it (a cosine below 0.01) that the projection would
/// lose its digits.
bool can_project(const Vec3f& normal, const Vec3f& direction);

/// Shadows on one tile. A texel is blocked when its point lies in the projection of a quad and below it: the same
/// question that a ray asks, for all texels of the tile at once. A quad's projection is widened by the rounding of its
/// corners (2⁻²¹ of their coordinates), so that light does not leak between neighbours.
class ShadowProjector {
  public:
    ShadowProjector(const OccluderTree& tree, const TilePoints& points);

    /// The directions that follow are those of the bundle; all of them can be projected.
    void set_bundle(std::span<const Vec3f> directions, std::span<const std::uint32_t> bundle);

    /// For a direction of the bundle: bit c of visible[row] is set when the covered texel c sees it. False, and nothing
    /// done, when so many quads may shade the tile that rays are cheaper, as under a scanned mesh.
    bool find_visible(const Vec3f& direction, std::span<std::uint64_t> visible);

  private:
    Vec2f slopes(const Vec3f& direction) const;
    enum class Answer { open, dark, crowded };
    Answer cast_shadows(const Vec2f& slope);
    void find_facets(const TilePoints& points, std::span<const Vec3f> uvh);
    void add_loose_point(int row, int column, const Vec3f& uvh);

    const OccluderTree& tree_;
    ProjectionTile tile_;
    SlopeRange range_;
    bool has_candidates_ = false;  // of the bundle; they are looked for when a direction needs them
};

}  // namespace skybake
