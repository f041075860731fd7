// From luminance to a screen, with the walkthrough's formulas (viewer/src/core/exposure.ts and three/city_material.ts):
// exposure, tone mapping, sRGB and dither. tests/render/display_values.csv holds both sides to the same numbers.
#pragma once

#include <cstdint>

#include "base/rgb.h"

namespace skybake {

/// The pictures of a bake. The first three are the paper's (figures 3 to 8); the other two are measures in false
/// colours.
enum class PictureKind : std::uint8_t { lit, textures, light, illuminance, sky_view };

constexpr bool is_measure(PictureKind kind) {
    return kind == PictureKind::illuminance || kind == PictureKind::sky_view;
}

/// The factor from luminance in cd m⁻² to the tone mapper's input, where 1 is a diffuse white.
/// @param hint the manifest's exposure_hint of the instant, m² kcd⁻¹, positive
/// @param ev the user's correction, stops
float exposure_factor(float hint, float ev, PictureKind kind);

/// AgX: from exposed linear Rec. 709 (not negative, finite) to linear Rec. 709 in [0, 1] that a screen can show.
/// Based on: T. Sobotka, "AgX" (2022), in the polynomial form of B. Wrensch, "Minimal AgX implementation" (2023), over
/// Rec. 2020 primaries, as three.js 0.187 computes it.
Rgb agx_tone_mapped(const Rgb& exposed);

/// Eight-bit sRGB of a linear value in [0, 1], with half a step of dither against bands in smooth skies; `column` and
/// `row` count pixels from the lower left corner. The dither is interleaved gradient noise: J. Jimenez, "Next
/// generation post processing in Call of Duty: Advanced Warfare", SIGGRAPH 2014, slide 123.
std::uint8_t dithered_srgb(float linear, int column, int row);

}  // namespace skybake
