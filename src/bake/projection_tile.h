// A tile's points as shadows are projected onto them: facets of regular texels, and loose points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "trace/occluder_tree.h"

namespace skybake {

struct TilePoints;

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
        Box2f box;  // of the points' u and v
        int row_begin = 0, row_end = 0;
        Rows points{};
        Rows open{};           // those that see the direction at hand
        bool is_dark = false;  // none is left
    };

    /// Up to 16 other points, neighbours.
    struct alignas(64) LoosePoints {
        float u[kBlock], v[kBlock], h[kBlock];      // 0 behind the last one
        std::array<std::uint16_t, kBlock> texel{};  // row × 64 + column
        Box3f box;                                  // of u, v, h
        std::uint32_t points = 0;                   // bit a point
        std::uint32_t open = 0;                     // those that see the direction at hand
    };

    /// Quads in the tile's frame, in whole blocks: [3 corner + 0, 1, 2][quad] is u, v, h; NaN behind the last one.
    struct Quads {
        std::array<std::vector<float>, 12> corner;
        std::size_t count = 0;
    };

    /// At least one texel must be covered; at most kMaxSize rows and columns.
    explicit ProjectionTile(const TilePoints& points);

    float relief = 0.0f;                             // highest h of a point, metres
    Box2f box;                                       // of the points' u and v
    Vec3f origin{0.0f};                              // of the frame, local metres
    Vec3f axis_u{0.0f}, axis_v{0.0f}, axis_h{0.0f};  // u = axis_u · (p − origin), and so on
    std::vector<Facet> facets;
    std::vector<LoosePoints> loose;

    Quads candidates;  // those that may shade the tile in some direction of the bundle
    Quads blockers;    // one block of those that left the tile dark the last time: the next direction asks them first
    std::vector<std::pair<float, std::uint32_t>> hits;  // of the direction at hand: shaded area (texels²), candidate
    std::vector<std::uint32_t> stack;                   // of the walk through the tree

  private:
    void sort_points(const TilePoints& points, const std::vector<Vec3f>& uvh);
};

}  // namespace skybake
