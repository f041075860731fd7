// A lightmap page as a picture of the lit city: albedo times light, ready for a screen. For programs that know textures
// only.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "render/display.h"
#include "render/picture_scene.h"

namespace skybake {

struct LitPageSettings {
    int detail = 2;                       // pixels along a texel's edge, at least 1
    PictureKind kind = PictureKind::lit;  // or light: on white
    float exposure = 1.0f;                // exposure_factor: from cd m⁻² to 1 for a diffuse white
};

/// The page `page` of `size` texels as 8-bit sRGB, three bytes a pixel, row 0 on top, `detail` × `size` pixels: at the
/// middle of each pixel the surface's albedo × illuminance / π, exposed and tone mapped as `skybake render` shows it.
/// Pixels beside a chart repeat its edge as far as the gutter reaches, so that bilinear lookup shows no seams; the rest
/// is black.
std::vector<std::uint8_t> lit_page(const PictureScene& scene, const LightPage& light, std::uint32_t page,
                                   const Vec2i& size, const LitPageSettings& settings);

}  // namespace skybake
