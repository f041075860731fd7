// Everything that shines at one instant.
#pragma once

#include <vector>

#include "light/lamp.h"
#include "sky/daylight.h"

namespace skybake {

struct LightSources {
    Daylight daylight;
    std::vector<Lamp> lamps;
};

inline bool has_beam(const SunBeam& sun) {
    return sun.shape != SunShape::none && luminance(sun.normal_illuminance) > 0.0f;
}

/// Direction to a point of the sun for u, v in [0, 1): evenly over the disc, or the centre for SunShape::point.
Vec3f sample_sun(const SunBeam& sun, float u, float v);

}  // namespace skybake
