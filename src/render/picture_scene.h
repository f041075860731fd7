// A baked city as a picture needs it: geometry, albedo and light, without files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/box.h"
#include "render/backdrop.h"
#include "render/light_page.h"
#include "render/mip_texture.h"

namespace skybake {

struct PictureMaterial {
    Rgb base_colour{0.5f};                 // linear albedo, or the texture's factor
    std::optional<std::uint32_t> texture;  // index into PictureScene::textures
    TextureWrap wrap = TextureWrap::repeat;
};

/// What a triangle shows, corner by corner.
struct PictureSurface {
    std::array<Vec2f, 3> albedo_uv{};  // (0, 0) lower left
    std::array<Vec2f, 3> texel{};      // texels of the page from its upper left corner
    std::uint32_t material = 0;
    std::uint32_t page = 0;
};

struct PictureScene {
    std::vector<std::array<Vec3f, 3>> triangles;  // local metres, z up
    std::vector<PictureSurface> surfaces;         // one a triangle
    std::vector<PictureMaterial> materials;
    std::vector<MipTexture> textures;
    Box3f bounds;
};

/// One quantity on all surfaces: illuminance (lx) of an instant's chosen parts, or a share such as the sky view factor
/// in every channel. One page for each of the atlas.
using SurfaceLight = std::vector<LightPage>;

}  // namespace skybake
