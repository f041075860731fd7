// Numbers as colours, and the scale that says which.
#pragma once

#include <string>
#include <vector>

#include "base/rgb.h"
#include "render/render_picture.h"

namespace skybake {

/// A range of values shown from dark blue over green to yellow; below and above it the end colours stand.
struct FalseColour {
    double low = 0.0;
    double high = 1.0;            // above `low`
    bool is_logarithmic = false;  // then `low` is positive
};

/// Linear colour of a value. The colours are viridis (S. van der Walt, N. Smith, 2015): even steps of lightness, also
/// for the colour-blind and in print.
Rgb colour_of(const FalseColour& scale, double value);

struct ScaleTick {
    double value = 0.0;
    double place = 0.0;  // 0 at `low` … 1 at `high`
    std::string label;
};
/// Round values for the legend, between three and ten of them, from low to high.
std::vector<ScaleTick> ticks_of(const FalseColour& scale);

/// From 0 to a round value above all but the brightest half percent of the pixels that show a surface; to 1 when
/// none is bright.
FalseColour range_of(const Picture& measure);

/// The measure of a picture in false colours on paper: linear [0, 1]. What counts is the luminance of the three
/// channels.
Picture in_false_colours(const Picture& measure, const FalseColour& scale);

}  // namespace skybake
