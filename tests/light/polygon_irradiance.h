// Light from an evenly bright polygon in closed form.
#pragma once

#include <cmath>
#include <vector>

#include "base/vec.h"

namespace skybake {

/// J. H. Lambert 1760: irradiance by an evenly bright polygon of luminance L: E = L/2 Σ θ_i (Γ_i · n).
inline double polygon_irradiance(const std::vector<Vec3d>& corners, const Vec3d& point, const Vec3d& normal,
                                 double radiance) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = glm::normalize(corners[i] - point),
                    b = glm::normalize(corners[(i + 1) % corners.size()] - point);
        sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), normal);
    }
    return 0.5 * radiance * std::abs(sum);
}

}  // namespace skybake
