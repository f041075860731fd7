// Random numbers without state: a hash of (seed, stable id, sample, dimension), so that no result hangs on thread or
// order.
#pragma once

#include <cstdint>
#include <string_view>

namespace skybake {

/// Mixes 64 bits so that each output bit depends on each input bit. Based on: Steele, Lea & Flood, "Fast splittable
/// pseudorandom number generators", 2014 (the SplitMix64 finaliser with the constants of Stafford's variant 13).
constexpr std::uint64_t mix64(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ULL;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

constexpr std::uint64_t hash_combine(std::uint64_t a, std::uint64_t b) {
    return mix64(a + 0x9e3779b97f4a7c15ULL + mix64(b));
}

/// FNV-1a of the bytes, mixed: the stable id of an object from its name.
constexpr std::uint64_t hash_of(std::string_view text) {
    std::uint64_t h = 0xcbf29ce484222325ULL;
    for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    return mix64(h);
}

/// Uniform in [0, 1), 24 bits: the same value for the same four arguments, everywhere.
constexpr float uniform_float(std::uint64_t seed, std::uint64_t id, std::uint64_t sample, std::uint64_t dimension) {
    const std::uint64_t h = hash_combine(hash_combine(hash_combine(seed, id), sample), dimension);
    return static_cast<float>(h >> 40) * 0x1p-24f;
}

/// The values uniform_float(seed, id, sample, 0), (…, 1), (…, 2), … one after the other.
class RandomSequence {
  public:
    constexpr RandomSequence(std::uint64_t seed, std::uint64_t id, std::uint64_t sample)
        : base_(hash_combine(hash_combine(seed, id), sample)) {}
    constexpr float next() { return static_cast<float>(hash_combine(base_, dimension_++) >> 40) * 0x1p-24f; }

  private:
    std::uint64_t base_;
    std::uint64_t dimension_ = 0;
};

}  // namespace skybake
