// Based on: Reichinger, Maierhofer, Tobler, "Skylight Illumination and Rendering of Urban Scenes", 2006, §4.2 (direct
// sampling of the dome with a Halton series). Deviations: the points follow cosine times luminance instead of covering
// the dome evenly, and they are Fibonacci's lattice (i/N, frac(i/φ)), which has less than half of the Halton points'
// error at equal N (docs/decisions/0005-fibonacci-directions.md).
#include "sky/dome_sampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace skybake {

namespace {

// Cells of equal solid angle: azimuth × height z = sin(elevation). 1.4° × 0.9° at the horizon: narrower than any
// feature of the formulas' skies.
constexpr int kAzimuths = 256;
constexpr int kHeights = 64;
constexpr int kCells = kAzimuths * kHeights;
constexpr double kCellSolidAngle = 2.0 * kPi / kCells;
// Points a side at which a cell's mean luminance is taken: the horizon's gradient is steep, and a picture holds a sun
// of half a degree.
constexpr int kCellSubdivision = 4;
constexpr int kImageSubdivision = 32;
// A cell whose brightest point is more than so many times its mean: points and parts a side. With 32 points the sun of
// a picture has 0.1 % of error, with 128 0.03 %.
constexpr float kFineContrast = 2.0f;
constexpr int kFineSubdivision = 128;
constexpr int kFineParts = 32;
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

/// Where in `sums`, which rise, the share `u` in [0, 1] of the last one lies: the place, and how far into it, which
/// replaces `u`.
int find_place(std::span<const float> sums, double& u) {
    const double target = u * static_cast<double>(sums.back());
    const std::ptrdiff_t place =
        std::min<std::ptrdiff_t>(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin(),
                                 static_cast<std::ptrdiff_t>(sums.size()) - 1);
    const double before = place == 0 ? 0.0 : static_cast<double>(sums[place - 1]);
    const double width = static_cast<double>(sums[place]) - before;
    u = width > 0.0 ? std::clamp((target - before) / width, 0.0, 1.0) : 0.5;
    return static_cast<int>(place);
}

/// Moves a point of a cell to where its finer parts want it: the height first, then the azimuth. Returns the density
/// there over the cell's mean.
double warp_within(std::span<const float> density, std::span<const float> row_sum, std::span<const float> height_sum,
                   double& across, double& up) {
    const int row = find_place(height_sum, up);
    const int column = find_place(row_sum.subspan(row * kFineParts, kFineParts), across);
    up = (row + up) / kFineParts;
    across = (column + across) / kFineParts;
    return static_cast<double>(density[row * kFineParts + column]);
}

}  // namespace

DomeSampler::DomeSampler(std::span<const Daylight> instants)
    : fine_of_cell_(kCells), instants_(instants.begin(), instants.end()) {
    cell_direction_.resize(kCells);
    for (int a = 0; a < kAzimuths; ++a) {
        for (int h = 0; h < kHeights; ++h) cell_direction_[h * kAzimuths + a] = direction_at(a + 0.5, h + 0.5);
    }
    cell_density_.assign(kCells, static_cast<float>(kUniformShare));
    std::vector<double> instant_scale;  // from luminance to density
    std::vector<char> is_contrasty(kCells, 0);
    for (const Daylight& instant : instants_) {
        const int parts = std::holds_alternative<ImageSky>(instant.sky) ? kImageSubdivision : kCellSubdivision;
        std::vector<CellLight>& light = cell_light_.emplace_back(kCells);
        tbb::parallel_for(0, kCells, [&](int cell) {
            float brightest = 0.0f;
            light[cell] = mean_light(instant.sky, cell, parts, brightest);
            if (brightest <= kFineContrast * luminance(light[cell].luminance)) return;
            light[cell] = mean_light(instant.sky, cell, kFineSubdivision, brightest);
            is_contrasty[cell] = 1;
        });
        double sum = 0.0;
        for (const CellLight& cell : light) sum += static_cast<double>(luminance(cell.luminance));
        const double share = (1.0 - kUniformShare) * kCells / static_cast<double>(instants_.size());
        instant_scale.push_back(sum > 0.0 ? share / sum : 0.0);
        for (int cell = 0; cell < kCells; ++cell)
            cell_density_[cell] += static_cast<float>(instant_scale.back() * luminance(light[cell].luminance));
    }
    for (int h = 0; h < kHeights; ++h) {
        for (int a = 0; a < kAzimuths; ++a) {
            if (is_contrasty[h * kAzimuths + a]) divide_cell(a, h, instant_scale);
        }
    }
}

DomeSampler::CellLight DomeSampler::mean_light(const SkyModel& sky, int cell, int parts, float& brightest) {
    const int h = cell / kAzimuths, a = cell % kAzimuths;
    Vec3d total(0.0);
    Vec3d moment(0.0);
    brightest = 0.0f;
    for (int i = 0; i < parts; ++i) {
        for (int j = 0; j < parts; ++j) {
            const Vec3f direction = direction_at(a + (i + 0.5) / parts, h + (j + 0.5) / parts);
            const Rgb value = sky_luminance(sky, direction);
            const float brightness = luminance(value);
            brightest = std::max(brightest, brightness);
            total += Vec3d(value);
            moment += Vec3d(brightness * direction);
        }
    }
    const double sum = 0.2126 * total.x + 0.7152 * total.y + 0.0722 * total.z;
    return {Rgb(total / static_cast<double>(parts * parts)),
            sum > 0.0 ? Vec3f(moment / sum) : direction_at(a + 0.5, h + 0.5)};
}

void DomeSampler::divide_cell(int azimuth, int height, std::span<const double> instant_scale) {
    constexpr int kPoints = kFineSubdivision / kFineParts;  // a side of each part
    FineCell fine;
    fine.density.assign(kFineParts * kFineParts, static_cast<float>(kUniformShare));
    double sum = 0.0;
    for (int j = 0; j < kFineSubdivision; ++j) {
        for (int i = 0; i < kFineSubdivision; ++i) {
            const Vec3f direction =
                direction_at(azimuth + (i + 0.5) / kFineSubdivision, height + (j + 0.5) / kFineSubdivision);
            float& density = fine.density[j / kPoints * kFineParts + i / kPoints];
            for (std::size_t k = 0; k < instants_.size(); ++k)
                density += static_cast<float>(instant_scale[k] / (kPoints * kPoints) *
                                              luminance(sky_luminance(instants_[k].sky, direction)));
        }
    }
    for (const float density : fine.density) sum += static_cast<double>(density);
    const float mean = static_cast<float>(sum / (kFineParts * kFineParts));
    float below = 0.0f;
    for (int j = 0; j < kFineParts; ++j) {
        float row = 0.0f;
        for (int i = 0; i < kFineParts; ++i) {
            float& density = fine.density[j * kFineParts + i];
            density /= mean;
            fine.row_sum.push_back(row += density);
        }
        fine.height_sum.push_back(below += row);
    }
    fine_of_cell_[height * kAzimuths + azimuth] = static_cast<std::uint32_t>(fine_cells_.size());
    fine_cells_.push_back(std::move(fine));
}

DomeSamples DomeSampler::sample(const Vec3f& normal, int count) const {
    return sample_about(normal, 0.0f, true, count);
}

DomeSamples DomeSampler::sample_relief(const Vec3f& normal, float min_normal_cosine, int count) const {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - min_normal_cosine * min_normal_cosine));
    return sample_about(normal, sine, false, count);
}

DomeSampler::CellSums DomeSampler::cell_sums(const Vec3f& normal, float sine_below) const {
    // Mass of each cell, summed along each row of one height. The cosine of a cell is that of its centre, a little
    // raised, so that a cell that the surface's horizon cuts keeps some mass: half a cell's diagonal is 0.014.
    constexpr float kHalfCell = 0.014f;
    CellSums sums{std::vector<double>(kCells), std::vector<double>(kHeights), 0.0};
    for (int h = 0; h < kHeights; ++h) {
        double sum = 0.0;
        for (int a = 0; a < kAzimuths; ++a) {
            const int cell = h * kAzimuths + a;
            const float cosine = glm::dot(normal, cell_direction_[cell]) + sine_below;
            if (cosine > -kHalfCell)
                sum += static_cast<double>(cell_density_[cell] * std::max(cosine, 0.25f * kHalfCell));
            sums.row_sum[cell] = sum;
        }
        sums.total += sum;
        sums.row_end[h] = sums.total;
    }
    return sums;
}

DomeSamples DomeSampler::sample_about(const Vec3f& normal, float sine_below, bool has_cosine, int count) const {
    SKYBAKE_CHECK_LT(0, count);
    const CellSums sums = cell_sums(normal, sine_below);
    DomeSamples samples;
    samples.weights.resize(instants_.size());
    if (sums.total <= 0.0) return samples;  // a surface that faces straight down sees no sky
    samples.directions.reserve(count);
    int h = 0;
    for (int i = 0; i < count; ++i) {
        const double target = (i + 0.5) / count * sums.total;
        while (h + 1 < kHeights && sums.row_end[h] <= target) ++h;
        const double* row = &sums.row_sum[h * kAzimuths];
        const double row_mass = row[kAzimuths - 1];
        double up = std::clamp((target - (sums.row_end[h] - row_mass)) / row_mass, 0.0, 1.0);
        const double turns = i * kGoldenRatio;
        const double wanted = (turns - std::floor(turns)) * row_mass;
        const int column = static_cast<int>(
            std::min<std::ptrdiff_t>(std::upper_bound(row, row + kAzimuths, wanted) - row, kAzimuths - 1));
        const double before = column == 0 ? 0.0 : row[column - 1];
        const double cell_mass = row[column] - before;
        if (cell_mass <= 0.0) continue;
        double across = std::clamp((wanted - before) / cell_mass, 0.0, 1.0);
        double relative_density = 1.0;
        if (const auto fine = fine_of_cell_[h * kAzimuths + column]) {
            relative_density = warp_within(fine_cells_[*fine].density, fine_cells_[*fine].row_sum,
                                           fine_cells_[*fine].height_sum, across, up);
        }
        const Vec3f direction = direction_at(column + across, h + up);
        const float cosine = glm::dot(normal, direction);
        if (cosine <= -sine_below || (has_cosine && cosine <= 0.0f)) continue;
        // 1 / (N p): the solid angle that this direction stands for.
        const double solid_angle = kCellSolidAngle * sums.total / (cell_mass * relative_density * count);
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

std::vector<double> DomeSampler::pdf_solid_angle(const Vec3f& normal, std::span<const Vec3f> directions) const {
    const CellSums sums = cell_sums(normal, 0.0f);
    std::vector<double> pdf(directions.size(), 0.0);
    if (sums.total <= 0.0) return pdf;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3d direction(directions[i]);
        if (direction.z < 0.0) continue;
        const double turn = std::atan2(direction.x, direction.y) / (2.0 * kPi);
        const double x = (turn - std::floor(turn)) * kAzimuths;
        const double y = direction.z * kHeights;
        const int a = std::min(static_cast<int>(x), kAzimuths - 1);
        const int h = std::min(static_cast<int>(y), kHeights - 1);
        const double* row = &sums.row_sum[h * kAzimuths];
        pdf[i] = (row[a] - (a == 0 ? 0.0 : row[a - 1])) / (sums.total * kCellSolidAngle);
        if (const auto fine = fine_of_cell_[h * kAzimuths + a]) {
            const int across = std::clamp(static_cast<int>((x - a) * kFineParts), 0, kFineParts - 1);
            const int up = std::clamp(static_cast<int>((y - h) * kFineParts), 0, kFineParts - 1);
            pdf[i] *= static_cast<double>(fine_cells_[*fine].density[up * kFineParts + across]);
        }
    }
    return pdf;
}

Rgb DomeSampler::unobstructed_irradiance(std::size_t k, const Vec3f& normal) const {
    // A uniform sky has a closed form, E = πL (1 + n_z) / 2: the table's error would be all that is left of the
    // analytic cases.
    if (const auto* uniform = std::get_if<UniformSky>(&instants_[k].sky)) {
        return Rgb(static_cast<float>(kPi) * uniform->luminance_cd_m2 * 0.5f * (1.0f + normal.z));
    }
    Vec3d sum(0.0);
    for (int cell = 0; cell < kCells; ++cell) {
        const CellLight& light = cell_light_[k][cell];
        const float cosine = glm::dot(normal, light.direction);
        if (cosine > 0.0f) sum += Vec3d(cosine * light.luminance);
    }
    return Rgb(sum * kCellSolidAngle);
}

}  // namespace skybake
