// The form that Perez's, Preetham's and the CIE's skies share: a gradation from the zenith to the horizon times an
// indicatrix about the sun.
#pragma once

#include <functional>

#include "base/vec.h"

namespace skybake {

/// scale (1 + A e^{B/cos θ}) (1 + C e^{D γ} + E cos² γ): θ from the zenith, γ from the sun.
struct PerezDistribution {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    double d = 0.0;
    double e = 0.0;
    double scale = 0.0;
};

/// Where a direction lies to the zenith and to the sun.
struct ViewAngles {
    double cos_zenith = 1.0;
    double gamma = 0.0;  // from the sun, rad
    double cos_gamma = 1.0;
};
ViewAngles view_angles(const Vec3d& direction, const Vec3d& sun_direction);

/// The distribution at a place above the horizon. Directions lower than 0.06° are evaluated there: e^{B/cos θ} has no
/// limit that anything needs. May be negative for odd coefficients.
double value_of(const PerezDistribution& distribution, const ViewAngles& view);

/// ∫ max(0, luminance) cos θ dω over the hemisphere, for a function that is symmetric about the sun's azimuth.
/// `sun_cos_zenith` in [0, 1]. Midpoint rule with 192 × 96 points over one half: error below 1e-4 for every sky here
/// (tests/sky/sky_reference_test.cpp).
double horizontal_integral(const std::function<double(const ViewAngles&)>& luminance, double sun_cos_zenith);
double horizontal_integral(const PerezDistribution& distribution, double sun_cos_zenith);

/// The direction itself, or, for a sun below the horizon, the point of the horizon under which it stands: where the
/// models end.
Vec3d lifted_to_horizon(const Vec3d& sun_direction);

}  // namespace skybake
