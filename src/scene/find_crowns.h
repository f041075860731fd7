// Which objects of a scene are crowns, and how much they dim.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace skybake {

class FindingLog;

/// See build_scene. Throws nothing; the transmissivity must lie between 0 and 1.
std::vector<Crown> find_crowns(const Scene& scene, float transmissivity, FindingLog& findings);

/// For each triangle of the scene the index of its crown, or kNoCrown.
inline constexpr std::uint32_t kNoCrown = ~0u;
std::vector<std::uint32_t> crown_of_triangles(const Scene& scene);

}  // namespace skybake
