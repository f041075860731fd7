// Scene-linear Rec. 709 RGB in photometric units: luminance (cd m⁻²) or illuminance (lx) per channel
// (docs/nomenclature.md).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace skybake {

using Rgb = Vec3f;  // x = red, y = green, z = blue

/// The photometric sum of the three channels: the luminance of an RGB radiance, the illuminance of an RGB irradiance.
inline float luminance(const Rgb& rgb) {
    return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
}

/// Linear value in [0, 1] from an sRGB-encoded one in [0, 1] (IEC 61966-2-1).
inline float linear_from_srgb(float s) {
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

/// sRGB-encoded value in [0, 1]; the argument is clamped to [0, 1] (IEC 61966-2-1).
inline float srgb_from_linear(float v) {
    v = std::clamp(v, 0.0f, 1.0f);
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

}  // namespace skybake
