// Where the light of each texel is taken.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "atlas/atlas.h"

namespace skybake {

/// The texels of one chart as points on the surface. Arrays have size.x × size.y entries, row 0 on top.
struct ChartSamples {
    enum class Cover : std::uint8_t {
        none,    // the texel touches no triangle
        moved,   // its centre lies outside the polygon: the nearest point inside stands for it
        center,  // its centre lies inside
        whole    // the whole texel lies inside one triangle
    };

    Vec2i size{0};
    std::vector<Cover> cover;
    std::vector<Vec3f> position;                        // on the surface (not lifted off it), local metres
    std::vector<std::uint32_t> triangle;                // which scene triangle the point lies in
    std::vector<std::array<Vec2f, 3>> triangle_texels;  // [i]: corners of chart.triangles[i] in texels of the chart

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(column);
    }
};

/// Unit normal of a scene triangle as light sees it: its own, or the chart's for a sliver.
Vec3f shading_normal(const Scene& scene, const Chart& chart, std::uint32_t triangle);

/// Every texel that touches the chart's polygon gets a point inside the polygon (DESIGN §4: none may take light from
/// the other side of a wall). A chart has at least one covered texel.
ChartSamples sample_chart(const Scene& scene, const Chart& chart);

/// Where the scene triangle, which must be one of the chart's, lies over a point in texels of the chart: local metres;
/// none where the point is outside it.
std::optional<Vec3f> point_on_triangle(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                       std::uint32_t triangle, const Vec2f& point);

}  // namespace skybake
