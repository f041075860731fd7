#include "sky/sky_colour.h"

#include "sky/clear_sky.h"

namespace skybake {

SkyColour sky_colour(double turbidity, const Vec3d& sun_direction, double clear_share) {
    return {preetham_sky(turbidity, sun_direction), clear_share};
}

Xyz coloured(const SkyColour& colour, double luminance, const Vec3d& direction) {
    const Xyz white = luminance * Xyz(0.95047, 1.0, 1.08883);  // D65 as Rec. 709 has it: a grey stays grey
    if (colour.clear_share <= 0.0) return white;
    const Vec2d xy = chromaticity(colour.clear, direction);
    const Xyz blue = xyz_from_luminance(luminance, xy.x, xy.y);
    return colour.clear_share * blue + (1.0 - colour.clear_share) * white;
}

double turbidity_of_beam(double dni_w_m2, double sun_zenith_rad, double distance_au) {
    double low = 2.0;
    double high = 10.0;
    for (int step = 0; step < 20; ++step) {  // the beam falls with the turbidity: bisection, to 1e-5
        const double middle = 0.5 * (low + high);
        if (clear_sky_irradiance(middle, sun_zenith_rad, distance_au).dni > dni_w_m2) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

}  // namespace skybake
