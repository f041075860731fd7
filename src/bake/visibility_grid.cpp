#include "bake/visibility_grid.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace skybake {

namespace {

constexpr std::array<int, 5> kCells{16, 8, 4, 2, 1};

/// The bits of columns [begin, end], end ≤ 63.
constexpr std::uint64_t columns(int begin, int end) { return (~0ull >> (63 - (end - begin))) << begin; }

}  // namespace

VisibilityGrid::VisibilityGrid(const TilePoints& points) : points_(points) {
    SKYBAKE_CHECK_EQ((points.width - 1) % TilePoints::kCell, 0);
    SKYBAKE_CHECK_EQ((points.height - 1) % TilePoints::kCell, 0);
    for (int level = 0; level < kLevels; ++level) {
        const int cell = kCells[level];
        for (int x = 0; x + cell < points.width; x += cell) cell_columns_[level] |= 1ull << x;
        for (int y = 0; y + cell < points.height; y += cell) {
            std::uint64_t covered = 0;
            for (int row = y; row <= y + cell; ++row) covered |= points.covered[row];
            for (int x = 0; x + cell < points.width; x += cell) {
                if (covered & columns(x, x + cell)) in_use_[level][y] |= 1ull << x;
            }
        }
    }
    force(std::vector<std::uint64_t>(points.covered.size(), 0));
}

void VisibilityGrid::force(std::span<const std::uint64_t> texels) {
    for (int level = 0; level < kLevels; ++level) {
        const int cell = kCells[level];
        forced_[level].fill(0);
        if (cell == 1) continue;  // nothing is left to halve
        for (int y = 0; y + cell < points_.height; y += cell) {
            std::uint64_t any = 0;
            for (int row = y; row <= y + cell; ++row) any |= (texels[row] | points_.is_feature[row]) & points_.covered[row];
            if (!any) continue;
            for (int x = 0; x + cell < points_.width; x += cell) {
                if (any & columns(x, x + cell)) forced_[level][y] |= 1ull << x;
            }
        }
    }
}

std::size_t VisibilityGrid::look(VisibilitySource& source, std::span<std::uint64_t> visible) {
    std::size_t count = 0;
    for (int row = 0; row < points_.height; ++row) {
        count += static_cast<std::size_t>(std::popcount(wanted_[row]));
        known_[row] |= wanted_[row];
    }
    if (count > 0) source.look(std::span(wanted_).first(static_cast<std::size_t>(points_.height)), visible);
    return count;
}

void VisibilityGrid::find_mixed(int cell, std::span<const std::uint64_t> visible, Rows& mixed) const {
    const int level = level_of(cell);
    for (int y = 0; y + cell < points_.height; y += cell) {
        const std::uint64_t low = visible[y], high = visible[y + cell];
        mixed[y] = (((low ^ (low >> cell)) | (low ^ high) | (low ^ (high >> cell))) & in_use_[level][y]) | forced_[level][y];
    }
}

void VisibilityGrid::interpolate(int cell, const Rows& mixed, std::span<const std::uint64_t> visible) {
    const float step = 1.0f / static_cast<float>(cell);
    Rows done = known_;
    for (int y0 = 0; y0 + cell < points_.height; y0 += cell) {
        for (std::uint64_t left = mixed[y0]; left; left &= left - 1) {
            const int x0 = std::countr_zero(left);
            const auto value = [&](int x, int y) { return static_cast<float>(visible[y] >> x & 1); };
            const float v00 = value(x0, y0), v10 = value(x0 + cell, y0), v01 = value(x0, y0 + cell), v11 = value(x0 + cell, y0 + cell);
            for (int y = y0; y <= y0 + cell; ++y) {
                const float t = static_cast<float>(y - y0) * step;
                for (std::uint64_t open = columns(x0, x0 + cell) & points_.covered[y] & ~done[y]; open; open &= open - 1) {
                    const int x = std::countr_zero(open);
                    const float s = static_cast<float>(x - x0) * step;
                    done[y] |= 1ull << x;  // a common side is interpolated once: both cells would give the same
                    fractions_.push_back({static_cast<std::uint16_t>(points_.texel(x, y)), (1 - t) * ((1 - s) * v00 + s * v10) + t * ((1 - s) * v01 + s * v11)});
                }
            }
        }
    }
}

/// Nodes of the next level that nobody looked at are as their cell's corners.
void VisibilityGrid::fill_next_level(int cell, std::span<std::uint64_t> visible) const {
    const int half = cell / 2;
    const std::uint64_t nodes = cell_columns_[level_of(cell)] | cell_columns_[level_of(cell)] << cell;
    for (int y = 0; y < points_.height; y += cell) {
        const std::uint64_t corner = visible[y] & nodes;
        const std::uint64_t middle = corner << half;
        visible[y] |= middle & ~known_[y];
        if (y + half < points_.height) visible[y + half] |= (corner | middle) & ~known_[y + half];
    }
}

std::size_t VisibilityGrid::solve(const Lattice& lattice, VisibilitySource& source, std::span<std::uint64_t> visible) {
    std::fill(visible.begin(), visible.end(), 0);
    known_.fill(0);
    wanted_.fill(0);
    fractions_.clear();
    const int first = lattice.first_cell;
    for (int y = 0; y + first < points_.height; y += first) {
        const std::uint64_t cells = in_use_[level_of(first)][y];
        wanted_[y] |= cells | cells << first;
        wanted_[y + first] |= cells | cells << first;
    }
    std::size_t looked_at = look(source, visible);

    Rows mixed;
    for (int cell = first;; cell /= 2) {
        const bool is_last = cell <= lattice.last_cell;
        const int half = cell / 2;
        for (;;) {
            find_mixed(cell, visible, mixed);
            for (int y = 0; y < points_.height; y += std::max(half, 1)) wanted_[y] = 0;
            for (int y = 0; y + cell < points_.height; y += cell) {
                const std::uint64_t m = mixed[y];
                if (!m) continue;
                std::uint64_t side = m | m << cell;
                if (!is_last) {
                    side |= m << half;
                    wanted_[y + half] |= side;
                }
                wanted_[y] |= side;
                wanted_[y + cell] |= side;
            }
            std::uint64_t any = 0;
            for (int y = 0; y < points_.height; y += std::max(half, 1)) any |= wanted_[y] &= ~known_[y];
            if (!any) break;
            looked_at += look(source, visible);
        }
        if (is_last) {
            if (cell > 1) interpolate(cell, mixed, visible);
            for (int fill = cell; fill > 1; fill /= 2) fill_next_level(fill, visible);
            break;
        }
        fill_next_level(cell, visible);
    }
    for (int row = 0; row < points_.height; ++row) visible[row] &= points_.covered[row];
    return looked_at;
}

}  // namespace skybake
