#include "study/obstruction.h"

#include "sky/solar_position.h"

namespace skybake {

Obstruction obstruction_of(const Sample& sample, const Vec3d& scene_origin, const RayScene& rays,
                           double convergence_rad) {
    Obstruction dome;
    const Vec3f origin = Vec3f(sample.position - scene_origin) + rays.surface_offset() * sample.normal;
    for (int a = 0; a < Obstruction::kAzimuths; ++a) {
        for (int e = 0; e < Obstruction::kElevations; ++e) {
            const double azimuth = 2.0 * kPi * (a + 0.5) / Obstruction::kAzimuths;
            const double elevation = 0.5 * kPi * (e + 0.5) / Obstruction::kElevations;
            const Vec3f direction(world_direction(azimuth, elevation, convergence_rad));
            const bool is_behind = glm::dot(direction, sample.normal) <= 0.0f;
            dome.cells.push_back(is_behind                             ? Obstruction::Cell::behind
                                 : rays.is_occluded(origin, direction) ? Obstruction::Cell::hidden
                                                                       : Obstruction::Cell::free);
        }
    }
    return dome;
}

}  // namespace skybake
