// How a luminaire spreads its light: intensity by direction, as goniophotometers measure it.
#pragma once

#include <vector>

#include "base/vec.h"
#include "light/cell_distribution.h"

namespace skybake {

/// Luminous intensity in the C-γ system of CIE 121-1996, rotated with the luminaire: γ is the angle off its axis, which
/// points down on a street lamp; C turns about it, counter-clockwise for who looks along the axis from behind (from
/// above). Between the measured angles it is bilinear in the angles; beyond the last γ it is dark.
class LightProfile {
  public:
    /// `c_rad` ascends from 0 and stays below 2π, and the last plane goes over into the first; a single plane stands
    /// for all. `gamma_rad` ascends within 0…π. `candela` [plane × gammas + gamma], none negative, not all 0.
    LightProfile(std::vector<double> c_rad, std::vector<double> gamma_rad, std::vector<double> candela);

    double peak_cd() const { return peak_cd_; }
    /// ∫ share dω, sr: times the peak it is the flux. Quadrature error below 1e-4 for tables of steps of at most 15°.
    double solid_angle() const { return solid_angle_; }

    /// Intensity over the peak, 0…1. `local` is a unit vector: x along C = 0, y along C = 90°, z along the axis.
    float share(const Vec3f& local) const;
    /// The largest share at angles off the axis between `low_rad` and `high_rad`.
    float largest_share(float low_rad, float high_rad) const;

    struct Sample {
        Vec3f local{0.0f};
        double pdf_solid_angle = 0.0;  // sr⁻¹, of the direction
    };
    /// A direction for u, v in [0, 1), by a density close to the share: that of its mean over cells of 2° × 5.6°, and a
    /// thousandth even.
    Sample sample(float u, float v) const;

  private:
    double interpolated(double c, double gamma) const;
    void tabulate_cells();

    std::vector<double> c_, gamma_, share_;
    double peak_cd_ = 0.0, solid_angle_ = 0.0;
    CellDistribution cells_;  // of directions: rows in γ, columns in C
};

}  // namespace skybake
