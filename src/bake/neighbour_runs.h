// Points sorted into short runs of neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace skybake {

/// Chosen points, halved at their longest side until no run is longer than a given length.
class NeighbourRuns {
  public:
    /// `chosen`: indices into the points; `longest`: points a run, at least 1. Points at one place stay in the order of
    /// their indices.
    NeighbourRuns(std::span<const Vec3f> points, std::span<const std::uint32_t> chosen, std::size_t longest);

    std::size_t size() const { return begin_.size() - 1; }
    /// Indices into the points.
    std::span<const std::uint32_t> operator[](std::size_t run) const {
        return std::span(order_).subspan(begin_[run], begin_[run + 1] - begin_[run]);
    }

  private:
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> begin_;
};

}  // namespace skybake
