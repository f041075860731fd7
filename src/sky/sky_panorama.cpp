#include "sky/sky_panorama.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sky/solar_position.h"

namespace skybake {

std::vector<Rgb> sky_panorama(const SkyModel& sky, int width, int height) {
    SKYBAKE_CHECK_LT(0, width);
    SKYBAKE_CHECK_LT(1, height);
    // The sun of a picture is smaller than a pixel of ours: its light is spread over the pixel instead of hit or
    // missed.
    const int samples = std::holds_alternative<ImageSky>(sky) ? 8 : 1;
    std::vector<Rgb> pixels;
    pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            Rgb sum(0.0f);
            for (int i = 0; i < samples * samples; ++i) {
                const double across = (i % samples + 0.5) / samples;
                const double down = (i / samples + 0.5) / samples - 0.5;
                const double elevation = kPi / 2.0 * (1.0 - std::clamp((row + down) / (height - 1), 0.0, 1.0));
                Vec3d direction = world_direction(2.0 * kPi * (column + across) / width, elevation, 0.0);
                direction.z = std::max(direction.z, 0.0);
                sum += sky_luminance(sky, Vec3f(direction));
            }
            pixels.push_back(sum / static_cast<float>(samples * samples));
        }
    }
    return pixels;
}

}  // namespace skybake
