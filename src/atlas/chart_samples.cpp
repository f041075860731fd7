#include "atlas/chart_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skybake {

namespace {

// How far a moved point goes inside, in texels: off the very edge, where the next wall stands.
constexpr float kInset = 0.05f;

float cross(const Vec2f& a, const Vec2f& b) {
    return a.x * b.y - a.y * b.x;
}

/// Barycentric weights of p; all ≥ 0 inside, whatever the orientation. A triangle without area gives negative weights.
Vec3f barycentric(const std::array<Vec2f, 3>& t, const Vec2f& p) {
    const float area = cross(t[1] - t[0], t[2] - t[0]);
    if (std::abs(area) < 1e-12f) return Vec3f(-1.0f);
    const float w1 = cross(p - t[0], t[2] - t[0]) / area;
    const float w2 = cross(t[1] - t[0], p - t[0]) / area;
    return {1.0f - w1 - w2, w1, w2};
}

bool contains(const std::array<Vec2f, 3>& t, const Vec2f& p) {
    const Vec3f w = barycentric(t, p);
    return w.x >= 0.0f && w.y >= 0.0f && w.z >= 0.0f;
}

Vec2f nearest_on_segment(const Vec2f& a, const Vec2f& b, const Vec2f& p) {
    const Vec2f ab = b - a;
    const float length2 = glm::dot(ab, ab);
    const float t = length2 > 0.0f ? std::clamp(glm::dot(p - a, ab) / length2, 0.0f, 1.0f) : 0.0f;
    return a + t * ab;
}

Vec2f nearest_on_border(const std::array<Vec2f, 3>& t, const Vec2f& p) {
    Vec2f best = t[0];
    float best2 = std::numeric_limits<float>::max();
    for (int k = 0; k < 3; ++k) {
        const Vec2f q = nearest_on_segment(t[k], t[(k + 1) % 3], p);
        const float d2 = glm::dot(q - p, q - p);
        if (d2 < best2) {
            best2 = d2;
            best = q;
        }
    }
    return best;
}

/// The point on the triangle above `p` (texels): the plane point with the height interpolated between the corners.
Vec3f lift(const Chart& chart, const std::array<Vec3f, 3>& corners, const std::array<Vec2f, 3>& texels,
           const Vec2f& p) {
    Vec3f w = glm::max(barycentric(texels, p), Vec3f(0.0f));
    const float sum = w.x + w.y + w.z;
    w = sum > 0.0f ? w / sum : Vec3f(1.0f / 3.0f);
    float height = 0.0f;
    for (int k = 0; k < 3; ++k) height += w[k] * glm::dot(corners[k] - chart.origin, chart.normal);
    return chart.origin + p.x * chart.u + p.y * chart.v + height * chart.normal;
}

}  // namespace

Vec3f shading_normal(const Scene& scene, const Chart& chart, std::uint32_t triangle) {
    const std::array<Vec3f, 3>& t = scene.triangles[triangle];
    const Vec3f vector = glm::cross(t[1] - t[0], t[2] - t[0]);
    const float length = glm::length(vector);
    const Vec3f normal = length > 2e-6f ? vector / length : chart.normal;
    return glm::dot(normal, chart.normal) < 0.1f ? chart.normal : normal;
}

ChartSamples sample_chart(const Scene& scene, const Chart& chart) {
    ChartSamples samples;
    samples.size = chart.size;
    const std::size_t count = static_cast<std::size_t>(chart.size.x) * static_cast<std::size_t>(chart.size.y);
    samples.cover.assign(count, ChartSamples::Cover::none);
    samples.position.resize(count);
    samples.triangle.resize(count);
    std::vector<float> distance2(count, std::numeric_limits<float>::max());
    samples.triangle_texels.reserve(chart.triangles.size());

    for (const std::uint32_t triangle : chart.triangles) {
        const std::array<Vec3f, 3>& corners = scene.triangles[triangle];
        const std::array<Vec2f, 3> t{texel_coordinate(chart, corners[0]), texel_coordinate(chart, corners[1]),
                                     texel_coordinate(chart, corners[2])};
        samples.triangle_texels.push_back(t);
        const Vec2f center = (t[0] + t[1] + t[2]) / 3.0f;
        const Vec2f lo = glm::min(glm::min(t[0], t[1]), t[2]), hi = glm::max(glm::max(t[0], t[1]), t[2]);
        const int column_end = std::min(chart.size.x, static_cast<int>(std::floor(hi.x + 1e-3f)) + 1);
        const int row_end = std::min(chart.size.y, static_cast<int>(std::floor(hi.y + 1e-3f)) + 1);
        const int row_begin = std::clamp(static_cast<int>(std::floor(lo.y - 1e-3f)), 0, chart.size.y - 1);
        const int column_begin = std::clamp(static_cast<int>(std::floor(lo.x - 1e-3f)), 0, chart.size.x - 1);
        for (int row = row_begin; row < std::max(row_end, row_begin + 1); ++row) {
            for (int column = column_begin; column < std::max(column_end, column_begin + 1); ++column) {
                const std::size_t i = samples.index(column, row);
                if (samples.cover[i] >= ChartSamples::Cover::center) continue;
                const Vec2f p(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f);
                if (contains(t, p)) {
                    bool is_whole = true;
                    for (int k = 0; k < 4; ++k) {
                        const Vec2f corner = p + Vec2f(k & 1 ? 0.5f : -0.5f, k & 2 ? 0.5f : -0.5f);
                        is_whole = is_whole && contains(t, corner);
                    }
                    samples.cover[i] = is_whole ? ChartSamples::Cover::whole : ChartSamples::Cover::center;
                    samples.position[i] = lift(chart, corners, t, p);
                    samples.triangle[i] = triangle;
                    continue;
                }
                const Vec2f q = nearest_on_border(t, p);
                const Vec2f off = glm::abs(q - p);
                // A thousandth more than half a texel: a polygon's border on a texel's border still touches it.
                if (std::max(off.x, off.y) > 0.501f || glm::dot(off, off) >= distance2[i]) continue;
                distance2[i] = glm::dot(off, off);
                const Vec2f inward = center - q;
                const float length = glm::length(inward);
                const Vec2f inside = length > 0.0f ? q + inward * (std::min(kInset, 0.5f * length) / length) : q;
                samples.cover[i] = ChartSamples::Cover::moved;
                samples.position[i] = lift(chart, corners, t, inside);
                samples.triangle[i] = triangle;
            }
        }
    }
    return samples;
}

std::optional<Vec3f> point_on_triangle(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                       std::uint32_t triangle, const Vec2f& point) {
    const auto place = std::lower_bound(chart.triangles.begin(), chart.triangles.end(), triangle);
    const std::array<Vec2f, 3>& texels =
        samples.triangle_texels[static_cast<std::size_t>(place - chart.triangles.begin())];
    if (!contains(texels, point)) return std::nullopt;
    return lift(chart, scene.triangles[triangle], texels, point);
}

}  // namespace skybake
