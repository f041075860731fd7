#include "bake/visibility_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace skybake {

namespace {

constexpr int kRootCell = 16;

/// Lattice lines from 0 to size − 1, at most kRootCell apart, evenly spaced.
std::vector<int> lattice_lines(int size) {
    const int cells = std::max(1, (size - 1 + kRootCell - 1) / kRootCell);
    std::vector<int> lines;
    for (int i = 0; i <= cells; ++i) lines.push_back(i * (size - 1) / cells);
    return lines;
}

}  // namespace

VisibilityGrid::VisibilityGrid(const TilePoints& points) : points_(points), known_(static_cast<std::size_t>(points.height)) {
    const std::vector<int> columns = lattice_lines(points.width), rows = lattice_lines(points.height);
    for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
        for (std::size_t i = 0; i + 1 < columns.size(); ++i) add_cell(columns[i], rows[j], columns[i + 1], rows[j + 1]);
    }
    for (std::uint32_t c = 0; c < cells_.size(); ++c) roots_[0].push_back(c);
    for (std::size_t c = 0; c < cells_.size(); ++c) split(c);
    for (int level = 1; level < 3; ++level) {
        const int size = kRootCell >> level;
        std::vector<std::uint32_t> open = roots_[0];
        while (!open.empty()) {
            const std::uint32_t c = open.back();
            open.pop_back();
            if (cells_[c].extent() <= size || cells_[c].child_count == 0) {
                roots_[level].push_back(c);
                continue;
            }
            for (int i = cells_[c].child_count - 1; i >= 0; --i) open.push_back(cells_[c].first_child + static_cast<std::uint32_t>(i));
        }
        std::sort(roots_[level].begin(), roots_[level].end());
    }
    force(std::vector<std::uint64_t>(points.covered.size(), 0));
}

/// False when the cell holds no covered texel.
bool VisibilityGrid::add_cell(int x0, int y0, int x1, int y1) {
    Cell cell{static_cast<std::uint8_t>(x0), static_cast<std::uint8_t>(y0), static_cast<std::uint8_t>(x1), static_cast<std::uint8_t>(y1), 0, false, {}, 0};
    const std::uint64_t columns = cell.columns();
    bool is_empty = true, is_full = true;
    for (int y = y0; y <= y1; ++y) {
        const std::uint64_t covered = points_.covered[y] & columns;
        is_empty = is_empty && covered == 0;
        is_full = is_full && covered == columns;
    }
    if (is_empty) return false;
    for (int k = 0; k < 4; ++k) {
        const int corner_x = k & 1 ? x1 : x0, corner_y = k & 2 ? y1 : y0;
        int best_x = corner_x, best_y = corner_y;
        if (!is_full && !(points_.covered[corner_y] >> corner_x & 1)) {
            int best = std::numeric_limits<int>::max();
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    const int distance2 = (x - corner_x) * (x - corner_x) + (y - corner_y) * (y - corner_y);
                    if ((points_.covered[y] >> x & 1) && distance2 < best) {
                        best = distance2;
                        best_x = x;
                        best_y = y;
                    }
                }
            }
        }
        cell.test[k] = static_cast<std::uint16_t>(points_.texel(best_x, best_y));
    }
    cells_.push_back(cell);
    return true;
}

void VisibilityGrid::split(std::size_t index) {
    const Cell cell = cells_[index];
    const int xm = (cell.x0 + cell.x1) / 2, ym = (cell.y0 + cell.y1) / 2;
    const bool splits_x = cell.x1 - cell.x0 > 1, splits_y = cell.y1 - cell.y0 > 1;
    if (!splits_x && !splits_y) return;
    const std::uint32_t first = static_cast<std::uint32_t>(cells_.size());
    std::uint8_t count = 0;
    for (int j = 0; j <= static_cast<int>(splits_y); ++j) {
        for (int i = 0; i <= static_cast<int>(splits_x); ++i) {
            count = static_cast<std::uint8_t>(count + add_cell(splits_x && i == 1 ? xm : cell.x0, splits_y && j == 1 ? ym : cell.y0,
                                                               splits_x && i == 0 ? xm : cell.x1, splits_y && j == 0 ? ym : cell.y1));
        }
    }
    cells_[index].first_child = first;
    cells_[index].child_count = count;
}

void VisibilityGrid::force(std::span<const std::uint64_t> texels) {
    for (Cell& cell : cells_) {
        const std::uint64_t columns = cell.columns();
        std::uint64_t any = 0;
        for (int y = cell.y0; y <= cell.y1; ++y) any |= (texels[y] | points_.is_feature[y]) & columns & points_.covered[y];
        cell.is_forced = any != 0;
    }
}

bool VisibilityGrid::agrees(const Cell& cell, std::span<const std::uint64_t> visible) const {
    const int width = points_.width;
    const int row = cell.test[0] / width, column = cell.test[0] % width;
    const std::uint64_t expected = visible[row] >> column & 1 ? ~0ull : 0ull;
    const std::uint64_t columns = cell.columns();
    std::uint64_t differs = 0;
    for (int y = cell.y0; y <= cell.y1; ++y) differs |= known_[y] & columns & (visible[y] ^ expected);
    return differs == 0;
}

void VisibilityGrid::want(const Cell& cell) {
    const int width = points_.width;
    for (const std::uint16_t texel : cell.test) {
        const int row = texel / width;
        const std::uint64_t bit = 1ull << (texel % width);
        if (known_[row] & bit) continue;
        known_[row] |= bit;
        wanted_.push_back(texel);
    }
}

void VisibilityGrid::interpolate(const Cell& cell, std::span<std::uint64_t> visible) {
    const int width = points_.width;
    const auto value = [&](int k) { return static_cast<float>(visible[cell.test[k] / width] >> (cell.test[k] % width) & 1); };
    const float v00 = value(0), v10 = value(1), v01 = value(2), v11 = value(3);
    for (int y = cell.y0; y <= cell.y1; ++y) {
        for (int x = cell.x0; x <= cell.x1; ++x) {
            const std::uint64_t bit = 1ull << x;
            if (!(points_.covered[y] & bit) || (known_[y] & bit)) continue;
            const float s = cell.x1 > cell.x0 ? static_cast<float>(x - cell.x0) / static_cast<float>(cell.x1 - cell.x0) : 0.0f;
            const float t = cell.y1 > cell.y0 ? static_cast<float>(y - cell.y0) / static_cast<float>(cell.y1 - cell.y0) : 0.0f;
            known_[y] |= bit;  // a shared border is interpolated once, by the cell that comes first
            visible[y] &= ~bit;
            fractions_.push_back({static_cast<std::uint16_t>(points_.texel(x, y)), (1 - t) * ((1 - s) * v00 + s * v10) + t * ((1 - s) * v01 + s * v11)});
        }
    }
}

std::size_t VisibilityGrid::solve(const Lattice& lattice, VisibilitySource& source, std::span<std::uint64_t> visible) {
    std::fill(known_.begin(), known_.end(), 0);
    std::fill(visible.begin(), visible.end(), 0);
    fractions_.clear();
    settled_.clear();
    next_.clear();
    wanted_.clear();
    std::size_t looked_at = 0;
    pending_ = roots_[lattice.first_cell >= 16 ? 0 : lattice.first_cell >= 8 ? 1 : 2];
    for (const std::uint32_t c : pending_) want(cells_[c]);
    interpolated_.clear();
    while (!pending_.empty()) {
        source.look(wanted_, visible);
        looked_at += wanted_.size();
        wanted_.clear();
        next_.clear();
        for (const std::uint32_t c : pending_) {
            const Cell& cell = cells_[c];
            if (!cell.is_forced && agrees(cell, visible)) {
                settled_.push_back(c);
            } else if (!cell.is_forced && cell.extent() <= lattice.last_cell) {
                interpolated_.push_back(c);
            } else {
                for (std::uint32_t i = 0; i < cell.child_count; ++i) {
                    next_.push_back(cell.first_child + i);
                    want(cells_[cell.first_child + i]);
                }
            }
        }
        if (next_.empty()) {
            // A neighbour's finer nodes may contradict a cell that seemed settled: its shadow's edge is followed into it.
            std::size_t kept = 0;
            for (const std::uint32_t c : settled_) {
                if (!agrees(cells_[c], visible)) {
                    next_.push_back(c);
                } else {
                    settled_[kept++] = c;
                }
            }
            settled_.resize(kept);
        }
        std::swap(pending_, next_);
    }
    for (const std::uint32_t c : settled_) {
        const Cell& cell = cells_[c];
        const bool is_visible = visible[cell.test[0] / points_.width] >> (cell.test[0] % points_.width) & 1;
        const std::uint64_t columns = cell.columns();
        for (int y = cell.y0; y <= cell.y1; ++y) {
            const std::uint64_t fill = columns & points_.covered[y] & ~known_[y];
            known_[y] |= fill;
            if (is_visible) visible[y] |= fill;
        }
    }
    for (const std::uint32_t c : interpolated_) interpolate(cells_[c], visible);
    return looked_at;
}

}  // namespace skybake
