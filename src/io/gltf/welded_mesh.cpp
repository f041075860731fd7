#include "io/gltf/welded_mesh.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "base/error.h"

namespace skybake::io {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A triangle with all that decides where it goes.
struct Placed {
    std::uint32_t material = 0;
    std::uint32_t page = 0;
    std::uint32_t chart = 0;
    std::uint32_t triangle = 0;
    friend auto operator<=>(const Placed&, const Placed&) = default;
};

std::vector<Placed> placed_triangles(const Scene& scene, const Atlas& atlas) {
    std::vector<Placed> placed;
    placed.reserve(scene.triangles.size());
    for (std::size_t c = 0; c < atlas.charts.size(); ++c) {
        for (const std::uint32_t triangle : atlas.charts[c].triangles) {
            SKYBAKE_DCHECK_LT(triangle, scene.triangles.size());
            const Face& face = scene.faces[scene.triangle_face[triangle].index()];
            placed.push_back(
                {face.material.value, atlas.charts[c].page.value, static_cast<std::uint32_t>(c), triangle});
        }
    }
    std::sort(placed.begin(), placed.end());
    return placed;
}

/// The bits of a vertex in a fixed order: equal vertices, and only they, have equal keys.
std::array<std::uint32_t, 10> key_of(const WeldedVertex& v) {
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
    return {bits(v.position.x), bits(v.position.y),  bits(v.position.z),  bits(v.normal.x), bits(v.normal.y),
            bits(v.normal.z),   bits(v.albedo_uv.x), bits(v.albedo_uv.y), bits(v.texel.x),  bits(v.texel.y)};
}

/// Appends one chart's triangles of one primitive to the mesh.
class ChartWelder {
  public:
    ChartWelder(const Scene& scene, const Atlas& atlas) : scene_(scene), atlas_(atlas) {}

    void append(const Placed* begin, const Placed* end, WeldedPrimitive& primitive, WeldedMesh& mesh) {
        const Chart& chart = atlas_.charts[begin->chart];
        corners_.clear();
        for (const Placed* p = begin; p != end; ++p) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const WeldedVertex vertex = vertex_at(scene_, atlas_, chart, 3 * p->triangle + k);
                primitive.bounds.extend(vertex.position);
                corners_.push_back({key_of(vertex), 3 * p->triangle + k, static_cast<std::uint32_t>(corners_.size())});
            }
        }
        std::sort(corners_.begin(), corners_.end(),
                  [](const Corner& a, const Corner& b) { return a.key != b.key ? a.key < b.key : a.order < b.order; });
        // Equal corners stand together now, the earliest first; vertices are numbered by that earliest one, so
        // neighbours stay neighbours.
        first_of_.resize(corners_.size());
        corner_at_.resize(corners_.size());
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const bool is_repeat = i > 0 && corners_[i].key == corners_[i - 1].key;
            first_of_[corners_[i].order] = is_repeat ? first_of_[corners_[i - 1].order] : corners_[i].order;
            corner_at_[corners_[i].order] = corners_[i].corner;
        }
        vertex_of_.assign(corners_.size(), kNone);
        for (std::size_t i = 0; i < corner_at_.size(); ++i) {
            std::uint32_t& vertex = vertex_of_[first_of_[i]];
            if (vertex == kNone) {
                vertex = static_cast<std::uint32_t>(mesh.vertex_corner.size() - primitive.vertex_begin);
                mesh.vertex_corner.push_back(corner_at_[i]);
            }
            mesh.indices.push_back(vertex);
        }
    }

  private:
    struct Corner {
        std::array<std::uint32_t, 10> key;
        std::uint32_t corner;
        std::uint32_t order;
    };
    const Scene& scene_;
    const Atlas& atlas_;
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> first_of_;
    std::vector<std::uint32_t> corner_at_;
    std::vector<std::uint32_t> vertex_of_;
};

}  // namespace

WeldedVertex vertex_at(const Scene& scene, const Atlas& atlas, const Chart& chart, std::uint32_t corner) {
    const std::uint32_t t = corner / 3;
    const std::uint32_t k = corner % 3;
    const std::array<Vec3f, 3>& triangle = scene.triangles[t];
    Vec3f normal = chart.normal;
    if (chart.min_normal_cosine < 1.0f) {
        const Vec3f scaled = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        if (glm::dot(scaled, scaled) > 0.0f) normal = scaled;
    }
    return {triangle[k], glm::normalize(normal), scene.triangle_uvs[t][k], atlas.triangle_texels[t][k]};
}

WeldedMesh weld(const Scene& scene, const Atlas& atlas) {
    if (scene.triangles.size() > kNone / 3)
        throw InputError("the city has more triangles than one GLB can hold. Bake it in parts.");
    const std::vector<Placed> placed = placed_triangles(scene, atlas);
    WeldedMesh mesh;
    mesh.indices.reserve(3 * placed.size());
    ChartWelder welder(scene, atlas);
    for (std::size_t begin = 0; begin < placed.size();) {
        WeldedPrimitive primitive;
        primitive.material = MaterialId(placed[begin].material);
        primitive.page = PageId(placed[begin].page);
        primitive.vertex_begin = mesh.vertex_corner.size();
        primitive.index_begin = mesh.indices.size();
        std::size_t end = begin;
        while (end < placed.size() && placed[end].material == placed[begin].material &&
               placed[end].page == placed[begin].page) {
            std::size_t chart_end = end;
            while (chart_end < placed.size() && placed[chart_end].material == placed[begin].material &&
                   placed[chart_end].chart == placed[end].chart) {
                ++chart_end;
            }
            welder.append(placed.data() + end, placed.data() + chart_end, primitive, mesh);
            end = chart_end;
        }
        primitive.vertex_end = mesh.vertex_corner.size();
        primitive.index_end = mesh.indices.size();
        mesh.primitives.push_back(primitive);
        begin = end;
    }
    return mesh;
}

}  // namespace skybake::io
