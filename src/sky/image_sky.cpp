#include "sky/image_sky.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace skybake {

namespace {

constexpr double kCutRadius = 5.0 * kPi / 180.0;   // wider than the glare of common lenses
constexpr double kRingRadius = 7.5 * kPi / 180.0;  // of the surroundings
constexpr double kCutContrast = 2.0;               // over the surroundings; a clear sky's own aureole stays below

Vec3d direction_of(const SkyImage& image, int column, int row) {
    const double azimuth = 2.0 * kPi * (column + 0.5) / image.width;
    const double zenith = kPi * (row + 0.5) / image.height;
    return {std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)};
}

double solid_angle(const SkyImage& image, int row) {
    return 2.0 * kPi / image.width * (std::cos(kPi * row / image.height) - std::cos(kPi * (row + 1) / image.height));
}

const Rgb& pixel(const SkyImage& image, int column, int row) {
    return image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(column)];
}

/// Calls visit(index, row, angle) for each pixel of the sky within `radius` of `centre`.
template <typename Visit>
void for_pixels_within(const SkyImage& image, const Vec3d& centre, double radius, const Visit& visit) {
    const double zenith = std::acos(std::clamp(centre.z, -1.0, 1.0));
    const int first = std::max(0, static_cast<int>((zenith - radius) / kPi * image.height));
    const int last = std::min(image.sky_rows() - 1, static_cast<int>((zenith + radius) / kPi * image.height));
    for (int row = first; row <= last; ++row) {
        for (int column = 0; column < image.width; ++column) {
            const double angle = std::acos(std::clamp(glm::dot(direction_of(image, column, row), centre), -1.0, 1.0));
            if (angle <= radius) visit(row * static_cast<std::size_t>(image.width) + column, row, angle);
        }
    }
}

}  // namespace

Rgb sky_luminance(const ImageSky& sky, const Vec3f& direction) {
    if (direction.z < 0.0f) return Rgb(0.0f);
    const SkyImage& image = *sky.image;
    const double azimuth = std::atan2(static_cast<double>(direction.x), static_cast<double>(direction.y));
    const double turn = (azimuth - sky.first_azimuth_rad) / (2.0 * kPi);
    const double x = (turn - std::floor(turn)) * image.width - 0.5;
    const double zenith = std::acos(std::min(static_cast<double>(direction.z), 1.0));
    const double y = std::clamp(zenith / kPi * image.height - 0.5, 0.0, static_cast<double>(image.sky_rows() - 1));
    const int left = static_cast<int>(std::floor(x));
    const int top = std::min(static_cast<int>(y), image.sky_rows() - 1);
    const int bottom = std::min(top + 1, image.sky_rows() - 1);
    const float across = static_cast<float>(x - left);
    const float down = static_cast<float>(y - top);
    const int column = (left + image.width) % image.width;
    const int next = (column + 1) % image.width;
    return (1.0f - down) * ((1.0f - across) * pixel(image, column, top) + across * pixel(image, next, top)) +
           down * ((1.0f - across) * pixel(image, column, bottom) + across * pixel(image, next, bottom));
}

Vec3d horizontal_illuminance(const SkyImage& image) {
    Vec3d sum(0.0);
    for (int row = 0; 2 * row < image.height; ++row) {
        const double above = std::sin(kPi * row / image.height);
        const double below = std::sin(std::min(kPi * (row + 1) / image.height, kPi / 2.0));
        Vec3d of_row(0.0);
        for (int column = 0; column < image.width; ++column)
            of_row += Vec3d(pixel(image, column, std::min(row, image.sky_rows() - 1)));
        sum += of_row * (0.5 * (below * below - above * above));
    }
    return sum * (2.0 * kPi / image.width);
}

SkyImage scaled(SkyImage image, double factor) {
    for (Rgb& value : image.pixels) value *= static_cast<float>(factor);
    return image;
}

std::optional<CutSun> cut_sun(SkyImage& image) {
    SKYBAKE_CHECK_LT(0, image.sky_rows());
    const std::size_t sky_pixels = static_cast<std::size_t>(image.sky_rows()) * static_cast<std::size_t>(image.width);
    const auto brightest =
        std::max_element(image.pixels.begin(), image.pixels.begin() + static_cast<std::ptrdiff_t>(sky_pixels),
                         [](const Rgb& a, const Rgb& b) { return luminance(a) < luminance(b); });
    const int index = static_cast<int>(brightest - image.pixels.begin());
    // A sun that saturates the film is a plateau: its middle counts, not its first pixel.
    const float half = 0.5f * luminance(*brightest);
    const Vec3d peak = direction_of(image, index % image.width, index / image.width);
    Vec3d middle(0.0);
    for_pixels_within(image, peak, kRingRadius, [&](std::size_t i, int row, double) {
        if (luminance(image.pixels[i]) < half) return;
        middle += direction_of(image, static_cast<int>(i) % image.width, row) * solid_angle(image, row);
    });
    CutSun cut;
    cut.direction = glm::normalize(middle);

    Vec3d ring(0.0);
    double weight = 0.0;
    for_pixels_within(image, cut.direction, kRingRadius, [&](std::size_t i, int row, double angle) {
        if (angle <= kCutRadius) return;
        ring += Vec3d(image.pixels[i]) * solid_angle(image, row);
        weight += solid_angle(image, row);
    });
    if (!(weight > 0.0)) return std::nullopt;
    const Rgb fill(ring * (kCutContrast / weight));
    for_pixels_within(image, cut.direction, kCutRadius, [&](std::size_t i, int row, double angle) {
        Rgb& value = image.pixels[i];
        if (luminance(value) <= luminance(fill)) return;
        cut.removed_normal_lx +=
            static_cast<double>(luminance(value) - luminance(fill)) * solid_angle(image, row) * std::cos(angle);
        value = fill;
        ++cut.changed_pixels;
    });
    if (cut.changed_pixels == 0) return std::nullopt;
    return cut;
}

}  // namespace skybake
