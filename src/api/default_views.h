// Where the walkthrough starts.
#pragma once

#include <vector>

#include "bake/lightmap.h"
#include "io/manifest/write_bake.h"
#include "trace/ray_scene.h"

namespace skybake {

/// A bird's-eye view of the whole city from the south-west, and, where there is ground to stand on, a view along the
/// street nearest to the city's centre, from eye height (1.7 m).
std::vector<io::BakeView> default_views(const Scene& scene, const Atlas& atlas, const Lightmaps& light,
                                        const RayScene& rays);

}  // namespace skybake
