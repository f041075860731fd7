#include "sky/sky_panorama.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sky/solar_position.h"
#include "sky/sun_disc.h"

namespace skybake {

namespace {

/// Points a pixel's edge: a picture's own sun is smaller than a pixel of ours, so its light is spread over the pixel
/// instead of hit or missed.
int samples_of(const SkyModel& sky, int for_pictures) {
    return std::holds_alternative<ImageSky>(sky) ? for_pictures : 1;
}

/// Row by row; `luminance_at(x, y)` at a place in pixels, averaged over samples² points of each pixel.
template <typename Luminance>
std::vector<Rgb> picture_of(int width, int height, int samples, const Luminance& luminance_at) {
    std::vector<Rgb> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    tbb::parallel_for(0, height, [&](int row) {
        for (int column = 0; column < width; ++column) {
            Rgb sum(0.0f);
            for (int i = 0; i < samples * samples; ++i)
                sum += luminance_at(column + (i % samples + 0.5) / samples, row + (i / samples + 0.5) / samples);
            pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)] =
                sum / static_cast<float>(samples * samples);
        }
    });
    return pixels;
}

/// Adds the disc point by point; `pixel_of(direction)` says which pixel sees it, `solid_angle_of(pixel)` how large that
/// is.
template <typename Pixel, typename SolidAngle>
void add_sun(std::vector<Rgb>& pixels, const SunBeam& sun, const Pixel& pixel_of, const SolidAngle& solid_angle_of) {
    constexpr int kPoints = 65'536;
    if (!(luminance(sun.normal_illuminance) > 0.0f)) return;
    for (const Vec3f& direction : sun_disc_directions(sun, kPoints)) {
        if (direction.z < 0.0f) continue;
        const std::size_t pixel = pixel_of(Vec3d(direction));
        pixels[pixel] += sun.normal_illuminance / static_cast<float>(kPoints * solid_angle_of(pixel));
    }
}

}  // namespace

std::vector<Rgb> sky_panorama(const SkyModel& sky, int width, int height) {
    SKYBAKE_CHECK_LT(0, width);
    SKYBAKE_CHECK_LT(1, height);
    return picture_of(width, height, samples_of(sky, 8), [&](double x, double y) {
        const double zenith = std::clamp((y - 0.5) / (height - 1), 0.0, 1.0) * kPi / 2.0;
        Vec3d direction = world_direction(2.0 * kPi * x / width, kPi / 2.0 - zenith, 0.0);
        direction.z = std::max(direction.z, 0.0);
        return sky_luminance(sky, Vec3f(direction));
    });
}

std::vector<Rgb> equirectangular(const Daylight& daylight, int width) {
    SKYBAKE_CHECK_LT(1, width);
    const int height = width / 2;
    const Rgb land = land_luminance(daylight);
    std::vector<Rgb> pixels = picture_of(width, height, samples_of(daylight.sky, 4), [&](double x, double y) {
        const Vec3d direction = world_direction(2.0 * kPi * x / width, kPi * (0.5 - y / height), 0.0);
        return direction.z < 0.0 ? land : sky_luminance(daylight.sky, Vec3f(direction));
    });
    const auto pixel_of = [&](const Vec3d& direction) {
        const double azimuth = std::atan2(direction.x, direction.y) / (2.0 * kPi);
        const double zenith = std::acos(std::clamp(direction.z, -1.0, 1.0)) / kPi;
        const int column = std::clamp(static_cast<int>((azimuth - std::floor(azimuth)) * width), 0, width - 1);
        const int row = std::clamp(static_cast<int>(zenith * height), 0, height - 1);
        return static_cast<std::size_t>(row * width + column);
    };
    add_sun(pixels, daylight.sun, pixel_of, [&](std::size_t pixel) {
        const double row = std::floor(static_cast<double>(pixel) / width);
        return 2.0 * kPi / width * (std::cos(kPi * row / height) - std::cos(kPi * (row + 1.0) / height));
    });
    return pixels;
}

std::vector<Rgb> fisheye(const Daylight& daylight, int width) {
    SKYBAKE_CHECK_LT(1, width);
    std::vector<Rgb> pixels = picture_of(width, width, samples_of(daylight.sky, 4), [&](double x, double y) {
        const double right = 2.0 * x / width - 1.0;
        const double up = 1.0 - 2.0 * y / width;
        const double radius = std::hypot(right, up);
        if (radius > 1.0) return Rgb(0.0f);
        Vec3d direction = world_direction(std::atan2(-right, up), kPi / 2.0 * (1.0 - radius), 0.0);
        direction.z = std::max(direction.z, 0.0);
        return sky_luminance(daylight.sky, Vec3f(direction));
    });
    const auto pixel_of = [&](const Vec3d& direction) {
        const double horizontal = std::max(std::hypot(direction.x, direction.y), 1e-12);
        const double radius = std::acos(std::clamp(direction.z, 0.0, 1.0)) / (kPi / 2.0);
        const int column = static_cast<int>((1.0 - radius * direction.x / horizontal) / 2.0 * width);
        const int row = static_cast<int>((1.0 - radius * direction.y / horizontal) / 2.0 * width);
        return static_cast<std::size_t>(std::clamp(row, 0, width - 1) * width + std::clamp(column, 0, width - 1));
    };
    add_sun(pixels, daylight.sun, pixel_of, [&](std::size_t pixel) {
        // dω = sin z dz dφ, and the picture's radius is z.
        const double x = static_cast<double>(pixel % static_cast<std::size_t>(width)) + 0.5 - 0.5 * width;
        const double y = static_cast<double>(pixel / static_cast<std::size_t>(width)) + 0.5 - 0.5 * width;
        const double zenith = std::hypot(x, y) * kPi / width;
        const double edge = kPi / width;
        return edge * edge * (zenith > 0.0 ? std::sin(zenith) / zenith : 1.0);
    });
    return pixels;
}

}  // namespace skybake
