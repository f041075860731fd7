// The picture on a surface as light sees it: linear albedo at a texture coordinate.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "city/city_model.h"

namespace skybake {

/// Eight-bit sRGB pixels, row 0 on top. An empty one stands for a texture that was not read.
struct AlbedoImage {
    int width = 0;
    int height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;  // width × height

    bool is_empty() const { return pixels.empty(); }
};

/// Of a surface whose texture cannot be read: a middling grey. The same as in the GLB.
inline constexpr float kAlbedoWithoutTexture = 0.5f;

/// Linear albedo 0…1 at `uv`, where (0, 0) is the picture's lower left corner: bilinear between the pixels' centres,
/// after decoding, as graphics cards filter. Outside [0, 1] as `wrap` says; `border` is for TextureWrap::border, and
/// TextureWrap::none is answered with the picture's edge. Coordinates that are not finite give the pixel at (0, 0).
Rgb albedo_at(const AlbedoImage& image, const Vec2f& uv, TextureWrap wrap, const Rgb& border);

}  // namespace skybake
