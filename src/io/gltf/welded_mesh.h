// The triangles of a scene as indexed primitives, one for each (material, page): the geometry of the glTF writer.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/atlas.h"
#include "base/box.h"
#include "base/vec.h"
#include "scene/scene.h"

namespace skybake::io {

/// What a corner of a triangle brings to a vertex. Corners of one chart with the same bits share a vertex.
struct WeldedVertex {
    Vec3f position{0.0f};   // world frame, z up
    Vec3f normal{0.0f};     // unit
    Vec2f albedo_uv{0.0f};  // (0, 0) lower left, as in the scene
    Vec2f texel{0.0f};      // page texel coordinates
};

struct WeldedPrimitive {
    MaterialId material;
    PageId page;
    std::uint64_t vertex_begin = 0, vertex_end = 0;  // into WeldedMesh::vertex_corner
    std::uint64_t index_begin = 0, index_end = 0;    // into WeldedMesh::indices
    Box3f bounds;                                    // world frame
};

/// Vertices are kept as the corner that they come from (4 bytes instead of 44), since a city has millions.
struct WeldedMesh {
    std::vector<WeldedPrimitive> primitives;   // sorted by material, then page
    std::vector<std::uint32_t> vertex_corner;  // 3 × scene triangle + corner, one a vertex
    std::vector<std::uint32_t> indices;        // three a triangle, counted from the primitive's first vertex
};

/// Flat normals: the chart's own, or the triangle's where a chart holds nearly coplanar ones. Triangles of one chart
/// stand together, charts in the order of the atlas. O(n log n).
WeldedMesh weld(const Scene& scene, const Atlas& atlas);

/// The vertex at a corner (3 × scene triangle + corner) of a chart's triangle.
WeldedVertex vertex_at(const Scene& scene, const Atlas& atlas, const Chart& chart, std::uint32_t corner);

}  // namespace skybake::io
