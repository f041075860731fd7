#include "base/finding.h"

#include <gtest/gtest.h>

namespace skybake {
namespace {

TEST(FindingLog, KeepsTheFirstFewAndCountsAll) {
    FindingLog log;
    for (int i = 0; i < 1000; ++i) log.add({"SB201", Severity::warning, "a.json: #/" + std::to_string(i), "doubled.", ""});
    log.add({"SB105", Severity::error, "a.json", "missing.", "Repair it."});
    const std::vector<Finding> list = log.list();
    ASSERT_EQ(list.size(), FindingLog::kKeptPerCode + 1);
    EXPECT_EQ(list[0].code, "SB105");
    EXPECT_EQ(list[1].where, "a.json: #/0");
    std::uint64_t sum = 0;
    for (const Finding& finding : list) sum += finding.count;
    EXPECT_EQ(sum, 1001u);
    EXPECT_EQ(log.count("SB201"), 1000u);
    EXPECT_EQ(log.count(Severity::error), 1u);
}

TEST(FindingLog, TextNamesCodeSeverityPlaceFaultAndRemedy) {
    EXPECT_EQ(to_text({"SB203", Severity::warning, "d.json: #/CityObjects/b", "ring crosses itself; left out.", "Repair the ring.", 3}),
              "SB203 warning (3 of these): d.json: #/CityObjects/b: ring crosses itself; left out. Repair the ring.");
}

}  // namespace
}  // namespace skybake
