#include "sky/image_sky.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "api/load_sky_image.h"
#include "base/error.h"
#include "io/exr/exr.h"
#include "io/image/radiance_hdr.h"
#include "sky/daylight_settings.h"
#include "sky/sky_level.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

using ::testing::HasSubstr;

/// A sky of one colour with a ground of another.
SkyImage flat_image(int height, const Rgb& sky, const Rgb& ground) {
    SkyImage image{2 * height, height, {}};
    for (int row = 0; row < height; ++row)
        image.pixels.insert(image.pixels.end(), 2 * height, 2 * row < height ? sky : ground);
    return image;
}

Vec3f towards(double azimuth_deg, double elevation_deg) {
    return Vec3f(world_direction(radians_from_degrees(azimuth_deg), radians_from_degrees(elevation_deg), 0.0));
}

template <typename Action>
std::string refusal(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

class ImageFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("skybake-image-sky-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write_exr(const std::string& name, const SkyImage& image) const {
        io::write_exr_rgb(path(name), {image.width, image.height, image.pixels});
        return path(name);
    }
    std::string write_text(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }

  private:
    std::filesystem::path folder_;
};

// Truth: E = πL of the uniform dome; the ground's pixels lend nothing to the sky, even beside the horizon.
TEST(ImageSky, FlatPictureIsTheUniformSky) {
    for (const int height : {2, 5, 64}) {
        const SkyModel sky =
            ImageSky{std::make_shared<const SkyImage>(flat_image(height, Rgb(1000.0f), Rgb(5.0f))), 0.3};
        EXPECT_NEAR(luminance(horizontal_diffuse(sky).illuminance), 1000.0 * kPi, 0.05) << height;
        EXPECT_NEAR(luminance(sky_luminance(sky, towards(10.0, 0.01))), 1000.0, 1e-2) << height;
        EXPECT_NEAR(luminance(sky_luminance(sky, Vec3f(0.0f, 0.0f, 1.0f))), 1000.0, 1e-2);
        EXPECT_EQ(sky_luminance(sky, Vec3f(0.6f, 0.0f, -0.8f)), Rgb(0.0f));
    }
}

// Truth: the convention: columns clockwise from true north, the picture turned by `rotate` and by the grid.
TEST(ImageSky, PutsTheColumnsWhereTheConventionSays) {
    SkyImage image = flat_image(90, Rgb(1.0f), Rgb(0.0f));
    image.pixels[45 / 2 * 180 + 135 / 2] = Rgb(7.0f);  // azimuth 135°, zenith angle 45°
    const auto shared = std::make_shared<const SkyImage>(image);
    EXPECT_NEAR(sky_luminance(ImageSky{shared, 0.0}, towards(135.0, 45.0)).x, 7.0f, 0.01f);
    const ImageSettings settings{.file = "", .rotation_rad = radians_from_degrees(30.0), .image = shared};
    const SkyModel turned = sky_model(settings, {}, radians_from_degrees(10.0));
    EXPECT_NEAR(sky_luminance(turned, towards(155.0, 45.0)).x, 7.0f, 0.01f) << "135 + 30 true, 10 less in the grid";
}

// Truth: between two pixels a picture is linear, across the seam at north too.
TEST(ImageSky, IsContinuousAcrossTheSeam) {
    SkyImage image = flat_image(90, Rgb(1.0f), Rgb(0.0f));
    for (int row = 0; row < 45; ++row) image.pixels[row * 180] = Rgb(3.0f);
    const ImageSky sky{std::make_shared<const SkyImage>(image), 0.0};
    EXPECT_NEAR(sky_luminance(sky, towards(0.0, 45.0)).x, 2.0f, 1e-3f);
    EXPECT_NEAR(sky_luminance(sky, towards(359.5, 45.0)).x, 1.5f, 1e-3f);
}

// Truth: what cut_sun promises: only the disc changes, to twice its surroundings at most, and the light that is gone is
// that of the disc.
TEST(ImageSky, CutsTheSunAndNothingElse) {
    SkyImage image = flat_image(360, Rgb(1000.0f), Rgb(5.0f));
    const Vec3d sun(towards(200.25, 35.25));
    int disc_pixels = 0;
    for (int row = 0; row < 180; ++row) {
        for (int column = 0; column < 720; ++column) {
            const Vec3d view(towards((column + 0.5) / 2.0, 90.0 - (row + 0.5) / 2.0));
            if (glm::dot(view, sun) < std::cos(radians_from_degrees(3.0))) continue;
            image.pixels[row * 720 + column] = Rgb(1e6f);
            ++disc_pixels;
        }
    }
    const SkyImage before = image;
    const auto cut = cut_sun(image);
    ASSERT_TRUE(cut.has_value());
    EXPECT_GT(glm::dot(cut->direction, sun), std::cos(radians_from_degrees(0.1)));
    EXPECT_EQ(cut->changed_pixels, disc_pixels);
    // A disc of radius r has the solid angle 2π(1 − cos r).
    const double disc_lx = (1e6 - 2000.0) * 2.0 * kPi * (1.0 - std::cos(radians_from_degrees(3.0)));
    EXPECT_NEAR(cut->removed_normal_lx, disc_lx, 0.03 * disc_lx);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (image.pixels[i] == before.pixels[i]) continue;
        ASSERT_NEAR(image.pixels[i].x, 2000.0f, 0.1f);
    }
    SkyImage overcast = flat_image(60, Rgb(1000.0f), Rgb(5.0f));
    EXPECT_FALSE(cut_sun(overcast).has_value());
}

// Truth: a panorama of a sky read back is that sky.
TEST_F(ImageFiles, PanoramaComesBackAsTheSkyItWas) {
    const SkyModel preetham = preetham_sky(3.0, world_direction(2.0, radians_from_degrees(30.0), 0.0));
    SkyImage image{512, 256, {}};
    for (int row = 0; row < 256; ++row) {
        for (int column = 0; column < 512; ++column) {
            image.pixels.push_back(
                sky_luminance(preetham, towards((column + 0.5) / 512 * 360.0, 90.0 - (row + 0.5) / 256 * 180.0)));
        }
    }
    SkySettings settings = parse_sky("image:" + write_exr("sky.exr", image));
    load_sky_image(settings);
    const SkyModel sky = sky_model(settings, {}, 0.0);
    for (double elevation = 1.0; elevation < 90.0; elevation += 8.0) {
        for (double azimuth = 3.0; azimuth < 360.0; azimuth += 50.0) {
            const float expected = luminance(sky_luminance(preetham, towards(azimuth, elevation)));
            EXPECT_NEAR(luminance(sky_luminance(sky, towards(azimuth, elevation))), expected, 0.003f * expected);
        }
    }
    EXPECT_NEAR(luminance(horizontal_diffuse(sky).illuminance), luminance(horizontal_diffuse(preetham).illuminance),
                1e-3 * luminance(horizontal_diffuse(preetham).illuminance));
}

// Truth: dhi= and scale= by definition; a beam goes only with a sun that was cut.
TEST_F(ImageFiles, LevelsAndBeam) {
    const std::string file = write_exr("flat.exr", flat_image(8, Rgb(10.0f), Rgb(0.0f)));
    DaylightSettings settings;
    settings.sun_direction = SunDirection{1.0, 0.5};
    FindingLog findings;
    const auto daylight = [&](const std::string& options) {
        settings.sky = parse_sky("image:" + file + options);
        load_sky_image(settings.sky);
        return make_daylights(settings, std::nullopt, 0.0, findings).at(0);
    };
    EXPECT_NEAR(luminance(sky_luminance(daylight("").sky, towards(0.0, 45.0))), 10.0f, 1e-4f);
    EXPECT_NEAR(luminance(sky_luminance(daylight(",scale=3").sky, towards(0.0, 45.0))), 30.0f, 1e-3f);
    EXPECT_NEAR(horizontal_diffuse(daylight(",dhi=80").sky).irradiance_w_m2, 80.0, 0.01);
    EXPECT_EQ(daylight("").sun.dni_w_m2, 0.0f) << "the picture is all the light there is";
    EXPECT_TRUE(findings.empty());
    EXPECT_GT(daylight(",sun=cut").sun.dni_w_m2, 500.0f);
    EXPECT_EQ(findings.count("SB606"), 1u);
}

// Truth: what is wrong is named with the file, the fault and the remedy.
TEST_F(ImageFiles, BadPicturesAreRefusedOrRepaired) {
    const auto load = [](const std::string& file) {
        SkySettings settings = parse_sky("image:" + file);
        load_sky_image(settings);
        return std::get<ImageSettings>(settings);
    };
    EXPECT_THAT(refusal([&] { load(path("none.exr")); }), HasSubstr("none.exr: there is no such file"));
    EXPECT_THAT(refusal([&] { load(write_text("photo.jpg", "")); }), HasSubstr("an OpenEXR (.exr) or a Radiance"));
    EXPECT_THAT(refusal([&] { load(write_text("text.exr", "no picture")); }), HasSubstr("text.exr: broken EXR"));
    SkyImage square = flat_image(4, Rgb(1.0f), Rgb(1.0f));
    square.width = 4;
    square.height = 8;
    EXPECT_THAT(refusal([&] { load(write_exr("square.exr", square)); }),
                HasSubstr("4 x 8 pixels are not twice as wide as high"));
    SkyImage odd = flat_image(4, Rgb(1.0f), Rgb(1.0f));
    odd.pixels[0].x = -1.0f;
    odd.pixels[1].y = std::numeric_limits<float>::quiet_NaN();
    const ImageSettings repaired = load(write_exr("odd.exr", odd));
    ASSERT_EQ(repaired.findings.size(), 1u);
    EXPECT_EQ(repaired.findings[0].code, "SB607");
    EXPECT_THAT(repaired.findings[0].what, HasSubstr("2 of 32 pixels"));
    EXPECT_EQ(repaired.image->pixels[0], Rgb(0.0f, 1.0f, 1.0f));
}

// Truth: Radiance's description of its format: value = (mantissa + ½)/256 · 2^(exponent − 128) over the exposure.
TEST_F(ImageFiles, ReadsRadiancePictures) {
    const std::string head = "#?RADIANCE\nmade by hand\nEXPOSURE=2\nEXPOSURE= 0.25\nFORMAT=32-bit_rle_rgbe\n\n";
    const std::string flat = std::string("\x80\x40\x20\x81\x80\x40\x20\x82", 8);
    const auto picture = io::read_radiance_hdr(write_text("flat.hdr", head + "-Y 1 +X 2\n" + flat));
    ASSERT_EQ(picture.pixels.size(), 2u);
    EXPECT_FLOAT_EQ(picture.pixels[0].x, 128.5f / 128.0f * 2.0f);
    EXPECT_FLOAT_EQ(picture.pixels[1].z, 32.5f / 128.0f * 4.0f);
    // Run-length encoded, 8 wide: a run of 8, three and five single values, two runs, a run of 8.
    const std::string encoded = std::string("\x02\x02\x00\x08", 4) + std::string("\x88\x80", 2) +
                                std::string("\x03\x01\x02\x03\x05\x04\x05\x06\x07\x08", 10) +
                                std::string("\x84\x10\x84\x20", 4) + std::string("\x88\x80", 2);
    const auto runs = io::read_radiance_hdr(write_text("runs.hdr", head + "-Y 1 +X 8\n" + encoded));
    EXPECT_FLOAT_EQ(runs.pixels[7].x, 128.5f / 256.0f * 2.0f);
    EXPECT_FLOAT_EQ(runs.pixels[4].y, 5.5f / 256.0f * 2.0f);
    EXPECT_FLOAT_EQ(runs.pixels[3].z, 16.5f / 256.0f * 2.0f);
    // The older encoding: a pixel, then (1, 1, 1, n).
    const std::string old = std::string("\x80\x40\x20\x81\x01\x01\x01\x03", 8);
    EXPECT_FLOAT_EQ(io::read_radiance_hdr(write_text("old.hdr", head + "-Y 1 +X 4\n" + old)).pixels[3].x,
                    2.0f * 128.5f / 128.0f);

    const auto refused = [&](const std::string& text) {
        return refusal([&] { io::read_radiance_hdr(write_text("bad.hdr", text)); });
    };
    EXPECT_THAT(refused("P6 1 1"), HasSubstr("its header does not end"));
    EXPECT_THAT(refused("P6\n1 1\n"), HasSubstr("it does not begin with #?RADIANCE"));
    EXPECT_THAT(refused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n"), HasSubstr("is not 32-bit_rle_rgbe"));
    EXPECT_THAT(refused(head + "+X 2 -Y 1\n" + flat), HasSubstr("is not '-Y HEIGHT +X WIDTH'"));
    EXPECT_THAT(refused(head + "-Y 2 +X 2\n" + flat), HasSubstr("it ends in row 1"));
    EXPECT_THAT(refused(head + "-Y 1 +X 8\n" + encoded.substr(0, 8)), HasSubstr("it ends in row 0"));
    EXPECT_THAT(refused(head + "-Y 1 +X 9\n" + encoded), HasSubstr("row 0 says it is 8 pixels wide"));
    EXPECT_THAT(refused(head + "-Y 1000000 +X 1000000\n"), HasSubstr("Scale the picture down"));
    EXPECT_THAT(refused("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 2\n" + flat), HasSubstr("is not a positive number"));
}

}  // namespace
}  // namespace skybake
