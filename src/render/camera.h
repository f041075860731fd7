// Where a picture is taken from: one ray for each place in it.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace skybake {

enum class Projection : std::uint8_t { perspective, orthographic, panorama };

/// A picture's frame in the world (z up). Made by the functions below.
struct Camera {
    Projection projection = Projection::perspective;
    Vec3f position{0.0f};  // the eye; of an orthographic picture, the middle of a plane before the whole city
    Vec3f right{1.0f, 0.0f, 0.0f}, up{0.0f, 0.0f, 1.0f}, forward{0.0f, 1.0f, 0.0f};  // unit, at right angles
    Vec2f half_extent{1.0f};  // perspective: tangents of half the angles; orthographic: metres; panorama: unused
};

/// What a place in the picture looks along. Directions are unit.
struct CameraRay {
    Vec3f origin{0.0f};
    Vec3f direction{0.0f, 1.0f, 0.0f};
};

/// Level horizon, from `position` towards `target`; straight up or down, north is the picture's upper edge. `fov_rad`
/// is the whole vertical angle, in (0, π); `size` in pixels gives the ratio of the sides.
Camera perspective_camera(const Vec3f& position, const Vec3f& target, float fov_rad, const Vec2i& size);

/// Parallel rays from `position` towards `target`, which is the picture's middle; `width_m` metres wide. The picture
/// begins `reach_m` metres before the target: at least as far as the city reaches.
Camera orthographic_camera(const Vec3f& position, const Vec3f& target, float width_m, float reach_m, const Vec2i& size);

/// The whole sphere about `position`, equirectangular: the column in the middle looks towards `target`, the row in the
/// middle at the horizon, the first row at the zenith.
Camera panorama_camera(const Vec3f& position, const Vec3f& target);

/// The ray through `place`: pixels from the upper left corner, so that a pixel's centre is at (column + ½, row + ½).
CameraRay camera_ray(const Camera& camera, const Vec2f& place, const Vec2i& size);

}  // namespace skybake
