#include "study/new_shadow.h"

#include <algorithm>

namespace skybake {

std::vector<SunInterval> lost_sun(std::span<const SunInterval> before, std::span<const SunInterval> after) {
    std::vector<SunInterval> lost;
    std::size_t next = 0;
    for (const SunInterval& sunny : before) {
        float from = sunny.begin_s;
        while (next < after.size() && after[next].end_s <= sunny.begin_s) ++next;
        for (std::size_t k = next; k < after.size() && after[k].begin_s < sunny.end_s; ++k) {
            if (after[k].begin_s > from) lost.push_back({from, after[k].begin_s});
            from = std::max(from, after[k].end_s);
        }
        if (from < sunny.end_s) lost.push_back({from, sunny.end_s});
    }
    return lost;
}

std::vector<SunInterval> united(std::vector<SunInterval> intervals) {
    std::sort(intervals.begin(), intervals.end(),
              [](const SunInterval& a, const SunInterval& b) { return a.begin_s < b.begin_s; });
    std::vector<SunInterval> all;
    for (const SunInterval& interval : intervals) {
        if (!all.empty() && interval.begin_s <= all.back().end_s) {
            all.back().end_s = std::max(all.back().end_s, interval.end_s);
        } else {
            all.push_back(interval);
        }
    }
    return all;
}

std::vector<NewShadow> new_shadows(const ReceiverSet& receivers, std::uint32_t day, const SunIntervals& before,
                                   const SunIntervals& after, double least_s) {
    std::vector<NewShadow> shadows;
    for (std::uint32_t r = 0; r < receivers.receivers.size(); ++r) {
        const Receiver& receiver = receivers.receivers[r];
        NewShadow shadow{r, day, {}, 0.0, 0.0, 0.0};
        std::vector<SunInterval> all;
        std::uint32_t losers = 0;
        for (std::uint32_t s = receiver.sample_begin; s < receiver.sample_end; ++s) {
            double seconds = 0.0;
            std::vector<SunInterval> lost = lost_sun(before.of(s), after.of(s));
            std::erase_if(lost,
                          [&](const SunInterval& i) { return static_cast<double>(i.end_s - i.begin_s) < least_s; });
            for (const SunInterval& i : lost) seconds += static_cast<double>(i.end_s - i.begin_s);
            if (lost.empty()) continue;
            ++losers;
            shadow.longest_sample_min = std::max(shadow.longest_sample_min, seconds / 60.0);
            all.insert(all.end(), lost.begin(), lost.end());
            if (all.size() > 100'000) all = united(std::move(all));
        }
        if (losers == 0) continue;
        shadow.episodes = united(std::move(all));
        for (const SunInterval& i : shadow.episodes)
            shadow.total_min += static_cast<double>(i.end_s - i.begin_s) / 60.0;
        shadow.area_share = static_cast<double>(losers) / (receiver.sample_end - receiver.sample_begin);
        shadows.push_back(std::move(shadow));
    }
    return shadows;
}

}  // namespace skybake
