// What stands where, as seen from straight above: the ground of a study's maps.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"
#include "trace/ray_scene.h"

namespace skybake {

/// Square pixels over a rectangle of map coordinates, row 0 in the north.
struct PlanView {
    static constexpr std::uint32_t kNothing = 0xffffffffu;

    Vec2d lo{0.0};  // map coordinates of the south-west corner
    double pixel_m = 1.0;
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> object;  // width × height: index of the topmost object into Scene::objects, or kNothing

    Vec2d hi() const { return lo + pixel_m * Vec2d(width, height); }
    /// The index of the pixel that holds a point; none outside.
    std::optional<std::size_t> pixel_of(const Vec2d& p) const;
};

/// The view of lo…hi with `pixels` along the longer side. Parallel; the same for any number of threads.
PlanView plan_view(const Scene& scene, const RayScene& rays, const Vec2d& lo, const Vec2d& hi, int pixels);

}  // namespace skybake
