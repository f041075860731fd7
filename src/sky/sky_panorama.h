// The sky as pictures: for the walkthrough's backdrop, and for the eye.
#pragma once

#include <vector>

#include "sky/daylight.h"

namespace skybake {

/// The sky without the sun's disc (a picture's own sun stays in it), cd m⁻² per channel, width × height values, row by
/// row: row r at zenith angle r/(height − 1) · 90° (row 0 the zenith, the last row the horizon), column c at grid
/// azimuth (c + 0.5)/width · 360°, clockwise from grid north. `width` ≥ 1, `height` ≥ 2.
std::vector<Rgb> sky_panorama(const SkyModel& sky, int width, int height);

/// The whole sphere, width × width / 2 values, cd m⁻² per channel: row 0 the zenith, the last row the nadir, columns
/// clockwise from north, as --sky image:FILE reads it. The lower half is level land under that light. The sun's disc is
/// in it, where the daylight has a beam: each pixel gets its share of it, so that the picture's disc gives the beam's
/// illuminance (65536 points of the disc; those below the horizon are not seen).
std::vector<Rgb> equirectangular(const Daylight& daylight, int width);

/// The dome as one sees it lying on one's back, the head to the north, width × width values: north on top, east on the
/// left, the zenith in the middle, the zenith angle growing evenly to the horizon on the circle; black outside. The
/// sun likewise.
std::vector<Rgb> fisheye(const Daylight& daylight, int width);

}  // namespace skybake
