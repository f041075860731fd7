#include "sky/gensky_level.h"

#include <algorithm>
#include <cmath>

namespace skybake {

double gensky_zenith_luminance(Cie1994Type type, double sun_elevation_rad, double turbidity) {
    const double elevation = std::clamp(sun_elevation_rad, 0.0, radians_from_degrees(80.0));
    const double clear = (1.376 * turbidity - 1.81) * std::tan(elevation) + 0.38;
    const double overcast = 8.6 * std::sin(std::max(sun_elevation_rad, 0.0)) + 0.123;
    switch (type) {
        case Cie1994Type::clear:
        case Cie1994Type::turbid_clear:
            return 1000.0 * std::max(clear, 0.0);
        case Cie1994Type::intermediate:
            return 500.0 * std::max(clear + overcast, 0.0);
        case Cie1994Type::overcast:
            break;
    }
    return 1000.0 * overcast;
}

double gensky_sun_illuminance(Cie1994Type type, double sun_elevation_rad) {
    if (type == Cie1994Type::overcast || sun_elevation_rad <= 0.0) return 0.0;
    constexpr double kSolidAngle = 6.0e-5;
    const double luminance = 1.5e9 * (1.147 - 0.147 / std::max(std::sin(sun_elevation_rad), 0.16));
    return (type == Cie1994Type::intermediate ? 0.15 : 1.0) * luminance * kSolidAngle;
}

}  // namespace skybake
