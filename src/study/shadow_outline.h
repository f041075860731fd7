// The outline of the shadow on the ground at an instant.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "study/receivers.h"
#include "study/study.h"

namespace skybake {

/// Even-odd rule over all rings; shadow lies to their left, so outer rings run counter-clockwise and holes clockwise.
struct ShadowOutline {
    std::vector<std::vector<Vec2d>> rings;  // map coordinates; not closed
    double area_m2 = 0.0;
};

/// The ground of a scene, with the nodes of a lattice on it, `height_m` above.
class ShadowGround {
  public:
    /// `spacing_m` between the nodes over all of the scene's ground.
    ShadowGround(const Scene& scene, double spacing_m, double height_m);

    /// Where the ground is in the shadow of `city` and, when `before` is given, was not in the shadow of that. Also
    /// under bodies: a house stands in its own shadow. Empty without ground. The outline runs through the edges of the
    /// lattice at 1 cm; between them corners are cut, and what is thinner than the spacing may be missed. Parallel; the
    /// same for any number of threads.
    ShadowOutline outline(const StudyCity& city, const std::optional<StudyCity>& before,
                          const Vec3f& sun_direction) const;

  private:
    friend class OutlineTracer;
    GroundHeights ground_;
    double spacing_m_;
    double height_m_;
};

/// A ring without the vertices that lie within `tolerance_m` of the line through those that stay. Based on: Douglas &
/// Peucker, "Algorithms for the reduction of the number of points…", 1973.
std::vector<Vec2d> simplified(std::span<const Vec2d> ring, double tolerance_m);

}  // namespace skybake
