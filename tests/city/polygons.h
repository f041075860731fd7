// Small geometries for the tests of the city.
#pragma once

#include <vector>

#include "city/city_model.h"

namespace skybake {

/// Appends a polygon of the given rings (outer first) as a surface and returns the surface's index. Vertices are not
/// shared.
inline std::size_t add_polygon(Geometry& geometry, const std::vector<std::vector<Vec3d>>& rings) {
    Surface surface;
    surface.ring_begin = static_cast<std::uint32_t>(geometry.ring_first.size() - 1);
    for (const std::vector<Vec3d>& ring : rings) {
        for (const Vec3d& p : ring) {
            geometry.corners.push_back(static_cast<std::uint32_t>(geometry.vertices.size()));
            geometry.vertices.push_back(p);
        }
        geometry.ring_first.push_back(static_cast<std::uint32_t>(geometry.corners.size()));
    }
    surface.ring_end = static_cast<std::uint32_t>(geometry.ring_first.size() - 1);
    surface.source_index = static_cast<std::uint32_t>(geometry.surfaces.size());
    geometry.surfaces.push_back(surface);
    if (geometry.shells.empty()) geometry.shells.push_back({});
    geometry.shells.back().surface_end = static_cast<std::uint32_t>(geometry.surfaces.size());
    return geometry.surfaces.size() - 1;
}

}  // namespace skybake
