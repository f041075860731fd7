#include "base/finding.h"

#include <gtest/gtest.h>

namespace skybake {
namespace {

TEST(FindingLog, KeepsAFewAndCountsAll) {
    FindingLog log;
    for (int i = 0; i < 1000; ++i)
        log.add({"SB201", Severity::warning, "a.json: #/" + std::to_string(i), "doubled.", ""});
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

TEST(FindingLog, ListsTheSameInAnyOrderAndJoinsEqualOnes) {
    const auto make = [](int i) {
        return Finding{"SB214", Severity::info, "a.json: #/" + std::to_string(i % 50), "overlap.", ""};
    };
    FindingLog forward, backward, half, other_half;
    for (int i = 0; i < 100; ++i) forward.add(make(i));
    for (int i = 99; i >= 0; --i) backward.add(make(i));
    for (int i = 0; i < 100; ++i) (i % 3 ? half : other_half).add(make(i));
    half.merge(other_half);
    const std::vector<Finding> list = forward.list();
    ASSERT_EQ(list.size(), FindingLog::kKeptPerCode);
    EXPECT_EQ(list[1].count, 2u);
    for (const FindingLog* log : {&backward, &half}) {
        const std::vector<Finding> other = log->list();
        ASSERT_EQ(other.size(), list.size());
        for (std::size_t i = 0; i < list.size(); ++i) {
            EXPECT_EQ(other[i].where, list[i].where);
            EXPECT_EQ(other[i].count, list[i].count);
        }
    }
}

TEST(FindingLog, TextNamesCodeSeverityPlaceFaultAndRemedy) {
    EXPECT_EQ(to_text({"SB203", Severity::warning, "d.json: #/CityObjects/b", "ring crosses itself; left out.",
                       "Repair the ring.", 3}),
              "SB203 warning (3 of these): d.json: #/CityObjects/b: ring crosses itself; left out. Repair the ring.");
}

}  // namespace
}  // namespace skybake
