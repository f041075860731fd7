// How much a file may become by naming its shapes again and again: templates, implicit geometries, instances.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace skybake::io {

/// Corners that shapes of one file may have together. A file that states each corner once never reaches the limit; one
/// of a few kilobytes that repeats a shape a million times does, before it fills the memory. Thread-safe.
class CornerBudget {
  public:
    /// `name` is what errors call the file, `bytes` its size.
    CornerBudget(std::string name, std::uint64_t bytes) : name_(std::move(name)), most_(kFree + 4 * bytes) {}

    /// Takes so many more. Throws InputError when they are too many.
    void take(std::uint64_t corners) {
        if (taken_.fetch_add(corners, std::memory_order_relaxed) + corners > most_) fail();
    }

  private:
    /// For repeated shapes, such as a forest of 10,000 trees with 5,000 corners each: about 3 GB as a city. What is
    /// stated takes more than a byte a corner in every format but Draco's, where it is two triangles and less.
    static constexpr std::uint64_t kFree = 50'000'000;

    [[noreturn]] void fail() const;

    std::string name_;
    std::uint64_t most_;
    std::atomic<std::uint64_t> taken_{0};
};

}  // namespace skybake::io
