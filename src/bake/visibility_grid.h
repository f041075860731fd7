// Visibility of one direction over a tile, from as few rays as its shadow edges need.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/sky_tile.h"

namespace skybake {

/// How coarsely a direction is looked at.
struct Lattice {
    int first_cell = 16;  // texels between the nodes that are always traced: 16, 8 or 4
    int last_cell =
        1;  // mixed cells of this size are interpolated between their corners instead of being halved again: 1, 2 or 4
};

/// Where a visibility comes from: rays, or the stored answer of a pilot direction.
class VisibilitySource {
  public:
    virtual ~VisibilitySource() = default;
    /// For each set bit of wanted[row], sets that bit of visible[row] when the texel sees the sky and clears it
    /// otherwise. Returns how many bits there were.
    virtual std::size_t look(std::span<const std::uint64_t> wanted, std::span<std::uint64_t> visible) = 0;
};

/// The lattice of a tile, made once, and the solution for one direction after another. All texels of a row are one
/// machine word, so that a level of the hierarchy costs a few operations a row, whatever lies in it.
class VisibilityGrid {
  public:
    explicit VisibilityGrid(const TilePoints& points);

    /// Sets, beside the tile's features, the texels that every direction must trace: all cells that hold one are halved
    /// down to it.
    void force(std::span<const std::uint64_t> texels);

    /// Finds the visibility of all covered texels, a bit each. A cell is mixed when its corners differ; its unknown
    /// corners, the middles of its sides and its centre are looked at, which may make its neighbours mixed, until
    /// nothing changes; then cells are halved. What lies in cells that are not mixed is taken to be as their corners. A
    /// texel of a mixed last cell is visible when the corners' visibility, interpolated, is above `threshold`: over
    /// directions with thresholds spread evenly over [0, 1] it gets the interpolated share. Returns how many texels
    /// were looked at.
    std::size_t solve(const Lattice& lattice, float threshold, VisibilitySource& source,
                      std::span<std::uint64_t> visible);

    /// [row]: the texels that the last solution interpolated.
    std::span<const std::uint64_t> interpolated() const { return interpolated_; }

  private:
    static constexpr int kLevels = 5;  // cells of 16, 8, 4, 2 and 1 texels
    using Rows = std::array<std::uint64_t, TilePoints::kMaxSize>;

    static int level_of(int cell) { return cell == 16 ? 0 : cell == 8 ? 1 : cell == 4 ? 2 : cell == 2 ? 3 : 4; }
    std::size_t look(VisibilitySource& source, std::span<std::uint64_t> visible);
    void find_mixed(int cell, std::span<const std::uint64_t> visible, Rows& mixed) const;
    void fill_next_level(int cell, std::span<std::uint64_t> visible) const;
    void interpolate(int cell, float threshold, const Rows& mixed, std::span<std::uint64_t> visible);

    const TilePoints& points_;
    // [level][row]: bit set at a cell's first column and row. Cells without covered texels are never looked into.
    std::array<Rows, kLevels> in_use_{}, forced_{};
    std::array<std::uint64_t, kLevels> cell_columns_{};  // first columns of cells
    Rows known_{}, wanted_{}, interpolated_{};
};

}  // namespace skybake
