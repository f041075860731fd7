// Colours in steps, for maps whose legend tells each class.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace skybake::io {

using Rgb8 = std::array<std::uint8_t, 3>;
std::string hex_of(const Rgb8& colour);  // "#rrggbb"

/// 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double least);

struct SteppedScale {
    std::vector<double> edges;    // ascending; one more than there are classes
    std::vector<Rgb8> colours;    // one a class
    std::vector<char> is_marked;  // one an edge: a rule's threshold

    /// The class of a value: from its lower edge on; the first and the last take all beyond.
    std::size_t class_of(double value) const;
};

/// Six to ten classes of a round width over least…greatest, viridis from dark to light. `thresholds` within the range
/// are edges, too; a round edge that comes too close to one makes way for it.
SteppedScale stepped_scale(double least, double greatest, const std::vector<double>& thresholds);

/// Classes of differences about 0, brown for losses over white to blue for gains; within ±`least_change` white.
SteppedScale difference_scale(double most, double least_change);

}  // namespace skybake::io
