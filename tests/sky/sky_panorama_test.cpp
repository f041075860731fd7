#include "sky/sky_panorama.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sky/daylight_settings.h"

namespace skybake {
namespace {

Daylight day_of(const char* sky, double azimuth_deg, double elevation_deg, SunShape shape = SunShape::point) {
    FindingLog unheard;
    DaylightSettings settings;
    settings.sky = parse_sky(sky);
    settings.sun = shape;
    settings.sun_direction = SunDirection{radians_from_degrees(azimuth_deg), radians_from_degrees(elevation_deg)};
    return make_daylights(settings, std::nullopt, 0.0, unheard).at(0);
}

/// Solid angle and direction of a pixel's middle.
struct PixelView {
    double solid_angle = 0.0;  // 0 outside of the picture
    Vec3d direction{0.0};
};

PixelView equirectangular_pixel(int width, int column, int row) {
    const int height = width / 2;
    const double top = kPi * row / height;
    const double below = kPi * (row + 1) / height;
    const double zenith = 0.5 * (top + below);
    const double azimuth = 2.0 * kPi * (column + 0.5) / width;
    return {2.0 * kPi / width * (std::cos(top) - std::cos(below)),
            {std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)}};
}

PixelView fisheye_pixel(int width, int column, int row) {
    const double right = 2.0 * (column + 0.5) / width - 1.0;
    const double up = 1.0 - 2.0 * (row + 0.5) / width;
    const double zenith = kPi / 2.0 * std::hypot(right, up);
    if (zenith > kPi / 2.0) return {};
    const double azimuth = std::atan2(-right, up);
    // By finite differences of the map, so that its Jacobian is not taken on trust.
    const double step = 1e-4;
    const auto direction = [&](double x, double y) {
        const double z = kPi / 2.0 * std::hypot(x, y);
        const double a = std::atan2(-x, y);
        return Vec3d(std::sin(z) * std::sin(a), std::sin(z) * std::cos(a), std::cos(z));
    };
    const Vec3d dx = (direction(right + step, up) - direction(right - step, up)) / (2.0 * step);
    const Vec3d dy = (direction(right, up + step) - direction(right, up - step)) / (2.0 * step);
    return {glm::length(glm::cross(dx, dy)) * 4.0 / (width * width),
            {std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)}};
}

/// Illuminance of a plane that faces the sun by what the picture has more than without the sun, all of it within 1.5°
/// and two pixels; lx.
template <typename Picture, typename Pixel>
double disc_illuminance(const Picture& picture, const Pixel& pixel_view, const Daylight& day, int width, int height) {
    Daylight without = day;
    without.sun.shape = SunShape::none;
    without.sun.normal_illuminance = Rgb(0.0f);
    const std::vector<Rgb> with_sun = picture(day, width);
    const double nearest = std::cos(radians_from_degrees(1.5) + 4.0 * kPi / width);
    const std::vector<Rgb> sky_alone = picture(without, width);
    double sum = 0.0;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const std::size_t i = static_cast<std::size_t>(row * width + column);
            if (with_sun[i] == sky_alone[i]) continue;
            const PixelView view = pixel_view(width, column, row);
            if (view.direction.z < 0.0) continue;  // the land, which the sun lights
            EXPECT_GT(glm::dot(view.direction, Vec3d(day.sun.direction)), nearest);
            sum += view.solid_angle * static_cast<double>(luminance(with_sun[i] - sky_alone[i]));
        }
    }
    return sum;
}

// Truth: the beam. The disc's radiance over its solid angle is what a plane that faces the sun gets, to 1 %, at any
// width and place.
TEST(SkyPanorama, DiscGivesTheBeam) {
    for (const auto& [azimuth, elevation] :
         {std::pair{180.0, 45.0}, {0.05, 60.0}, {359.9, 20.0}, {77.7, 3.0}, {123.0, 89.9}}) {
        const Daylight day = day_of("uniform:luminance=3000", azimuth, elevation);
        const double beam = static_cast<double>(luminance(day.sun.normal_illuminance));
        for (const int width : {64, 512, 2048}) {
            EXPECT_NEAR(disc_illuminance(equirectangular, equirectangular_pixel, day, width, width / 2), beam,
                        0.01 * beam)
                << width << ' ' << elevation;
            EXPECT_NEAR(disc_illuminance(fisheye, fisheye_pixel, day, width, width), beam, 0.01 * beam)
                << width << ' ' << elevation;
        }
    }
}

// Truth: 0.533° across, so 12.0 pixels of a picture 8192 wide; E / Ω in its middle, within the grain of its points.
TEST(SkyPanorama, DiscIsSmallAndEven) {
    constexpr int kWidth = 8192;
    const Daylight day = day_of("uniform:luminance=3000", 180.0, 30.0);
    const std::vector<Rgb> pixels = equirectangular(day, kWidth);
    const double radius = static_cast<double>(day.sun.angular_radius_rad);
    const double expected = static_cast<double>(luminance(day.sun.normal_illuminance)) / (kPi * radius * radius);
    const int row = kWidth / 2 / 3;  // 30° up
    int lit = 0;
    for (int r = row - 20; r < row + 20; ++r)
        lit += luminance(pixels[static_cast<std::size_t>(r * kWidth + kWidth / 2)]) > 0.5 * expected;
    EXPECT_NEAR(lit, 2.0 * radius / (2.0 * kPi / kWidth), 1.5);
    for (int d = -3; d <= 3; ++d)
        EXPECT_NEAR(luminance(pixels[static_cast<std::size_t>(row * kWidth + kWidth / 2 + d)]), expected,
                    0.1 * expected);
}

// Truth: no beam, no disc: asked for, behind clouds, below the horizon. And --sun none changes nothing of the sky.
TEST(SkyPanorama, NoDiscWithoutABeam) {
    for (const Daylight& day : {day_of("preetham:turbidity=3", 180.0, 30.0, SunShape::none),
                                day_of("cie1994:overcast", 180.0, 30.0), day_of("preetham:turbidity=3", 180.0, -1.0)}) {
        float brightest = 0.0f;
        for (const Rgb& pixel : equirectangular(day, 256)) brightest = std::max(brightest, luminance(pixel));
        EXPECT_LT(brightest, 1e6f);
    }
}

// Truth: Lambert. The lower half is albedo E / π of the same daylight, from the first row below the horizon on.
TEST(SkyPanorama, LandReflectsItsLight) {
    const Daylight day = day_of("preetham:turbidity=3", 180.0, 30.0);
    const std::vector<Rgb> pixels = equirectangular(day, 128);
    const Rgb horizontal = horizontal_diffuse(day.sky).illuminance + 0.5f * day.sun.normal_illuminance;
    EXPECT_NEAR(luminance(kLandAlbedo), 0.2f, 1e-3f);
    for (const std::size_t i : {std::size_t{32 * 128}, std::size_t{40 * 128 + 77}, pixels.size() - 1}) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(pixels[i][c], kLandAlbedo[c] * horizontal[c] / static_cast<float>(kPi), 1e-3f * pixels[i][c]);
    }
}

}  // namespace
}  // namespace skybake
