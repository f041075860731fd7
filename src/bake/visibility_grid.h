// Visibility of one direction over a tile, solved on a quadtree of cells.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/sky_tile.h"

namespace skybake {

/// How coarsely a direction is looked at.
struct Lattice {
    int first_cell = 16;  // texels between the nodes that are always traced: 16, 8 or 4
    int last_cell = 1;    // cells of this size are interpolated between their corners instead of being halved again
};

/// Where a visibility comes from: rays, or the stored answer of a pilot direction.
class VisibilitySource {
  public:
    virtual ~VisibilitySource() = default;
    /// Sets bit `column` of visible[row] for each listed texel (row × width + column) that sees the sky.
    virtual void look(std::span<const std::uint16_t> texels, std::span<std::uint64_t> visible) = 0;
};

/// The cells of a tile, made once, and the solution for one direction after another.
class VisibilityGrid {
  public:
    explicit VisibilityGrid(const TilePoints& points);

    /// Sets, beside the tile's features, the texels that every direction must trace: all cells that hold one are halved down to it.
    void force(std::span<const std::uint64_t> texels);

    /// Finds the visibility of all covered texels. `visible` gets a bit a texel; texels between disagreeing nodes of a last cell get
    /// their share in `fractions` instead (their bit is clear). Returns how many texels were looked at.
    std::size_t solve(const Lattice& lattice, VisibilitySource& source, std::span<std::uint64_t> visible);

    struct Fraction {
        std::uint16_t texel;
        float value;
    };
    std::span<const Fraction> fractions() const { return fractions_; }

  private:
    struct Cell {
        std::uint8_t x0, y0, x1, y1;        // inclusive: neighbours share their border
        std::uint8_t child_count = 0;
        bool is_forced = false;
        std::array<std::uint16_t, 4> test;  // the corners, or the covered texels nearest to them
        std::uint32_t first_child = 0;
        std::uint64_t columns() const { return (~0ull >> (63 - (x1 - x0))) << x0; }
        int extent() const { return std::max(x1 - x0, y1 - y0); }
    };

    bool add_cell(int x0, int y0, int x1, int y1);
    void split(std::size_t cell);
    /// True when all texels of the cell that were looked at have the visibility of its first corner.
    bool agrees(const Cell& cell, std::span<const std::uint64_t> visible) const;
    void want(const Cell& cell);
    void interpolate(const Cell& cell, std::span<std::uint64_t> visible);

    const TilePoints& points_;
    std::vector<Cell> cells_;
    std::array<std::vector<std::uint32_t>, 3> roots_;  // cells of at most 16, 8 and 4 texels
    // Working state of solve, kept to save allocations.
    std::vector<std::uint64_t> known_;
    std::vector<std::uint16_t> wanted_;
    std::vector<std::uint32_t> pending_, next_, settled_, interpolated_;
    std::vector<Fraction> fractions_;
};

}  // namespace skybake
