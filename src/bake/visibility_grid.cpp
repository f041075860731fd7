#include "bake/visibility_grid.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace skybake {

namespace {

constexpr std::array<int, 5> kCells{16, 8, 4, 2, 1};

/// The bits of columns [begin, end], end ≤ 63.
constexpr std::uint64_t columns(int begin, int end) {
    return (~0ull >> (63 - (end - begin))) << begin;
}

/// [corner bits (x, y): 00, 10, 01, 11][row]: which texels of a cell lie above the threshold.
using EdgeMasks = std::array<std::array<std::uint8_t, 5>, 16>;
constexpr int kThresholds = 16;

EdgeMasks make_edge_masks(int cell, float threshold) {
    EdgeMasks masks{};
    for (std::size_t corners = 0; corners < 16; ++corners) {
        const auto corner = [&](int k) { return static_cast<float>(corners >> k & 1); };
        for (int y = 0; y <= cell; ++y) {
            for (int x = 0; x <= cell; ++x) {
                const float s = static_cast<float>(x) / static_cast<float>(cell),
                            t = static_cast<float>(y) / static_cast<float>(cell);
                const float value =
                    (1 - t) * ((1 - s) * corner(0) + s * corner(1)) + t * ((1 - s) * corner(2) + s * corner(3));
                if (value > threshold)
                    masks[corners][static_cast<std::size_t>(y)] |= static_cast<std::uint8_t>(1u << x);
            }
        }
    }
    return masks;
}

/// The masks of cells of 2 or 4 texels for the nearest of kThresholds thresholds.
const EdgeMasks& edge_masks(int cell, float threshold) {
    static const auto tables = [] {
        std::array<std::array<EdgeMasks, kThresholds>, 2> all;
        for (int size = 0; size < 2; ++size) {
            for (int k = 0; k < kThresholds; ++k)
                all[size][k] = make_edge_masks(2 << size, (static_cast<float>(k) + 0.5f) / kThresholds);
        }
        return all;
    }();
    return tables[cell == 2 ? 0 : 1]
                 [static_cast<std::size_t>(std::clamp(static_cast<int>(threshold * kThresholds), 0, kThresholds - 1))];
}

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
            for (int row = y; row <= y + cell; ++row)
                any |= (texels[row] | points_.is_feature[row]) & points_.covered[row];
            if (!any) continue;
            for (int x = 0; x + cell < points_.width; x += cell) {
                if (any & columns(x, x + cell)) forced_[level][y] |= 1ull << x;
            }
        }
    }
}

std::size_t VisibilityGrid::look(VisibilitySource& source, std::span<std::uint64_t> visible) {
    for (int row = 0; row < points_.height; ++row) known_[row] |= wanted_[row];
    return source.look(std::span(wanted_).first(static_cast<std::size_t>(points_.height)), visible);
}

void VisibilityGrid::find_mixed(int cell, std::span<const std::uint64_t> visible, Rows& mixed) const {
    const int level = level_of(cell);
    for (int y = 0; y + cell < points_.height; y += cell) {
        const std::uint64_t low = visible[y], high = visible[y + cell];
        mixed[y] =
            (((low ^ (low >> cell)) | (low ^ high) | (low ^ (high >> cell))) & in_use_[level][y]) | forced_[level][y];
    }
}

void VisibilityGrid::interpolate(int cell, float threshold, const Rows& mixed, std::span<std::uint64_t> visible) {
    const EdgeMasks& masks = edge_masks(cell, threshold);
    for (int y0 = 0; y0 + cell < points_.height; y0 += cell) {
        for (std::uint64_t left = mixed[y0]; left; left &= left - 1) {
            const int x0 = std::countr_zero(left);
            const std::size_t corners = (visible[y0] >> x0 & 1) | (visible[y0] >> (x0 + cell) & 1) << 1 |
                                        (visible[y0 + cell] >> x0 & 1) << 2 |
                                        (visible[y0 + cell] >> (x0 + cell) & 1) << 3;
            const std::uint64_t cell_columns = columns(x0, x0 + cell);
            for (int row = 0; row <= cell; ++row) {
                const std::uint64_t open = cell_columns & ~known_[y0 + row];
                interpolated_[y0 + row] |= open;
                visible[y0 + row] =
                    (visible[y0 + row] & ~open) |
                    (static_cast<std::uint64_t>(masks[corners][static_cast<std::size_t>(row)]) << x0 & open);
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

std::size_t VisibilityGrid::solve(const Lattice& lattice, float threshold, VisibilitySource& source,
                                  std::span<std::uint64_t> visible) {
    std::fill(visible.begin(), visible.end(), 0);
    known_.fill(0);
    wanted_.fill(0);
    interpolated_.fill(0);
    const int first = lattice.first_cell;
    for (int y = 0; y + first < points_.height; y += first) {
        const std::uint64_t cells = in_use_[level_of(first)][y];
        wanted_[y] |= cells | cells << first;
        wanted_[y + first] |= cells | cells << first;
    }
    std::size_t looked_at = look(source, visible);

    Rows mixed{}, to_interpolate{};
    for (int cell = first; cell >= 1; cell /= 2) {
        // Below the last cell only what is forced is looked at.
        const bool is_halving = cell > lattice.last_cell || cell == 1;
        const int half = cell / 2;
        for (;;) {
            find_mixed(cell, visible, mixed);
            const Rows& forced = forced_[level_of(cell)];
            std::fill_n(wanted_.begin(), points_.height, 0);
            for (int y = 0; y + cell < points_.height; y += cell) {
                const std::uint64_t refined = is_halving ? mixed[y] : forced[y];
                const std::uint64_t corners = cell >= lattice.last_cell ? mixed[y] : refined;
                if (!corners) continue;
                wanted_[y] |= corners | corners << cell;
                wanted_[y + cell] |= corners | corners << cell;
                if (cell == 1 || !refined) continue;
                wanted_[y] |= refined << half;
                wanted_[y + half] |= refined | refined << half | refined << cell;
                wanted_[y + cell] |= refined << half;
            }
            std::uint64_t any = 0;
            for (int y = 0; y < points_.height; ++y) any |= wanted_[y] &= ~known_[y];
            if (!any) break;
            looked_at += look(source, visible);
        }
        if (cell == 1) break;
        fill_next_level(cell, visible);
        if (cell == lattice.last_cell) {
            for (int y = 0; y < points_.height; ++y) to_interpolate[y] = mixed[y] & ~forced_[level_of(cell)][y];
        }
    }
    if (lattice.last_cell > 1) interpolate(lattice.last_cell, threshold, to_interpolate, visible);
    for (int row = 0; row < points_.height; ++row) visible[row] &= points_.covered[row];
    return looked_at;
}

}  // namespace skybake
