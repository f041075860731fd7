// Van der Corput radical inverses, of which Halton's and Hammersley's point sets are made.
// Based on: J. H. Halton, "On the efficiency of certain quasi-random sequences of points", 1960.
#pragma once

#include <cstdint>

namespace skybake {

/// The digits of `index` in `base` mirrored about the point; in [0, 1).
constexpr double radical_inverse(std::uint32_t base, std::uint32_t index) {
    double inverse = 0.0;
    double digit_value = 1.0 / base;
    for (; index > 0; index /= base, digit_value /= base) inverse += digit_value * (index % base);
    return inverse;
}

}  // namespace skybake
