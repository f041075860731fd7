// A place on Earth, for the sun.
#pragma once

namespace skybake {

/// Geodetic WGS 84 position; radians and metres, longitude positive to the east.
struct Site {
    double latitude_rad = 0.0;
    double longitude_rad = 0.0;
    double elevation_m = 0.0;
};

}  // namespace skybake
