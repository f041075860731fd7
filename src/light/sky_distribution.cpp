#include "light/sky_distribution.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace skybake {

namespace {

// As fine as DomeSampler's table: azimuth × height z = sin(elevation).
constexpr int kAzimuths = 256;
constexpr int kHeights = 64;
constexpr double kCellSolidAngle = 2.0 * kPi / (kAzimuths * kHeights);
constexpr int kSubdivision = 2;      // points a side at which a cell's mean luminance is taken
constexpr double kEvenShare = 0.03;  // of the mass: what a cell's four points may have missed stays possible
constexpr float kHalfCell = 0.014f;  // half a cell's diagonal: a cell that the surface's horizon cuts keeps some mass

Vec3f direction_at(double azimuth_cell, double height_cell) {
    const double azimuth = azimuth_cell * (2.0 * kPi / kAzimuths);
    const double z = height_cell / kHeights;
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return Vec3f(Vec3d(r * std::sin(azimuth), r * std::cos(azimuth), z));
}

}  // namespace

SkyDistribution::SkyDistribution(const SkyModel& sky, const std::optional<Vec3f>& normal) {
    std::vector<double> mass(kAzimuths * kHeights), cosine(mass.size(), 1.0);
    double cosine_sum = 0.0, mass_sum = 0.0;
    for (int h = 0; h < kHeights; ++h) {
        for (int a = 0; a < kAzimuths; ++a) {
            const std::size_t cell = static_cast<std::size_t>(h * kAzimuths + a);
            double mean = 0.0;
            for (int k = 0; k < kSubdivision * kSubdivision; ++k) {
                mean += static_cast<double>(
                    luminance(sky_luminance(sky, direction_at(a + (k % kSubdivision + 0.5) / kSubdivision,
                                                              h + (k / kSubdivision + 0.5) / kSubdivision))));
            }
            if (normal) {
                const float c = glm::dot(*normal, direction_at(a + 0.5, h + 0.5));
                cosine[cell] = c > -kHalfCell ? static_cast<double>(std::max(c, 0.25f * kHalfCell)) : 0.0;
            }
            mass[cell] = mean / (kSubdivision * kSubdivision) * cosine[cell];
            mass_sum += mass[cell];
            cosine_sum += cosine[cell];
        }
    }
    total_ = mass_sum * kCellSolidAngle;
    if (!(mass_sum > 0.0)) return;
    for (std::size_t cell = 0; cell < mass.size(); ++cell)
        mass[cell] = (1.0 - kEvenShare) * mass[cell] + kEvenShare * mass_sum / cosine_sum * cosine[cell];
    cells_ = CellDistribution(std::move(mass), kAzimuths);
}

SkyDistribution::Sample SkyDistribution::sample(float u, float v) const {
    const CellDistribution::Place place = cells_.sample(v, u);
    return {direction_at(place.column, place.row), pdf_of(place.cell)};
}

float SkyDistribution::pdf_of(std::size_t cell) const {
    return static_cast<float>(cells_.mass(cell) / (cells_.total() * kCellSolidAngle));
}

float SkyDistribution::pdf(const Vec3f& direction) const {
    if (direction.z < 0.0f || !(total_ > 0.0)) return 0.0f;
    double azimuth = std::atan2(static_cast<double>(direction.x), static_cast<double>(direction.y)) / (2.0 * kPi);
    if (azimuth < 0.0) azimuth += 1.0;
    const int a = std::clamp(static_cast<int>(azimuth * kAzimuths), 0, kAzimuths - 1);
    const int h = std::clamp(static_cast<int>(direction.z * kHeights), 0, kHeights - 1);
    return pdf_of(static_cast<std::size_t>(h * kAzimuths + a));
}

}  // namespace skybake
