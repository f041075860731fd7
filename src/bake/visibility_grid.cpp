#include "bake/visibility_grid.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/check.h"

namespace skybake {

namespace {

constexpr std::array<int, 5> kCells{16, 8, 4, 2, 1};
// A last cell is halved when a feature lies within so many texels of it.
constexpr int kReach = 1;

/// The bits of columns [begin, end], end ≤ 63.
constexpr std::uint64_t columns(int begin, int end) {
    return (~0ull >> (63 - (end - begin))) << begin;
}

constexpr std::size_t packets(std::size_t rays) {
    return (rays + RayScene::kPacketSize - 1) / RayScene::kPacketSize;
}

/// Bit x of the result is set when any of the bits [x, x + cell] is.
std::uint64_t gather(std::uint64_t bits, int cell) {
    std::uint64_t all = bits;
    for (int step = 1; step < cell; step *= 2) all |= all >> step;
    return all | bits >> cell;
}

/// The bits [x, x + cell] of every set bit x.
std::uint64_t spread(std::uint64_t bits, int cell) {
    std::uint64_t all = bits;
    for (int step = 1; step < cell; step *= 2) all |= all << step;
    return all | bits << cell;
}

/// [corner bits (x, y): 00, 10, 01, 11][row]: which texels of a cell lie above the threshold.
using EdgeMasks = std::array<std::array<std::uint32_t, 17>, 16>;
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
                if (value > threshold) masks[corners][static_cast<std::size_t>(y)] |= 1u << x;
            }
        }
    }
    return masks;
}

/// The masks of a cell for the nearest of kThresholds thresholds.
const EdgeMasks& edge_masks(int level, float threshold) {
    static const auto tables = [] {
        std::array<std::array<EdgeMasks, kThresholds>, kCells.size()> all;
        for (std::size_t l = 0; l < kCells.size(); ++l) {
            for (std::size_t k = 0; k < kThresholds; ++k)
                all[l][k] = make_edge_masks(kCells[l], (static_cast<float>(k) + 0.5f) / kThresholds);
        }
        return all;
    }();
    return tables[static_cast<std::size_t>(level)]
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
}

void VisibilityGrid::set(const Lattice& lattice, std::span<const std::uint64_t> features,
                         std::span<const std::uint64_t> seen, std::span<const std::uint64_t> anchored) {
    lattice_ = lattice;
    std::copy(anchored.begin(), anchored.end(), first_.begin());
    for (std::size_t row = 0; row < features.size(); ++row) features_[row] = features[row] & ~anchored[row];
    const int first = lattice.first_cell;
    Rows blind{};
    for (int y = 0; y + first < points_.height; y += first) {
        const std::uint64_t cells = in_use_[level_of(first)][y];
        first_[y] |= cells | cells << first;
        first_[y + first] |= cells | cells << first;
        const std::uint64_t both = seen[y] & seen[y + first];
        const std::uint64_t near_blind = spread(cells & ~(both & both >> first), first);
        for (int row = y; row <= y + first; ++row) blind[row] |= near_blind;
    }
    for (int row = 0; row < points_.height; ++row) {
        first_[row] |= features_[row] & blind[row];
        features_[row] &= ~blind[row];
    }
    // Features that fill up a packet cost nothing.
    std::size_t nodes = 0, with_features = 0;
    for (int row = 0; row < points_.height; ++row) {
        nodes += static_cast<std::size_t>(std::popcount(first_[row]));
        with_features += static_cast<std::size_t>(std::popcount(first_[row] | features_[row]));
    }
    if (packets(with_features) == packets(nodes)) {
        for (int row = 0; row < points_.height; ++row) first_[row] |= std::exchange(features_[row], 0);
    }
    std::array<std::uint64_t, TilePoints::kMaxSize> near{};
    for (int row = 0; row < points_.height; ++row) {
        for (int r = std::max(row - kReach, 0); r <= std::min(row + kReach, points_.height - 1); ++r)
            near[row] |= features[r] | anchored[r];
        for (int step = 0; step < kReach; ++step) near[row] |= near[row] << 1 | near[row] >> 1;
    }
    for (int cell = lattice.last_cell; cell > 1; cell /= 2) {
        const int level = level_of(cell);
        for (int y = 0; y + cell < points_.height; y += cell) {
            std::uint64_t any = 0;
            for (int row = y; row <= y + cell; ++row) any |= near[row];
            is_halved_[level][y] = gather(any, cell) & cell_columns_[level];
        }
    }
}

std::size_t VisibilityGrid::look(VisibilitySource& source, std::span<std::uint64_t> visible) {
    for (int row = 0; row < points_.height; ++row) known_[row] |= wanted_[row];
    return source.look(std::span(wanted_).first(static_cast<std::size_t>(points_.height)), visible);
}

std::size_t VisibilityGrid::look_at_features(std::span<std::uint64_t> visible, VisibilitySource& source) {
    const int cell = lattice_.first_cell;
    std::fill_n(wanted_.begin(), points_.height, 0);
    std::uint64_t any = 0;
    for (int y = 0; y + cell < points_.height; y += cell) {
        std::uint64_t seen = visible[y] | visible[y + cell];
        seen = (seen | seen >> cell) & in_use_[level_of(cell)][y];
        if (!seen) continue;
        const std::uint64_t columns_seen = spread(seen, cell);
        for (int row = y; row <= y + cell; ++row) any |= wanted_[row] |= features_[row] & columns_seen & ~known_[row];
    }
    return any ? look(source, visible) : 0;
}

bool VisibilityGrid::find_mixed(int cell, std::span<const std::uint64_t> visible, const Rows& cells,
                                Rows& mixed) const {
    std::uint64_t any = 0;
    for (int y = 0; y + cell < points_.height; y += cell) {
        std::uint64_t seen = 0, hidden = 0;
        for (int row = y; row <= y + cell; ++row) {
            seen |= visible[row] & known_[row];
            hidden |= ~visible[row] & known_[row];
        }
        any |= mixed[y] = gather(seen, cell) & gather(hidden, cell) & cells[y];
    }
    return any != 0;
}

void VisibilityGrid::interpolate(int cell, float threshold, const Rows& mixed, std::span<std::uint64_t> visible) {
    const EdgeMasks& masks = edge_masks(level_of(cell), threshold);
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

std::size_t VisibilityGrid::solve(float threshold, VisibilitySource& source, std::span<std::uint64_t> visible) {
    const int first = lattice_.first_cell;
    std::fill(visible.begin(), visible.end(), 0);
    std::fill_n(interpolated_.begin(), points_.height, 0);
    std::copy_n(first_.begin(), points_.height, known_.begin());
    std::size_t looked_at = source.look_first(first_look(), visible);
    std::uint64_t any_seen = 0, any_hidden = 0;
    for (int row = 0; row < points_.height; ++row) any_seen |= visible[row];
    if (!any_seen) return looked_at;
    looked_at += look_at_features(visible, source);
    for (int row = 0; row < points_.height; ++row) any_hidden |= known_[row] & ~visible[row];
    if (!any_hidden) {
        std::copy_n(points_.covered.begin(), points_.height, visible.begin());
        return looked_at;
    }

    Rows cells = in_use_[level_of(first)];
    std::array<Rows, kLevels> mixed{};
    for (int cell = first;; cell /= 2) {
        const int half = cell / 2, level = level_of(cell);
        const bool is_last = cell <= lattice_.last_cell;
        if (find_mixed(cell, visible, cells, mixed[level])) {
            std::fill_n(wanted_.begin(), points_.height, 0);
            for (int y = 0; y + cell < points_.height; y += cell) {
                const std::uint64_t corners = mixed[level][y];
                wanted_[y] |= corners | corners << cell;
                wanted_[y + cell] |= corners | corners << cell;
                const std::uint64_t halved = is_last ? corners & is_halved_[level][y] : corners;
                if (cell == 1 || !halved) continue;
                wanted_[y] |= halved << half;
                wanted_[y + half] |= halved | halved << half | halved << cell;
                wanted_[y + cell] |= halved << half;
            }
            std::uint64_t any = 0;
            for (int y = 0; y < points_.height; ++y) any |= wanted_[y] &= ~known_[y];
            if (any) looked_at += look(source, visible);
        }
        if (cell == 1) break;
        fill_next_level(cell, visible);
        // The next cells: all of them, or below the last cell the quarters of those that were halved.
        if (!is_last) {
            cells = in_use_[level + 1];
            continue;
        }
        Rows quarters{};
        for (int y = 0; y + cell < points_.height; y += cell) {
            const std::uint64_t halved = mixed[level][y] & is_halved_[level][y];
            mixed[level][y] &= ~halved;  // what is left is interpolated
            quarters[y] = quarters[y + half] = halved | halved << half;
        }
        cells = quarters;
    }
    for (int cell = lattice_.last_cell; cell > 1; cell /= 2)
        interpolate(cell, threshold, mixed[level_of(cell)], visible);
    for (int row = 0; row < points_.height; ++row) visible[row] &= points_.covered[row];
    return looked_at;
}

}  // namespace skybake
