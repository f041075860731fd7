#include "bake/texel_points.h"

#include <algorithm>

namespace skybake {

Vec3f TexelPoints::normal(std::size_t texel) const {
    return chart_.min_normal_cosine >= 1.0f ? chart_.normal : shading_normal(scene_, chart_, samples_.triangle[texel]);
}

std::optional<Vec3f> TexelPoints::subsample(int column, int row, int sub) const {
    const std::size_t i = samples_.index(column, row);
    const Vec2f point(static_cast<float>(column) + (static_cast<float>(sub % kSubdivision) + 0.5f) / kSubdivision,
                      static_cast<float>(row) + (static_cast<float>(sub / kSubdivision) + 0.5f) / kSubdivision);
    if (samples_.cover[i] != ChartSamples::Cover::whole && !is_on_surface(column, row, point)) return std::nullopt;
    const Vec3f n = normal(i);
    const Vec2f own = texel_coordinate(chart_, samples_.position[i]);
    Vec3f off = (point.x - own.x) * chart_.u + (point.y - own.y) * chart_.v;
    off -= chart_.normal * (glm::dot(off, n) / glm::dot(chart_.normal, n));
    return samples_.position[i] + off + offset_ * n;
}

/// True when the point lies in the texel's triangle or one of those its neighbours lie in.
bool TexelPoints::is_on_surface(int column, int row, const Vec2f& point) const {
    std::array<std::uint32_t, 9> seen;
    std::size_t count = 0;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, samples_.size.y - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, samples_.size.x - 1); ++x) {
            const std::size_t j = samples_.index(x, y);
            if (samples_.cover[j] == ChartSamples::Cover::none) continue;
            const std::uint32_t t = samples_.triangle[j];
            const auto end = seen.begin() + static_cast<std::ptrdiff_t>(count);
            if (std::find(seen.begin(), end, t) != end) continue;
            seen[count++] = t;
            if (contains(samples_, chart_, t, point)) return true;
        }
    }
    return false;
}

}  // namespace skybake
