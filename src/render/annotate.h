// What is drawn onto a finished picture: legend, north arrow, scale bar.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/vec.h"
#include "render/false_colour.h"

namespace skybake {

struct Legend {
    FalseColour scale;
    std::string title;  // what is shown, with its unit
};

struct Annotation {
    std::optional<Legend> legend;
    std::optional<double> metres_per_pixel;  // asks for a scale bar
    std::optional<Vec2f> north;              // asks for an arrow: x to the right, y up, of any length but 0
    bool is_empty() const { return !legend && !metres_per_pixel && !north; }
};

/// Draws onto `size.x` × `size.y` pixels of three bytes (sRGB, row 0 on top): the legend to the right, north arrow and
/// scale bar below on the left, each on a light plate. Sizes follow the picture's. Letters are the system's sans-serif,
/// so they may differ from computer to computer.
void draw_annotation(std::span<std::uint8_t> rgb, const Vec2i& size, const Annotation& annotation);

}  // namespace skybake
