// Runs of neighbours hold every point once, and are compact.
#include "bake/neighbour_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/box.h"

namespace skybake {
namespace {

TEST(NeighbourRuns, HoldEveryChosenPointOnce) {
    std::vector<Vec3f> points;
    for (int j = 0; j < 1000; ++j) {
        const float i = static_cast<float>(j);
        points.emplace_back(std::sin(i), std::cos(2.0f * i), std::sin(3.0f * i + 1.0f));
    }
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t j = 0; j < 1000; j += 3) chosen.push_back(j);
    const NeighbourRuns runs(points, chosen, 16);
    std::vector<std::uint32_t> found;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        EXPECT_LE(runs[r].size(), 16u);
        EXPECT_GE(runs[r].size(), 8u);
        found.insert(found.end(), runs[r].begin(), runs[r].end());
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, chosen);
    EXPECT_EQ(NeighbourRuns(points, {}, 16).size(), 0u);
}

TEST(NeighbourRuns, AreCellsOfAGrid) {
    // 64 × 64 points a metre apart: runs of 16 are squares of 4 × 4, since the longest side is halved each time.
    std::vector<Vec3f> points;
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < 64 * 64; ++i) {
        points.emplace_back(i % 64, i / 64, 0.0f);
        all.push_back(i);
    }
    const NeighbourRuns runs(points, all, 16);
    ASSERT_EQ(runs.size(), 256u);
    for (std::size_t r = 0; r < runs.size(); ++r) {
        Box3f box;
        for (const std::uint32_t i : runs[r]) box.extend(points[i]);
        EXPECT_EQ(box.size(), Vec3f(3, 3, 0)) << "run " << r;
    }
}

TEST(NeighbourRuns, PointsAtOnePlaceEndToo) {
    const std::vector<Vec3f> points(100, Vec3f(1, 2, 3));
    std::vector<std::uint32_t> all(100);
    for (std::uint32_t i = 0; i < 100; ++i) all[i] = i;
    const NeighbourRuns runs(points, all, 16);
    EXPECT_EQ(runs.size(), 8u);
}

}  // namespace
}  // namespace skybake
