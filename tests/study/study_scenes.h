// Scenes whose sun and sky are known by hand, and the scenes' samples.
#pragma once

#include <cmath>

#include "bake/scenes.h"
#include "sky/solar_position.h"
#include "study/receivers.h"

namespace skybake {

/// Graz, its sea of roofs taken off.
inline Site graz() {
    return {radians_from_degrees(47.07), radians_from_degrees(15.44), 0.0};
}

inline Sample sample_at(const Vec3d& position, const Vec3f& normal) {
    Sample sample;
    sample.position = position;
    sample.normal = normal;
    return sample;
}

/// A screen about the origin, 8 km high and 10 to 11 m away, that hides the azimuths from `begin` clockwise to `end`
/// (radians) up to 89.9°, and reaches 20 m below.
inline void add_screen(QuadScene& scene, double begin, double end) {
    const int parts = std::max(1, static_cast<int>(std::ceil((end - begin) / radians_from_degrees(20.0))));
    for (int i = 0; i < parts; ++i) {
        const double a = begin + (end - begin) * i / parts, b = begin + (end - begin) * (i + 1) / parts;
        const auto at = [](double azimuth, float z) {
            return Vec3f(static_cast<float>(10.0 * std::sin(azimuth)), static_cast<float>(10.0 * std::cos(azimuth)), z);
        };
        scene.quad(at(b, -20), at(a, -20), at(a, 8000), at(b, 8000));
    }
}

/// The set of one free point at the origin that looks up (or along `normal`).
inline ReceiverSet point_at_origin(const Vec3f& normal = {0, 0, 1}, const Vec3d& at = Vec3d(0.0)) {
    ReceiverSet set;
    set.samples.push_back(sample_at(at, normal));
    Receiver receiver;
    receiver.id = "p";
    receiver.sample_end = 1;
    set.receivers.push_back(receiver);
    return set;
}

}  // namespace skybake
