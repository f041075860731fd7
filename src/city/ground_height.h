// How high the ground of a city lies, and bodies put on it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/finding.h"
#include "city/city_model.h"

namespace skybake {

/// Answers where the ground of a city is. A grid over the triangles of all ground objects.
class GroundHeight {
  public:
    explicit GroundHeight(const CityModel& city);

    /// The highest ground at `place` (map coordinates); none beside it.
    std::optional<double> at(const Vec2d& place) const;

  private:
    std::size_t cell_of(double x, double y) const;

    std::vector<Vec3d> corners_;  // three a triangle
    Box2d box_;
    Vec2d cell_{1.0};
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> first_;      // of each cell in triangles_; one more than there are cells
    std::vector<std::uint32_t> triangles_;  // by cell
};

/// Moves the objects of these ids up by the lowest ground below their corners: their heights count from there. Those
/// that stand beside all ground stay (SB504).
void stand_on_ground(CityModel& city, std::span<const std::string> ids, FindingLog& findings);

}  // namespace skybake
