// Where each square metre of the city lies in the lightmap: planar charts, packed into pages.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"
#include "scene/scene.h"

namespace skybake {

/// A plane of texels with the triangles that lie in it. Texel (i, j) has its centre at origin + (i + 0.5) u + (j + 0.5)
/// v, local metres; u runs along the wall's own horizontal, v downwards (row 0 is the top), both one texel long (at
/// most: a wall is divided into whole texels from edge to edge), and u × v points against the normal.
struct Chart {
    PageId page;
    Vec2i position{0};  // column and row of texel (0, 0) in its page
    Vec2i size{0};      // columns and rows
    Vec3f origin{0.0f};
    Vec3f u{0.0f};
    Vec3f v{0.0f};
    Vec3f normal{0.0f, 0.0f, 1.0f};
    /// Cosine of the largest angle between the chart's normal and that of one of its triangles: 1 for a planar chart.
    /// Charts of terrain and scanned meshes hold nearly coplanar triangles; their texels are projected along the normal
    /// onto the surface.
    float min_normal_cosine = 1.0f;
    std::vector<std::uint32_t> triangles;  // indices into Scene::triangles, ascending
    std::uint64_t stable_id = 0;           // from object ids and surfaces: does not hang on the order of the file
};

struct AtlasPage {
    int width = 0;
    int height = 0;
};

/// An edge that two charts of one object share.
struct Seam {
    ChartId a, b;
    Vec3f begin{0.0f}, end{0.0f};  // local metres
    bool is_smooth = false;        // the charts bend by less than 25°: their light must agree along it
};

struct Atlas {
    float texel_m = 0.5f;
    std::vector<Chart> charts;
    std::vector<AtlasPage> pages;         // at most kMaxPageSize squared
    std::vector<ChartId> triangle_chart;  // one a scene triangle
    std::vector<std::array<Vec2f, 3>>
        triangle_texels;  // page texel coordinates of the corners; (0, 0) is the page's upper left corner

    std::vector<Seam> seams;

    /// Texels of all charts' rectangles, gutters left out.
    std::uint64_t texel_count() const;
};

/// Where a point falls in the chart, in texels: texel (i, j) covers [i, i + 1) × [j, j + 1).
Vec2f texel_coordinate(const Chart& chart, const Vec3f& point);

inline constexpr int kMaxPageSize = 2048;
/// Texels of light that are filled about each chart, so that bilinear lookup and two mip levels stay inside it.
inline constexpr int kGutter = 2;

struct AtlasOptions {
    float texel_m = 0.5f;
};

/// Charts and packing of the whole scene: every triangle with area belongs to exactly one chart. Deterministic.
Atlas build_atlas(const Scene& scene, const AtlasOptions& options);

}  // namespace skybake
