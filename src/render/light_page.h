// A lightmap page to look up: bilinear, with one coarser level for far surfaces, as the walkthrough reads it.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake {

class LightPage {
  public:
    /// `texels`: width × height values, row 0 on top; both sides at least 1.
    LightPage(int width, int height, std::vector<Rgb> texels);

    /// The value at `place` (texels from the upper left corner; centres at ½), bilinear between centres. `footprint` is
    /// the width in texels that the sample stands for: up to 1 the page itself, from 2 on its means over 2 × 2 texels,
    /// mixed between. No coarser level exists: charts have a gutter of two texels, which holds for one halving.
    Rgb at(const Vec2f& place, float footprint) const;

  private:
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<Rgb> texels;
        Rgb at(const Vec2f& place) const;
    };
    Level fine_;
    Level coarse_;
};

}  // namespace skybake
