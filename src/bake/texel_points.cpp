#include "bake/texel_points.h"

#include <algorithm>

namespace skybake {

Vec3f TexelPoints::normal(std::size_t texel) const {
    return chart_.min_normal_cosine >= 1.0f ? chart_.normal : shading_normal(scene_, chart_, samples_.triangle[texel]);
}

std::optional<Vec3f> TexelPoints::subsample(int column, int row, int sub) const {
    const Vec2f point(static_cast<float>(column) + (static_cast<float>(sub % kSubdivision) + 0.5f) / kSubdivision,
                      static_cast<float>(row) + (static_cast<float>(sub / kSubdivision) + 0.5f) / kSubdivision);
    const auto on = [&](std::uint32_t triangle) -> std::optional<Vec3f> {
        const std::optional<Vec3f> p = point_on_triangle(scene_, chart_, samples_, triangle, point);
        if (!p) return std::nullopt;
        return *p + offset_ * shading_normal(scene_, chart_, triangle);
    };
    const std::uint32_t own = samples_.triangle[samples_.index(column, row)];
    if (const auto p = on(own)) return p;
    std::array<std::uint32_t, 9> seen{own};
    std::size_t count = 1;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, samples_.size.y - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, samples_.size.x - 1); ++x) {
            const std::size_t j = samples_.index(x, y);
            if (samples_.cover[j] == ChartSamples::Cover::none) continue;
            const std::uint32_t t = samples_.triangle[j];
            const auto end = seen.begin() + static_cast<std::ptrdiff_t>(count);
            if (std::find(seen.begin(), end, t) != end) continue;
            seen[count++] = t;
            if (const auto p = on(t)) return p;
        }
    }
    return std::nullopt;
}

}  // namespace skybake
