// How high obstructions stand before a façade.
#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "study/receivers.h"
#include "trace/ray_scene.h"

namespace skybake {

struct LightIncidence {
    std::vector<float> angle_deg;  // 0…90
    std::uint64_t rays = 0;
};

/// The lowest elevation from which on, in a vertical plane across the surface that may be turned sideways by up to
/// `swivel_deg`, all of the sky is free: the angle of free light incidence. In steps of 1° of elevation, upwards: a
/// free horizon gives 0, an endless obstruction of 45° gives 45 or 46. For level surfaces the plane faces all
/// directions. Turned in steps of 5°. Parallel; the same for any number of threads.
LightIncidence light_incidence(std::span<const Sample> samples, const Vec3d& scene_origin, const RayScene& rays,
                               double swivel_deg, Progress& progress);

}  // namespace skybake
