// The link that the walkthrough keeps in the browser's address (viewer/src/core/view_state.ts).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "render/display.h"
#include "render/false_colour.h"

namespace skybake::cli {

/// What a link restores; what it does not say is none.
struct ViewLink {
    Vec3f position{0.0f};  // local metres, z up
    Vec3f target{0.0f};
    std::optional<PictureKind> kind;
    std::optional<std::size_t> instant;
    bool is_between = false;           // the walkthrough was fading from that instant into a neighbour
    std::optional<FalseColour> scale;  // range of false colours
    std::optional<float> ev;           // stops
    std::optional<bool> has_air;       // the air between the eye and the city is seen
    std::vector<std::string> off;      // parts of the light that are switched off
    std::vector<std::pair<std::string, float>> factors;  // of parts that are scaled
    std::string layer;  // id of the study's layer that is shown, where that is the picture
};

/// Reads a whole address or the part from its '#' on. Fields that it does not know are left to newer walkthroughs.
/// Throws InputError when there is no place to look from, or a field makes no sense.
ViewLink parse_view_link(const std::string& link);

}  // namespace skybake::cli
