// Which side of a surface is the outside, where no closed shell tells. Private to the folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "city/city_model.h"

namespace skybake::repair_steps {

/// Counts how often rays from a surface cross all surfaces of its object: what faces outside is left by an even number
/// of crossings, what faces into the body by an odd one. This holds for niches, which face each other, and wherever the
/// body is nearly closed.
class OutsideTest {
  public:
    explicit OutsideTest(const Geometry& geometry);

    /// 1 when the surface, as it runs, faces outside, -1 when it faces inside, 0 when both sides look alike. Linear in
    /// the triangles of the object.
    int side_of(std::uint32_t surface) const;
    std::size_t triangle_count() const { return triangles_.size(); }

  private:
    bool is_even(const Vec3d& origin, const Vec3d& direction, std::uint32_t surface) const;

    struct Triangle {
        Vec3d a, ab, ac;
        std::uint32_t surface = 0;
    };
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> largest_;  // triangle of each surface; as many as triangles_ where it has none
};

}  // namespace skybake::repair_steps
