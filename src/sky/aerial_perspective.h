// What the air between the eye and a distant building takes and adds. Based on: Preetham, Shirley, Smits, "A practical
// analytic model for daylight", SIGGRAPH 1999, section 4 and appendix A.4: molecules and haze whose density falls
// exponentially with the height, single scattering of the light of sky, sun and ground. Deviations: one wavelength a
// channel instead of spectra; the light that arrives is that of the observer, found by summation over any sky model
// instead of a fit; the path is summed up exactly in optical depth instead of by a polynomial.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "sky/daylight.h"

namespace skybake {

/// Total scattering at sea level for the channels R, G, B (611, 549, 464 nm: the primaries' dominant wavelengths), m⁻¹.
struct AirScattering {
    Vec3d molecules{0.0};
    Vec3d haze{0.0};
};

/// For a Preetham turbidity; no haze below 1. The paper's concentration factor (0.6544 T − 0.6510) 10⁻¹⁶ gives 1/cm for
/// wavelengths in cm; in SI it is 10⁻¹⁸. So it agrees with the definition of the turbidity within 20 %.
AirScattering air_scattering(double turbidity);

/// Share of the scattered light that goes into 1 sr at an angle from its way, sr⁻¹, per channel; integrates to 1 over
/// the sphere. Haze: the table η of appendix A.4 for Junge's exponent 4 (after Bullrich 1964), linear in between.
double molecule_phase(double cos_angle);
Vec3d haze_phase(double cos_angle);

/// Scale heights of the density, m.
inline constexpr double kMoleculeHeight = 1000.0 / 0.1136;
inline constexpr double kHazeHeight = 1000.0 / 0.8333;

/// A building of radiance L is seen as L · transmittance + inscatter (cd m⁻² per channel).
struct AerialView {
    Rgb transmittance{1.0f};
    Rgb inscatter{0.0f};
};

/// The air under one daylight. Built once (about 1 ms), asked for any number of views (about 30 µs each). Thread-safe.
class AerialPerspective {
  public:
    /// `ground_luminance` is what the ground sends upwards, cd m⁻² per channel. `turbidity` ≥ 1.
    AerialPerspective(const Daylight& light, double turbidity, const Rgb& ground_luminance);

    /// Along a unit direction of the world frame, over `distance_m` ≥ 0, from `observer_height_m` above sea level.
    AerialView view(double observer_height_m, const Vec3f& direction, double distance_m) const;

  private:
    struct Light {
        Vec3d direction;  // it comes from
        Vec3d flux;       // luminance × solid angle, or the sun's illuminance
    };
    AirScattering scattering_;
    std::vector<Light> lights_;
};

}  // namespace skybake
