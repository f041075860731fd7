// A density that is even within each cell of a table.
#pragma once

#include <cstddef>
#include <vector>

namespace skybake {

/// Draws cells of a table by their mass, and places within them evenly: first the row, then the column (Pharr, Jakob,
/// Humphreys, Physically Based Rendering, 3rd ed., §13.6.7). Read-only after construction.
class CellDistribution {
  public:
    CellDistribution() = default;
    /// `mass` [row × columns + column]: of each cell, not negative; rows of no mass are never drawn.
    CellDistribution(std::vector<double> mass, std::size_t columns);

    struct Place {
        double column = 0.0, row = 0.0;  // whole part: the cell's; fraction: where in it
        std::size_t cell = 0;
    };
    /// `across`, `down` in [0, 1): along the row and through the rows.
    Place sample(float across, float down) const;

    double mass(std::size_t cell) const;
    /// Of all cells.
    double total() const { return row_end_.empty() ? 0.0 : row_end_.back(); }

  private:
    std::size_t columns_ = 1;
    std::vector<double> sum_;      // [row][column]: summed along each row, up to and with this one
    std::vector<double> row_end_;  // [row]: all rows up to and with this one
};

}  // namespace skybake
