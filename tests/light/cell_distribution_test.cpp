// Cells are drawn by their mass, places within them evenly.
#include "light/cell_distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace skybake {
namespace {

// Rows and cells without mass at the start, in the middle and at the end.
const std::vector<double> kMass{0, 0, 0, 0,  //
                                0, 3, 1, 0,  //
                                0, 0, 0, 0,  //
                                2, 0, 0, 2,  //
                                0, 0, 0, 0};
constexpr std::size_t kColumns = 4;
constexpr int kSide = 400;

TEST(CellDistribution, DrawsCellsByTheirMassAndPlacesEvenly) {
    const CellDistribution cells(kMass, kColumns);
    EXPECT_EQ(cells.total(), 8.0);
    std::vector<double> count(kMass.size(), 0.0), column(kMass.size(), 0.0), row(kMass.size(), 0.0);
    for (int i = 0; i < kSide * kSide; ++i) {
        const CellDistribution::Place place = cells.sample((static_cast<float>(i % kSide) + 0.5f) / kSide,
                                                           (static_cast<float>(i / kSide) + 0.5f) / kSide);
        const double c = place.column - static_cast<double>(place.cell % kColumns),
                     r = place.row - static_cast<double>(place.cell / kColumns);
        ASSERT_GE(std::min(c, r), 0.0);
        ASSERT_LE(std::max(c, r), 1.0);
        count[place.cell] += 1.0;
        column[place.cell] += c;
        row[place.cell] += r;
    }
    for (std::size_t cell = 0; cell < kMass.size(); ++cell) {
        EXPECT_EQ(cells.mass(cell), kMass[cell]);
        // The lattice cuts a cell to one of its steps along each side.
        EXPECT_NEAR(count[cell] / (kSide * kSide), kMass[cell] / 8.0, kMass[cell] > 0.0 ? 1.0 / kSide : 0.0) << cell;
        if (count[cell] == 0.0) continue;
        EXPECT_NEAR(column[cell] / count[cell], 0.5, 4.0 / kSide) << cell;
        EXPECT_NEAR(row[cell] / count[cell], 0.5, 4.0 / kSide) << cell;
    }
}

TEST(CellDistribution, EndsStayInCellsWithMass) {
    const CellDistribution cells(kMass, kColumns);
    const float last = std::nextafter(1.0f, 0.0f);
    for (const float across : {0.0f, last}) {
        for (const float down : {0.0f, last}) EXPECT_GT(kMass[cells.sample(across, down).cell], 0.0);
    }
}

}  // namespace
}  // namespace skybake
