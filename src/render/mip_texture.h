// An albedo texture with its coarser levels: what graphics cards call a mipmap.
#pragma once

#include <vector>

#include "scene/albedo_image.h"

namespace skybake {

class MipTexture {
  public:
    /// `image` has at least one pixel. The levels are means of 2 × 2 pixels in linear light, down to one pixel.
    explicit MipTexture(AlbedoImage image);

    /// Linear albedo at `uv` ((0, 0) lower left), bilinear in the two levels about a sample that is `footprint` wide
    /// (in units of uv), mixed between them.
    Rgb at(const Vec2f& uv, const Vec2f& footprint, TextureWrap wrap) const;

  private:
    std::vector<AlbedoImage> levels_;  // the finest first
};

}  // namespace skybake
