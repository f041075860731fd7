// A photographed or rendered sky.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

/// An equirectangular picture of the whole sphere, cd m⁻² per channel (linear Rec. 709): row 0 on top at the zenith,
/// the last row at the nadir, columns clockwise as seen from above: column c at azimuth (c + ½)/width · 360°. Finite
/// and not negative. At least one row lies above the horizon; what is below it is not used.
struct SkyImage {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;  // width × height

    /// Rows whose middle lies above the horizon.
    int sky_rows() const { return height / 2; }
};

/// The picture as a sky: bilinear between the middles of its pixels, the lowest row above the horizon and the row at
/// the zenith continued.
struct ImageSky {
    std::shared_ptr<const SkyImage> image;
    double first_azimuth_rad = 0.0;  // grid azimuth of the left edge of column 0
};

/// Luminance in a unit direction of the world frame, cd m⁻² per channel; 0 below the horizon.
Rgb sky_luminance(const ImageSky& sky, const Vec3f& direction);

/// Illuminance of the open horizontal plane, lx per channel: each pixel times its exact share of the cosine.
Vec3d horizontal_illuminance(const SkyImage& image);

/// The picture with every value times `factor`.
SkyImage scaled(SkyImage image, double factor);

/// What cut_sun found and did.
struct CutSun {
    Vec3d direction{0.0, 0.0, 1.0};  // of the sun's middle, azimuth from the left edge of the picture
    double removed_normal_lx = 0.0;  // illuminance of a plane that faces it, by what was taken away
    int changed_pixels = 0;
};

/// Takes the sun out of the picture: of the pixels within 5° of the middle of the brightest ones, those more than
/// twice as bright as the mean of the ring from 5° to 7.5° around it get twice that mean, in its colour. Nothing when
/// no pixel is: then there is no sun.
std::optional<CutSun> cut_sun(SkyImage& image);

}  // namespace skybake
