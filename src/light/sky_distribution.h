// Random directions to one sky: what a path or a photon needs, one at a time (the texels' sets are DomeSampler's).
#pragma once

#include <cstddef>
#include <optional>

#include "light/cell_distribution.h"
#include "sky/daylight.h"

namespace skybake {

/// Directions above the horizon with a density that follows the sky's luminance, tabulated in cells of equal solid
/// angle; times the cosine about a surface's normal, when there is one. A few per cent are spread evenly, so that no
/// direction with light is left out. Read-only after construction.
class SkyDistribution {
  public:
    explicit SkyDistribution(const SkyModel& sky, const std::optional<Vec3f>& normal = std::nullopt);

    /// ∫ luminance dω, or ∫ luminance cos θ dω with a normal: lx; 0 for a sky without light, which must not be sampled.
    double total() const { return total_; }

    struct Sample {
        Vec3f direction{0.0f, 0.0f, 1.0f};
        float pdf_solid_angle = 0.0f;  // sr⁻¹
    };
    /// `u`, `v` in [0, 1).
    Sample sample(float u, float v) const;
    /// Density of a unit direction, sr⁻¹; 0 below the horizon.
    float pdf(const Vec3f& direction) const;

  private:
    float pdf_of(std::size_t cell) const;

    CellDistribution cells_;  // rows: heights; columns: azimuths
    double total_ = 0.0;
};

}  // namespace skybake
