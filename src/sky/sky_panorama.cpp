#include "sky/sky_panorama.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sky/solar_position.h"

namespace skybake {

std::vector<Rgb> sky_panorama(const SkyModel& sky, int width, int height) {
    SKYBAKE_CHECK_LT(0, width);
    SKYBAKE_CHECK_LT(1, height);
    std::vector<Rgb> pixels;
    pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int row = 0; row < height; ++row) {
        const double elevation = kPi / 2.0 * (1.0 - static_cast<double>(row) / (height - 1));
        for (int column = 0; column < width; ++column) {
            Vec3d direction = world_direction(2.0 * kPi * (column + 0.5) / width, elevation, 0.0);
            direction.z = std::max(direction.z, 0.0);
            pixels.push_back(sky_luminance(sky, Vec3f(direction)));
        }
    }
    return pixels;
}

}  // namespace skybake
