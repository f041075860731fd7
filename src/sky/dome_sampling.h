// Directions to the sky that all texels of a chart share (paper §4.2; docs/architecture.md, "Skylight").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "sky/daylight.h"

namespace skybake {

/// A set of directions for surfaces of one normal. With visibility V_j in [0, 1], the sky's irradiance of instant k is
///   planar charts:  E_k = Σ_j weight[k][j] V_j                              (the cosine is part of the weight)
///   relief charts:  E_k = Σ_j weight[k][j] V_j max(0, normal · direction_j)   (each texel has its own normal)
/// and the sky view factor likewise with view_factor_weight.
struct DomeSamples {
    std::vector<Vec3f> directions;  // unit, above the horizon, from low to high; any run of them covers all azimuths
    std::vector<std::vector<Rgb>> weights;  // [instant][direction], lx per channel
    std::vector<float> view_factor_weight;  // [direction]

    std::size_t size() const { return directions.size(); }
};

/// Importance sampler of the skies of several instants at once: the density follows the cosine about the normal times a
/// mixture of the skies' luminances and a uniform part (for the view factor), so that one set of visibilities serves
/// every instant. Points: Fibonacci's lattice, warped by the inverse of the tabulated density: first the
/// height, then the azimuth. Cells of high contrast, where a picture of the sky holds its sun, are divided further. The
/// warp depends on the normal continuously and on nothing else, so charts of equal
/// normal share their directions, and nearly equal normals share their error. The weights are scaled so that without
/// obstacles they give the irradiance of the tabulated sky exactly (ratio estimator): only the visible share is
/// estimated.
class DomeSampler {
  public:
    explicit DomeSampler(std::span<const Daylight> instants);

    /// At most `count` directions for planar surfaces of the unit `normal`; the few that fall below the surface's
    /// horizon are dropped.
    DomeSamples sample(const Vec3f& normal, int count) const;

    /// The same for texels whose normals differ from `normal` by an angle of cosine `min_normal_cosine` or less: the
    /// density covers the sky above any of them.
    DomeSamples sample_relief(const Vec3f& normal, float min_normal_cosine, int count) const;

    /// The density, sr⁻¹, with which sample() chooses each of the unit `directions`; 0 below the sky's horizon. A
    /// little of it lies below the surface's horizon: those directions are dropped. Integrates to 1 over the sky.
    std::vector<double> pdf_solid_angle(const Vec3f& normal, std::span<const Vec3f> directions) const;

    /// Irradiance of an unobstructed surface of the unit `normal` from instant `k`'s sky, lx per channel. Quadrature
    /// over the table: error below 0.1 % for every model (tests/sky/dome_sampling_test.cpp).
    Rgb unobstructed_irradiance(std::size_t k, const Vec3f& normal) const;

  private:
    /// Densities within a cell relative to its mean, and their sums for the warp.
    struct FineCell {
        std::vector<float> density;     // [height][azimuth]
        std::vector<float> row_sum;     // [height][azimuth]: up to and with this part
        std::vector<float> height_sum;  // [height]
    };
    /// The cells' masses for one normal, summed.
    struct CellSums {
        std::vector<double> row_sum;  // [height][azimuth]: up to and with this cell
        std::vector<double> row_end;  // [height]
        double total = 0.0;
    };
    /// What a sky gives to a cell.
    struct CellLight {
        Rgb luminance{0.0f};    // mean
        Vec3f direction{0.0f};  // mean of the directions, each by its luminance; at most of unit length
    };
    /// Means over `parts` × `parts` points of a cell, and the luminance of the brightest of them.
    static CellLight mean_light(const SkyModel& sky, int cell, int parts, float& brightest);
    CellSums cell_sums(const Vec3f& normal, float sine_below) const;
    DomeSamples sample_about(const Vec3f& normal, float sine_below, bool has_cosine, int count) const;
    void divide_cell(int azimuth, int height, std::span<const double> instant_scale);

    std::vector<Vec3f> cell_direction_;               // centres
    std::vector<std::vector<CellLight>> cell_light_;  // [instant][cell]
    std::vector<float> cell_density_;                 // mixture, before the cosine
    std::vector<FineCell> fine_cells_;
    std::vector<std::optional<std::uint32_t>> fine_of_cell_;
    std::vector<Daylight> instants_;
};

}  // namespace skybake
