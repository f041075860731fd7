// A lightmap page to look up: cubic, with one coarser level for far surfaces, as the walkthrough reads it.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

class LightPage {
  public:
    /// `texels`: width × height values, row 0 on top; both sides at least 1.
    LightPage(int width, int height, std::vector<Rgb> texels);

    /// The value at `place` (texels from the upper left corner; centres at ½): a cubic B-spline over 4 × 4 texels.
    /// `footprint` is the width in texels that the sample stands for: up to 1 the page itself, from 2 on its means over
    /// 2 × 2 texels (bilinear), mixed between. Two texels about a chart are enough for both, and there is no coarser
    /// level for which they would be. B-spline: C. Sigg, M. Hadwiger, "Fast third-order texture filtering", GPU Gems 2
    /// (2005), ch. 20; decision 0025. Twin: viewer/src/three/city_material.ts.
    Rgb at(const Vec2f& place, float footprint) const;

    /// The value at `place`, bilinear between centres: at a centre the texel itself.
    Rgb bilinear(const Vec2f& place) const { return fine_.at(place); }

  private:
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<Rgb> texels;
        Rgb at(const Vec2f& place) const;
        Rgb cubic(const Vec2f& place) const;
    };
    Level fine_;
    Level coarse_;
};

}  // namespace skybake
