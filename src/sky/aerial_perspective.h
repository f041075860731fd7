// What the air between the eye and a distant building takes and adds. Based on: Preetham, Shirley, Smits, "A practical
// analytic model for daylight", SIGGRAPH 1999, section 4 and appendix A.4: molecules and haze whose density falls
// exponentially with the height, single scattering of the light of sky, sun and ground. Deviations: one wavelength a
// channel instead of spectra; the light that arrives is that of the observer, found by summation over any sky model
// instead of a fit, and brought to the sky's own horizon (after Koschmieder 1924: what is infinitely far looks like the
// horizon); the path is summed up in optical depth instead of by a polynomial.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "sky/daylight.h"

namespace skybake {

/// Total scattering at the ground for the channels R, G, B (611, 549, 464 nm: the primaries' dominant wavelengths),
/// m⁻¹.
struct AirScattering {
    Vec3d molecules{0.0};
    Vec3d haze{0.0};
};

/// For a Preetham turbidity; no haze below 1. The paper's concentration factor (0.6544 T − 0.6510) 10⁻¹⁶ gives 1/cm for
/// wavelengths in cm; in SI it is 10⁻¹⁸. So it agrees with the definition of the turbidity within 20 %.
AirScattering air_scattering(double turbidity);

/// Share of the scattered light that goes into 1 sr at an angle from its way, sr⁻¹, per channel; integrates to 1 over
/// the sphere. Haze: the table η of appendix A.4 for Junge's exponent 4 (after Bullrich 1964), its logarithm linear in
/// between.
double molecule_phase(double cos_angle);
Vec3d haze_phase(double cos_angle);

/// Scale heights of the density, m.
inline constexpr double kMoleculeHeight = 1000.0 / 0.1136;
inline constexpr double kHazeHeight = 1000.0 / 0.8333;

/// The air under one daylight: plain values, as the walkthrough gets them. `airlight` is what an endless view through
/// such particles alone would show, cd m⁻² per channel, tabulated by the direction of view about `pole` (the sun):
/// row r at the angle π (r / (rows − 1))² from it, column c at the turn 2π (c + 0.5) / columns about it, counted from
/// air_axes(pole).a towards b.
struct Air {
    AirScattering scattering;
    Vec3d pole{0.0, 0.0, 1.0};
    int columns = 0;
    int rows = 0;
    std::vector<Rgb> molecule_airlight;  // columns × rows, row by row
    std::vector<Rgb> haze_airlight;
};

/// Unit vectors across the pole: a right angle to it and to each other; a lies in the plane of the pole and the zenith
/// (of the pole and x, for a pole within 26° of the zenith).
struct AirAxes {
    Vec3d a{1.0, 0.0, 0.0};
    Vec3d b{0.0, 1.0, 0.0};
};
AirAxes air_axes(const Vec3d& pole);

/// Takes a few tenths of a second at the default size, whose level views are good to 2 % (aerial_perspective_test).
Air air_under(const Daylight& light, int columns = 32, int rows = 64);

/// A building of luminance L is seen as L · transmittance + inscatter (cd m⁻² per channel).
struct AerialView {
    Rgb transmittance{1.0f};
    Rgb inscatter{0.0f};
};

/// Along a unit direction of the world frame, over `distance_m` ≥ 0, from `height_m` above the ground on which the
/// turbidity was measured. The path is divided into four pieces, in each of which haze and molecules keep their
/// proportion: good to 0.5 % (aerial_perspective_test). About 0.5 µs; thread-safe.
AerialView view_through(const Air& air, double height_m, const Vec3d& direction, double distance_m);

}  // namespace skybake
