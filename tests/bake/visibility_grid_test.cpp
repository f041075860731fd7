// The hierarchy over one direction's visibility, against a truth that is known.
#include "bake/visibility_grid.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>

namespace skybake {
namespace {

using Rows = std::vector<std::uint64_t>;
constexpr int kSize = 49;

Rows rows_of(const std::function<bool(int, int)>& is_set) {
    Rows rows(kSize, 0);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) rows[y] |= static_cast<std::uint64_t>(is_set(x, y)) << x;
    }
    return rows;
}
const Rows kNone(kSize, 0);
const Rows kAll = rows_of([](int, int) { return true; });

class KnownVisibility final : public VisibilitySource {
  public:
    explicit KnownVisibility(Rows truth) : truth_(std::move(truth)) {}
    std::size_t look(std::span<const std::uint64_t> wanted, std::span<std::uint64_t> visible) override {
        std::size_t count = 0;
        for (std::size_t row = 0; row < wanted.size(); ++row) {
            visible[row] = (visible[row] & ~wanted[row]) | (truth_[row] & wanted[row]);
            count += static_cast<std::size_t>(std::popcount(wanted[row]));
        }
        return count;
    }

  private:
    Rows truth_;
};

class Grid : public testing::Test {
  protected:
    Grid() {
        points_.width = points_.height = kSize;
        points_.covered = kAll;
    }
    /// The texels found visible; `looked_at_` tells from how many looks.
    Rows solve(const Lattice& lattice, const Rows& truth, const Rows& features, const Rows& seen,
               float threshold = 0.5f) {
        VisibilityGrid grid(points_);
        grid.set(lattice, features, seen, kNone);
        KnownVisibility source(truth);
        Rows visible(kSize);
        looked_at_ = grid.solve(threshold, source, visible);
        return visible;
    }

    TilePoints points_;
    std::size_t looked_at_ = 0;
};

TEST_F(Grid, UniformTilesTakeTheirFirstNodes) {
    EXPECT_EQ(solve({16, 4}, kAll, kNone, kAll), kAll);
    EXPECT_EQ(looked_at_, 16u);
    EXPECT_EQ(solve({16, 4}, kNone, kNone, kAll), kNone);
    EXPECT_EQ(looked_at_, 16u);
}

TEST_F(Grid, FollowsAStraightEdgeToTheTexel) {
    const Rows truth = rows_of([](int x, int y) { return 3 * x + y > 70; });
    for (const int first : {16, 8, 4}) {
        EXPECT_EQ(solve({first, 1}, truth, kNone, kAll), truth) << first;
        EXPECT_LT(looked_at_, static_cast<std::size_t>(kSize * kSize / 4)) << first;
    }
}

/// Over thresholds spread evenly, a texel of a mixed last cell is visible as often as the corners interpolated say.
TEST_F(Grid, InterpolatesALastCellOverTheDirections) {
    const Rows truth = rows_of([](int x, int) { return x >= 22; });  // corners at 20 hidden, at 24 visible
    std::array<int, 5> count{};
    constexpr int kDirections = 16;
    for (int i = 0; i < kDirections; ++i) {
        const Rows visible = solve({16, 4}, truth, kNone, kAll, (static_cast<float>(i) + 0.5f) / kDirections);
        for (int k = 0; k <= 4; ++k) count[k] += static_cast<int>(visible[10] >> (20 + k) & 1);
    }
    EXPECT_EQ(count, (std::array<int, 5>{0, 4, 8, 12, 16}));
}

/// A chimney's shadow between the nodes is found from its foot, and traced to the texel about it.
TEST_F(Grid, AFeatureThatIsHiddenAmongVisibleNodesIsFound) {
    const auto chimney = [](int x, int y) { return x >= 5 && x <= 7 && y >= 20 && y <= 22; };
    const Rows truth = rows_of([&](int x, int y) { return !chimney(x, y); });
    EXPECT_EQ(solve({16, 4}, truth, kNone, kAll), kAll) << "no node meets it: the case below tests nothing";
    EXPECT_EQ(solve({16, 4}, truth, rows_of(chimney), kAll), truth);
}

/// An alley between two houses: all nodes lie under the houses, where no pilot sees the sky, so that they say nothing
/// of the alley.
TEST_F(Grid, AnAlleyBetweenBlindNodesIsLookedAt) {
    const Rows alley = rows_of([](int x, int) { return x == 6 || x == 7; });
    EXPECT_EQ(solve({16, 4}, alley, alley, alley), alley);
    // Where pilots do see the nodes, a direction that no node sees is taken to be hidden.
    EXPECT_EQ(solve({16, 4}, alley, alley, kAll), kNone);
}

}  // namespace
}  // namespace skybake
