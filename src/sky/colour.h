// From CIE 1931 XYZ to the project's photometric Rec. 709 RGB, and back. XYZ is photometric too: Y is the luminance or
// illuminance.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

using Xyz = Vec3d;

/// XYZ from luminance and chromaticity; y must be positive.
inline Xyz xyz_from_luminance(double luminance, double x, double y) {
    return {luminance * x / y, luminance, luminance * (1.0 - x - y) / y};
}

/// Linear Rec. 709 RGB (IEC 61966-2-1, D65). Never negative: channels of a colour outside Rec. 709 are cut at 0, and
/// the whole is scaled so that luminance(rgb) is Y whatever was cut. Y ≤ 0 and non-finite values give black.
inline Rgb rgb_from_xyz(const Xyz& xyz) {
    const double red = 3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z;
    const double green = -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z;
    const double blue = 0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z;
    const Vec3d cut(std::max(red, 0.0), std::max(green, 0.0), std::max(blue, 0.0));
    const double sum = 0.2126 * cut.x + 0.7152 * cut.y + 0.0722 * cut.z;
    const double scale = xyz.y / sum;
    if (!(xyz.y > 0.0) || !(sum > 0.0) || !std::isfinite(scale)) return Rgb(0.0f);
    return Rgb(static_cast<float>(cut.x * scale), static_cast<float>(cut.y * scale), static_cast<float>(cut.z * scale));
}

/// XYZ of a linear Rec. 709 colour.
inline Xyz xyz_from_rgb(const Rgb& rgb) {
    const Vec3d c(rgb);
    return {0.4124564 * c.x + 0.3575761 * c.y + 0.1804375 * c.z, 0.2126729 * c.x + 0.7151522 * c.y + 0.0721750 * c.z,
            0.0193339 * c.x + 0.1191920 * c.y + 0.9503041 * c.z};
}

}  // namespace skybake
