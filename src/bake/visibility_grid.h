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
    // Mixed cells of this size are interpolated between their corners instead of being halved again: 1, 2, …
    // first_cell.
    int last_cell = 1;
};

/// Where a visibility comes from: rays, or the stored answer of a pilot direction. Arrays hold one word a row.
class VisibilitySource {
  public:
    virtual ~VisibilitySource() = default;
    /// For each set bit of wanted[row], sets that bit of visible[row] when the texel sees the sky and clears it
    /// otherwise. Returns how many bits there were.
    virtual std::size_t look(std::span<const std::uint64_t> wanted, std::span<std::uint64_t> visible) = 0;
    /// The same for the texels that every direction looks at (VisibilityGrid::first_look).
    virtual std::size_t look_first(std::span<const std::uint64_t> wanted, std::span<std::uint64_t> visible) {
        return look(wanted, visible);
    }
};

/// The lattice of a tile, made once, and the solution for one direction after another. All texels of a row are one
/// machine word, so that a level of the hierarchy costs a few operations a row, whatever lies in it.
class VisibilityGrid {
  public:
    explicit VisibilityGrid(const TilePoints& points);

    /// Chooses the lattice. `seen`: texels that some pilot sees; `anchored`: texels that every direction looks at,
    /// beside the first nodes.
    void set(const Lattice& lattice, std::span<const std::uint64_t> features, std::span<const std::uint64_t> seen,
             std::span<const std::uint64_t> anchored);

    /// What every direction looks at: first nodes, anchored texels, and the features of cells with a blind corner, that
    /// is one that no pilot sees, such as ground under a house: it says nothing of the alley beside it.
    std::span<const std::uint64_t> first_look() const {
        return std::span(first_).first(static_cast<std::size_t>(points_.height));
    }

    /// Finds the visibility of all covered texels, a bit each. After the first look come the features in cells with a
    /// visible corner: what is small and near hides light there. Then level by level: a cell is mixed when two of its
    /// known texels differ; the middles of its sides and its centre are looked at, and its quarters, and those of its
    /// neighbours that a middle contradicts, are the next level's. What lies in cells that are not mixed is taken to be
    /// as their corners. A mixed last cell is halved down to the texel when a feature or an anchored texel lies in it
    /// or beside it. Else its texels are visible when the corners' visibility, interpolated, is above `threshold`: over
    /// directions with thresholds spread evenly over [0, 1] they get the interpolated share. Returns how many texels
    /// were looked at.
    std::size_t solve(float threshold, VisibilitySource& source, std::span<std::uint64_t> visible);

    /// [row]: the texels that the last solution interpolated.
    std::span<const std::uint64_t> interpolated() const { return interpolated_; }

  private:
    static constexpr int kLevels = 5;  // cells of 16, 8, 4, 2 and 1 texels
    using Rows = std::array<std::uint64_t, TilePoints::kMaxSize>;

    static int level_of(int cell) { return cell == 16 ? 0 : cell == 8 ? 1 : cell == 4 ? 2 : cell == 2 ? 3 : 4; }
    std::size_t look(VisibilitySource& source, std::span<std::uint64_t> visible);
    std::size_t look_at_features(std::span<std::uint64_t> visible, VisibilitySource& source);
    bool find_mixed(int cell, std::span<const std::uint64_t> visible, const Rows& cells, Rows& mixed) const;
    void fill_next_level(int cell, std::span<std::uint64_t> visible) const;
    void interpolate(int cell, float threshold, const Rows& mixed, std::span<std::uint64_t> visible);

    const TilePoints& points_;
    Lattice lattice_;
    // [level][row]: bit set at a cell's first column and row. Cells without covered texels are never looked into.
    std::array<Rows, kLevels> in_use_{};
    std::array<std::uint64_t, kLevels> cell_columns_{};  // first columns of cells
    Rows first_{}, features_{};
    std::array<Rows, kLevels> is_halved_{};  // last and smaller cells that are halved, not interpolated, when mixed
    Rows known_{}, wanted_{}, interpolated_{};
};

}  // namespace skybake
