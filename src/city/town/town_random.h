// Draws of the town: each is a hash of (seed, thing, purpose), so that adding a house changes no other.
#pragma once

#include <cstdint>

#include "base/hash_rng.h"

namespace skybake::town {

/// Uniform in [lo, hi).
inline double draw(std::uint64_t seed, std::uint64_t thing, std::uint64_t purpose, double lo = 0.0, double hi = 1.0) {
    return lo + (hi - lo) * static_cast<double>(uniform_float(seed, thing, purpose, 0));
}

/// Uniform in 0 … count - 1.
inline int draw_index(std::uint64_t seed, std::uint64_t thing, std::uint64_t purpose, int count) {
    return static_cast<int>(draw(seed, thing, purpose) * count);
}

}  // namespace skybake::town
