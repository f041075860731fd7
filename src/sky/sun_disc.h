// Directions to the sun's disc.
#pragma once

#include <vector>

#include "base/vec.h"
#include "sky/daylight.h"

namespace skybake {

/// `count` unit directions evenly over the solid angle of the disc (a spiral by area, angles by van der Corput's
/// sequence); the centre alone for count 1.
std::vector<Vec3f> sun_disc_directions(const SunBeam& sun, int count);

}  // namespace skybake
