// The sky as a picture of the upper hemisphere, for the walkthrough's backdrop.
#pragma once

#include <vector>

#include "sky/daylight.h"

namespace skybake {

/// The sky without the sun's disc (a picture's own sun stays in it), cd m⁻² per channel, width × height values, row by
/// row: row r at zenith angle r/(height − 1) · 90° (row 0 the zenith, the last row the horizon), column c at grid
/// azimuth (c + 0.5)/width · 360°, clockwise from grid north. `width` ≥ 1, `height` ≥ 2.
std::vector<Rgb> sky_panorama(const SkyModel& sky, int width, int height);

}  // namespace skybake
