// What a plan takes away: sun that was there before and is not there after.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "study/receivers.h"
#include "study/sun_intervals.h"

namespace skybake {

/// The parts of `before` that are not in `after`; both ascending and apart, as is the result.
std::vector<SunInterval> lost_sun(std::span<const SunInterval> before, std::span<const SunInterval> after);

/// Intervals of several samples as one list of times at which any of them holds.
std::vector<SunInterval> united(std::vector<SunInterval> intervals);

/// New shadow on one receiver on one day.
struct NewShadow {
    std::uint32_t receiver = 0;
    std::uint32_t day = 0;              // index into the rule's days
    std::vector<SunInterval> episodes;  // when any part of the receiver is in new shadow, seconds after the day's begin
    double total_min = 0.0;             // sum of the episodes
    double longest_sample_min = 0.0;    // of the sample that loses most
    double area_share = 0.0;            // of samples that lose any
};

/// For the receivers that lose sun for at least `least_s` on some sample; shorter losses are the crossings' own error.
std::vector<NewShadow> new_shadows(const ReceiverSet& receivers, std::uint32_t day, const SunIntervals& before,
                                   const SunIntervals& after, double least_s = 2.0);

}  // namespace skybake
