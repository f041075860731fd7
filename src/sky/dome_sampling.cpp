// Based on: Reichinger, Maierhofer, Tobler, "Skylight Illumination and Rendering of Urban Scenes", 2006, §4.2 (direct
// sampling of the dome with a Halton series). Deviations: the points follow cosine times luminance instead of covering
// the dome evenly, and they are Fibonacci's lattice (i/N, frac(i/φ)), which has less than half of the Halton points'
// error at equal N (docs/decisions/0005-fibonacci-directions.md).
#include "sky/dome_sampling.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace skybake {

namespace {

// Cells of equal solid angle: azimuth × height z = sin(elevation). 1.4° × 0.9° at the horizon: narrower than any sky's
// features here.
constexpr int kAzimuths = 256;
constexpr int kHeights = 64;
constexpr int kCells = kAzimuths * kHeights;
constexpr double kCellSolidAngle = 2.0 * kPi / kCells;
// Points a side at which a cell's mean luminance is taken: the horizon's gradient is steep.
constexpr int kCellSubdivision = 4;
// Inverse golden ratio: successive azimuths of Fibonacci's lattice.
constexpr double kGoldenRatio = 0.61803398874989484820;
// Share of the uniform sky in the mixture: keeps the view factor's weights within 5 of their mean.
constexpr double kUniformShare = 0.2;

Vec3f direction_at(double azimuth_cell, double height_cell) {
    const double azimuth = azimuth_cell * (2.0 * kPi / kAzimuths);
    const double z = height_cell / kHeights;
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return Vec3f(static_cast<float>(r * std::sin(azimuth)), static_cast<float>(r * std::cos(azimuth)),
                 static_cast<float>(z));
}

}  // namespace

DomeSampler::DomeSampler(std::span<const Daylight> instants) : instants_(instants.begin(), instants.end()) {
    cell_direction_.resize(kCells);
    for (int a = 0; a < kAzimuths; ++a) {
        for (int h = 0; h < kHeights; ++h) cell_direction_[h * kAzimuths + a] = direction_at(a + 0.5, h + 0.5);
    }
    cell_density_.assign(kCells, static_cast<float>(kUniformShare));
    for (const Daylight& instant : instants_) {
        std::vector<Rgb>& mean = cell_luminance_.emplace_back(kCells);
        double sum = 0.0;
        for (int a = 0; a < kAzimuths; ++a) {
            for (int h = 0; h < kHeights; ++h) {
                Rgb total(0.0f);
                for (int i = 0; i < kCellSubdivision; ++i) {
                    for (int j = 0; j < kCellSubdivision; ++j) {
                        total += sky_luminance(instant.sky, direction_at(a + (i + 0.5) / kCellSubdivision,
                                                                         h + (j + 0.5) / kCellSubdivision));
                    }
                }
                mean[h * kAzimuths + a] = total / static_cast<float>(kCellSubdivision * kCellSubdivision);
                sum += luminance(mean[h * kAzimuths + a]);
            }
        }
        if (sum <= 0.0) continue;
        const double scale = (1.0 - kUniformShare) * kCells / (sum * static_cast<double>(instants_.size()));
        for (int cell = 0; cell < kCells; ++cell)
            cell_density_[cell] += static_cast<float>(scale * luminance(mean[cell]));
    }
}

DomeSamples DomeSampler::sample(const Vec3f& normal, int count) const {
    return sample_about(normal, 0.0f, true, count);
}

DomeSamples DomeSampler::sample_relief(const Vec3f& normal, float min_normal_cosine, int count) const {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - min_normal_cosine * min_normal_cosine));
    return sample_about(normal, sine, false, count);
}

DomeSamples DomeSampler::sample_about(const Vec3f& normal, float sine_below, bool has_cosine, int count) const {
    SKYBAKE_CHECK_LT(0, count);
    // Mass of each cell, summed along each row of one height. The cosine of a cell is that of its centre, a little
    // raised, so that a cell that the surface's horizon cuts keeps some mass: half a cell's diagonal is 0.014.
    constexpr float kHalfCell = 0.014f;
    std::vector<double> row_sum(kCells);  // [height][azimuth]: up to and with this cell
    std::vector<double> row_end(kHeights);
    double total = 0.0;
    for (int h = 0; h < kHeights; ++h) {
        double sum = 0.0;
        for (int a = 0; a < kAzimuths; ++a) {
            const int cell = h * kAzimuths + a;
            const float cosine = glm::dot(normal, cell_direction_[cell]) + sine_below;
            if (cosine > -kHalfCell)
                sum += static_cast<double>(cell_density_[cell] * std::max(cosine, 0.25f * kHalfCell));
            row_sum[cell] = sum;
        }
        total += sum;
        row_end[h] = total;
    }

    DomeSamples samples;
    samples.weights.resize(instants_.size());
    if (total <= 0.0) return samples;  // a surface that faces straight down sees no sky
    samples.directions.reserve(count);
    int h = 0;
    for (int i = 0; i < count; ++i) {
        const double target = (i + 0.5) / count * total;
        while (h + 1 < kHeights && row_end[h] <= target) ++h;
        const double* row = &row_sum[h * kAzimuths];
        const double row_mass = row[kAzimuths - 1];
        const double up = std::clamp((target - (row_end[h] - row_mass)) / row_mass, 0.0, 1.0);
        const double turns = i * kGoldenRatio;
        const double wanted = (turns - std::floor(turns)) * row_mass;
        const int column = static_cast<int>(
            std::min<std::ptrdiff_t>(std::upper_bound(row, row + kAzimuths, wanted) - row, kAzimuths - 1));
        const double before = column == 0 ? 0.0 : row[column - 1];
        const double cell_mass = row[column] - before;
        if (cell_mass <= 0.0) continue;
        const double across = std::clamp((wanted - before) / cell_mass, 0.0, 1.0);
        const Vec3f direction = direction_at(column + across, h + up);
        const float cosine = glm::dot(normal, direction);
        if (cosine <= -sine_below || (has_cosine && cosine <= 0.0f)) continue;
        // 1 / (N p): the solid angle that this direction stands for.
        const double solid_angle = kCellSolidAngle * total / (cell_mass * count);
        const float measure = static_cast<float>(solid_angle) * (has_cosine ? cosine : 1.0f);
        samples.directions.push_back(direction);
        samples.view_factor_weight.push_back(measure / static_cast<float>(kPi));
        for (std::size_t k = 0; k < instants_.size(); ++k) {
            samples.weights[k].push_back(measure * sky_luminance(instants_[k].sky, direction));
        }
    }

    // Ratio estimator: without obstacles the weights add up to the quadrature over the table.
    const auto cosine_of = [&](std::size_t j) {
        return has_cosine ? 1.0f : std::max(0.0f, glm::dot(normal, samples.directions[j]));
    };
    double view_factor = 0.0;
    for (std::size_t j = 0; j < samples.size(); ++j)
        view_factor += static_cast<double>(samples.view_factor_weight[j] * cosine_of(j));
    const double exact_view_factor = 0.5 * (1.0 + static_cast<double>(normal.z));
    if (view_factor > 0.0) {
        for (float& weight : samples.view_factor_weight) weight *= static_cast<float>(exact_view_factor / view_factor);
    }
    for (std::size_t k = 0; k < instants_.size(); ++k) {
        Vec3d sum(0.0);
        for (std::size_t j = 0; j < samples.size(); ++j) sum += Vec3d(samples.weights[k][j] * cosine_of(j));
        const Vec3d exact = Vec3d(unobstructed_irradiance(k, normal));
        Rgb scale(1.0f);
        for (int c = 0; c < 3; ++c) {
            if (sum[c] > 0.0) scale[c] = static_cast<float>(exact[c] / sum[c]);
        }
        for (Rgb& weight : samples.weights[k]) weight *= scale;
    }
    return samples;
}

Rgb DomeSampler::unobstructed_irradiance(std::size_t k, const Vec3f& normal) const {
    // A uniform sky has a closed form, E = πL (1 + n_z) / 2: the table's error would be all that is left of the
    // analytic cases.
    if (const auto* uniform = std::get_if<UniformSky>(&instants_[k].sky)) {
        return Rgb(static_cast<float>(kPi) * uniform->luminance_cd_m2 * 0.5f * (1.0f + normal.z));
    }
    Vec3d sum(0.0);
    for (int cell = 0; cell < kCells; ++cell) {
        const float cosine = glm::dot(normal, cell_direction_[cell]);
        if (cosine > 0.0f) sum += Vec3d(cosine * cell_luminance_[k][cell]);
    }
    return Rgb(sum * kCellSolidAngle);
}

}  // namespace skybake
