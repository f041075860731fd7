// What hides the sky of one place: for sun-path diagrams.
#pragma once

#include <cstdint>
#include <vector>

#include "study/receivers.h"
#include "trace/ray_scene.h"

namespace skybake {

/// The dome as cells of 2° of azimuth and 1° of elevation.
struct Obstruction {
    static constexpr int kAzimuths = 180;
    static constexpr int kElevations = 90;
    enum class Cell : std::uint8_t { free, hidden, behind };  // `behind`: below the surface's own plane
    std::vector<Cell> cells;  // kAzimuths × kElevations, by azimuth clockwise from true north, then elevation

    Cell at(int azimuth, int elevation) const { return cells[azimuth * kElevations + elevation]; }
};

/// A ray through the middle of each cell of the dome. `convergence_rad` turns true north into the scene's frame.
Obstruction obstruction_of(const Sample& sample, const Vec3d& scene_origin, const RayScene& rays,
                           double convergence_rad);

}  // namespace skybake
