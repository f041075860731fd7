#include "light/cell_distribution.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace skybake {

CellDistribution::CellDistribution(std::vector<double> mass, std::size_t columns)
    : columns_(columns), sum_(std::move(mass)) {
    SKYBAKE_CHECK_LT(0u, columns);
    SKYBAKE_CHECK_EQ(sum_.size() % columns, 0u);
    double total = 0.0;
    for (std::size_t begin = 0; begin < sum_.size(); begin += columns) {
        for (std::size_t c = 1; c < columns; ++c) sum_[begin + c] += sum_[begin + c - 1];
        total += sum_[begin + columns - 1];
        row_end_.push_back(total);
    }
}

CellDistribution::Place CellDistribution::sample(float across, float down) const {
    SKYBAKE_DCHECK(total() > 0.0);
    const double target = static_cast<double>(down) * total();
    const auto found = std::upper_bound(row_end_.begin(), row_end_.end() - 1, target);
    const std::size_t row = static_cast<std::size_t>(found - row_end_.begin());
    const auto first = sum_.begin() + static_cast<std::ptrdiff_t>(row * columns_);
    const auto last = first + static_cast<std::ptrdiff_t>(columns_ - 1);
    const double row_mass = *last;
    const double wanted = static_cast<double>(across) * row_mass;
    const std::size_t column = static_cast<std::size_t>(std::upper_bound(first, last, wanted) - first);
    const std::size_t cell = row * columns_ + column;
    const double in_cell = mass(cell);
    // Differences of sums: rounding may carry a place a little out of its cell, or leave the last cell none of its
    // mass.
    const auto fraction = [](double part, double whole) {
        return whole > 0.0 ? std::clamp(part / whole, 0.0, 1.0) : 0.5;
    };
    return {static_cast<double>(column) + fraction(wanted - (sum_[cell] - in_cell), in_cell),
            static_cast<double>(row) + fraction(target - (row_end_[row] - row_mass), row_mass), cell};
}

double CellDistribution::mass(std::size_t cell) const {
    return cell % columns_ == 0 ? sum_[cell] : sum_[cell] - sum_[cell - 1];
}

}  // namespace skybake
