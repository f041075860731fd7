#include "light/light_profile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace skybake {

namespace {

// Cells of the sampling: rows in γ, columns in C; and points a side at which a cell's share is taken.
constexpr int kRows = 90;
constexpr int kColumns = 64;
constexpr int kCellPoints = 4;
constexpr double kEvenShare = 1e-3;

double row_top(int row) {
    return kPi * row / kRows;
}

/// Index and fraction of `value` between ascending nodes, within their range.
struct Place {
    std::size_t index = 0;
    double fraction = 0.0;
};
Place place_in(const std::vector<double>& nodes, double value) {
    const auto after = std::upper_bound(nodes.begin(), nodes.end(), value);
    if (after == nodes.begin()) return {};
    if (after == nodes.end()) return {nodes.size() - 1, 0.0};
    const std::size_t index = static_cast<std::size_t>(after - nodes.begin()) - 1;
    return {index, (value - nodes[index]) / (nodes[index + 1] - nodes[index])};
}

}  // namespace

LightProfile::LightProfile(std::vector<double> c_rad, std::vector<double> gamma_rad, std::vector<double> candela)
    : c_(std::move(c_rad)), gamma_(std::move(gamma_rad)), share_(std::move(candela)) {
    SKYBAKE_CHECK_EQ(share_.size(), c_.size() * gamma_.size());
    peak_cd_ = *std::max_element(share_.begin(), share_.end());
    SKYBAKE_CHECK_LT(0.0, peak_cd_);
    for (double& value : share_) value /= peak_cd_;
    tabulate_cells();
}

double LightProfile::interpolated(double c, double gamma) const {
    // Half a millionth of a turn of grace: the last angle itself is measured.
    if (gamma < gamma_.front() - 1e-6 || gamma > gamma_.back() + 1e-6) return 0.0;
    const Place at = place_in(gamma_, gamma);
    const auto in_plane = [&](std::size_t plane) {
        const double* share = share_.data() + plane * gamma_.size() + at.index;
        return at.fraction > 0.0 ? share[0] + at.fraction * (share[1] - share[0]) : share[0];
    };
    if (c_.size() == 1) return in_plane(0);
    Place turn = place_in(c_, c);
    const std::size_t next = (turn.index + 1) % c_.size();
    if (next == 0) turn.fraction = (c - c_.back()) / (2.0 * kPi - c_.back());
    const double here = in_plane(turn.index);
    return here + turn.fraction * (in_plane(next) - here);
}

void LightProfile::tabulate_cells() {
    double total = 0.0;
    std::vector<double> mean(kRows * kColumns, 0.0);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            double& cell = mean[static_cast<std::size_t>(row * kColumns + column)];
            // Slices of γ weigh by their solid angle.
            const double slice = (row_top(row + 1) - row_top(row)) / kCellPoints;
            for (int i = 0; i < kCellPoints; ++i) {
                const double gamma = row_top(row) + (i + 0.5) * slice;
                const double weight =
                    (std::cos(gamma - 0.5 * slice) - std::cos(gamma + 0.5 * slice)) * 2.0 * kPi / kColumns;
                for (int j = 0; j < kCellPoints; ++j) {
                    const double c = 2.0 * kPi * (column + (j + 0.5) / kCellPoints) / kColumns;
                    cell += weight * interpolated(c, gamma) / kCellPoints;
                }
            }
            total += cell;
        }
    }
    solid_angle_ = total;
    for (int row = 0; row < kRows; ++row) {
        const double even = (std::cos(row_top(row)) - std::cos(row_top(row + 1))) / (2.0 * kColumns);
        for (int column = 0; column < kColumns; ++column) {
            double& cell = mean[static_cast<std::size_t>(row * kColumns + column)];
            cell = (1.0 - kEvenShare) * cell / total + kEvenShare * even;
        }
    }
    cells_ = CellDistribution(std::move(mean), kColumns);
}

float LightProfile::share(const Vec3f& local) const {
    const double gamma = std::acos(std::clamp(static_cast<double>(local.z), -1.0, 1.0));
    if (c_.size() == 1) return static_cast<float>(interpolated(0.0, gamma));
    double c = std::atan2(static_cast<double>(local.y), static_cast<double>(local.x));
    if (c < 0.0) c += 2.0 * kPi;
    return static_cast<float>(interpolated(c, gamma));
}

float LightProfile::largest_share(float low_rad, float high_rad) const {
    const double low = static_cast<double>(low_rad), high = static_cast<double>(high_rad);
    // The share is piecewise linear in γ: the largest is at a node or at an end, and no end exceeds the nodes about it.
    double largest = 0.0;
    for (std::size_t g = 0; g < gamma_.size(); ++g) {
        const double before = g > 0 ? gamma_[g - 1] : gamma_[g];
        const double after = g + 1 < gamma_.size() ? gamma_[g + 1] : gamma_[g];
        if (after < low - 1e-6 || before > high + 1e-6) continue;
        for (std::size_t plane = 0; plane < c_.size(); ++plane)
            largest = std::max(largest, share_[plane * gamma_.size() + g]);
    }
    return static_cast<float>(largest);
}

LightProfile::Sample LightProfile::sample(float u, float v) const {
    const CellDistribution::Place place = cells_.sample(u, v);
    const int row = static_cast<int>(place.cell) / kColumns;
    const double z0 = std::cos(row_top(row)), z1 = std::cos(row_top(row + 1));
    const double z = z0 + (place.row - row) * (z1 - z0), r = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double c = 2.0 * kPi * place.column / kColumns;
    return {Vec3f(Vec3d(r * std::cos(c), r * std::sin(c), z)),
            cells_.mass(place.cell) / cells_.total() / ((z0 - z1) * 2.0 * kPi / kColumns)};
}

}  // namespace skybake
