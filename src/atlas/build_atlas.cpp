#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <numeric>

#include "atlas/atlas.h"
#include "atlas/pack.h"
#include "base/check.h"
#include "base/hash_rng.h"

namespace skybake {

namespace {

// Triangles of one plane differ by the rounding of their files (1 mm integers) and by walls drawn in several pieces.
constexpr float kCoplanarDistance = 0.01f;  // metres
constexpr float kCoplanarCosine = 0.996f;   // 5°
// Charts of terrain: at 12° the texels stretch by 2 % and the directions spread over 2 % more sky.
constexpr float kReliefCosine = 0.978f;
// A chart stops growing here, so that it fits a page even when its frame turns by 45°.
constexpr float kMaxChartTexels = 1400.0f;
// Charts that bend less than 25° at their common edge should look like one surface.
constexpr float kSeamCosine = 0.906f;
// Faces smaller than this may join tilted neighbours on buildings too: domes, round towers, scanned ornament.
constexpr float kSmallFaceTexels = 16.0f;

Vec3f area_vector(const std::array<Vec3f, 3>& triangle) {
    return 0.5f * glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
}

/// Which triangles of the same object share an edge, in compressed rows.
struct Adjacency {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> neighbor;
    std::vector<std::uint8_t> edge;  // which edge of the triangle: corner `edge` to the next
};

Adjacency adjacency_of(const Scene& scene) {
    struct Edge {
        std::uint32_t object, a, b, triangle;
        std::uint8_t edge;
        auto key() const { return std::tie(object, a, b); }
    };
    // Corners of equal position get equal numbers.
    const std::size_t corner_count = 3 * scene.triangles.size();
    std::vector<std::uint32_t> order(corner_count);
    std::iota(order.begin(), order.end(), 0u);
    const auto position = [&](std::uint32_t corner) -> const Vec3f& { return scene.triangles[corner / 3][corner % 3]; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        const Vec3f &a = position(i), &b = position(j);
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    std::vector<std::uint32_t> vertex(corner_count);
    for (std::size_t i = 0, id = 0; i < corner_count; ++i) {
        if (i > 0 && position(order[i]) != position(order[i - 1])) ++id;
        vertex[order[i]] = static_cast<std::uint32_t>(id);
    }
    std::vector<Edge> edges;
    edges.reserve(corner_count);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const std::uint32_t object = scene.faces[scene.triangle_face[t].index()].object;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = vertex[3 * t + k], b = vertex[3 * t + (k + 1) % 3];
            edges.push_back({object, std::min(a, b), std::max(a, b), t, static_cast<std::uint8_t>(k)});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
        return std::tie(x.object, x.a, x.b, x.triangle) < std::tie(y.object, y.a, y.b, y.triangle);
    });
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint8_t>> pairs;
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin + 1;
        while (end < edges.size() && edges[end].key() == edges[begin].key()) ++end;
        // A chain instead of all pairs: enough to connect, and linear where strangers hang a thousand triangles on one
        // edge.
        for (std::size_t i = begin + 1; i < end; ++i) {
            pairs.emplace_back(edges[i - 1].triangle, edges[i].triangle, edges[i - 1].edge);
            pairs.emplace_back(edges[i].triangle, edges[i - 1].triangle, edges[i].edge);
        }
        begin = end;
    }
    std::sort(pairs.begin(), pairs.end());
    Adjacency adjacency;
    adjacency.first.assign(scene.triangles.size() + 1, 0);
    for (const auto& [from, to, edge] : pairs) ++adjacency.first[from + 1];
    std::partial_sum(adjacency.first.begin(), adjacency.first.end(), adjacency.first.begin());
    adjacency.neighbor.reserve(pairs.size());
    for (const auto& [from, to, edge] : pairs) {
        adjacency.neighbor.push_back(to);
        adjacency.edge.push_back(edge);
    }
    return adjacency;
}

struct Frame {
    Vec3f u, v, normal;
};

/// u horizontal, v downwards, seen from outside. Flat charts take `along` as their horizontal.
Frame frame_of(const Vec3f& normal, const Vec3f& along) {
    const Vec3f up(0.0f, 0.0f, 1.0f);
    const bool is_flat = std::abs(normal.z) > 0.98f;
    Vec3f u = is_flat ? along - glm::dot(along, normal) * normal : glm::cross(up, normal);
    u = glm::normalize(u);
    return {u, -glm::cross(normal, u), normal};
}

/// The longest edge that the chart does not share with itself: what a flat roof is aligned to.
Vec3f longest_border(const Scene& scene, const std::vector<std::uint32_t>& triangles) {
    struct Edge {
        Vec3f low, high;
        float length2;
    };
    const auto less = [](const Vec3f& a, const Vec3f& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::vector<Edge> edges;
    for (const std::uint32_t t : triangles) {
        for (int k = 0; k < 3; ++k) {
            Vec3f a = scene.triangles[t][k], b = scene.triangles[t][(k + 1) % 3];
            if (less(b, a)) std::swap(a, b);
            edges.push_back({a, b, glm::dot(b - a, b - a)});
        }
    }
    std::sort(edges.begin(), edges.end(),
              [&](const Edge& x, const Edge& y) { return x.low != y.low ? less(x.low, y.low) : less(x.high, y.high); });
    Vec3f longest(1.0f, 0.0f, 0.0f);
    float length2 = 0.0f;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto same = [&](std::size_t j) { return edges[i].low == edges[j].low && edges[i].high == edges[j].high; };
        if ((i > 0 && same(i - 1)) || (i + 1 < edges.size() && same(i + 1))) continue;
        const Vec3f horizontal(edges[i].high.x - edges[i].low.x, edges[i].high.y - edges[i].low.y, 0.0f);
        if (glm::dot(horizontal, horizontal) > length2) {
            length2 = glm::dot(horizontal, horizontal);
            longest = horizontal;
        }
    }
    return longest;
}

class ChartBuilder {
  public:
    ChartBuilder(const Scene& scene, float texel_m)
        : scene_(scene), texel_m_(texel_m), adjacency_(adjacency_of(scene)) {
        normal_.reserve(scene.triangles.size());
        face_normal_.resize(scene.faces.size());
        face_area_.resize(scene.faces.size());
        for (std::size_t f = 0; f < scene.faces.size(); ++f) {
            Vec3f sum(0.0f);
            for (std::uint32_t i = 0; i < scene.faces[f].triangle_count; ++i)
                sum += area_vector(scene.triangles[scene.faces[f].first_triangle + i]);
            face_area_[f] = glm::length(sum);
            face_normal_[f] = face_area_[f] > 0.0f ? sum / face_area_[f] : Vec3f(0.0f, 0.0f, 1.0f);
        }
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            const Vec3f vector = area_vector(scene.triangles[t]);
            const float length = glm::length(vector);
            // A sliver's own normal is noise: it lies in its polygon.
            normal_.push_back(length > 1e-6f ? vector / length : face_normal_[scene.triangle_face[t].index()]);
        }
        chart_of_.assign(scene.triangles.size(), kNone);
    }

    void build(Atlas& atlas) {
        for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
            if (chart_of_[t] == kNone) grow(t);
        }
        for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
            for (std::uint32_t i = adjacency_.first[t]; i < adjacency_.first[t + 1]; ++i) {
                const std::uint32_t a = chart_of_[t], b = chart_of_[adjacency_.neighbor[i]];
                if (a == b) continue;
                const int k = adjacency_.edge[i];
                const bool is_smooth = glm::dot(charts_[a].normal, charts_[b].normal) >= kSeamCosine;
                atlas.seams.push_back(
                    {ChartId(a), ChartId(b), scene_.triangles[t][k], scene_.triangles[t][(k + 1) % 3], is_smooth});
            }
        }
        atlas.charts = std::move(charts_);
    }

  private:
    static constexpr std::uint32_t kNone = ~0u;

    const Face& face_of(std::uint32_t triangle) const { return scene_.faces[scene_.triangle_face[triangle].index()]; }

    /// True where tilted neighbours may share a chart: on the ground, on meshes without semantics, among tiny faces.
    bool may_tilt(std::uint32_t triangle) const {
        const ObjectType type = scene_.objects[face_of(triangle).object].type;
        return is_ground(type) || type == ObjectType::generic || type == ObjectType::other ||
               face_area_[scene_.triangle_face[triangle].index()] < kSmallFaceTexels * texel_m_ * texel_m_;
    }

    void grow(std::uint32_t seed) {
        const Vec3f up(0.0f, 0.0f, 1.0f);
        Vec3f normal = normal_[seed];
        const bool is_relief = may_tilt(seed);
        if (is_relief && normal.z > kReliefCosine) normal = up;
        const Vec3f anchor = scene_.triangles[seed][0];
        const Frame frame = frame_of(normal, Vec3f(1.0f, 0.0f, 0.0f));
        Box2f box;
        const auto grown_box = [&](std::uint32_t t) {
            Box2f grown = box;
            for (const Vec3f& p : scene_.triangles[t]) grown.extend(Vec2f(glm::dot(p, frame.u), glm::dot(p, frame.v)));
            return grown;
        };
        const auto belongs = [&](std::uint32_t t) {
            const float cosine = glm::dot(normal_[t], normal);
            bool is_coplanar = cosine > kCoplanarCosine;
            for (const Vec3f& p : scene_.triangles[t])
                is_coplanar = is_coplanar && std::abs(glm::dot(p - anchor, normal)) < kCoplanarDistance;
            return is_coplanar || (is_relief && may_tilt(t) && cosine > kReliefCosine);
        };

        Chart chart;
        const std::uint32_t id = static_cast<std::uint32_t>(charts_.size());
        std::deque<std::uint32_t> queue{seed};
        chart_of_[seed] = id;
        box = grown_box(seed);
        Vec3f normal_sum(0.0f);
        while (!queue.empty()) {
            const std::uint32_t t = queue.front();
            queue.pop_front();
            chart.triangles.push_back(t);
            normal_sum += area_vector(scene_.triangles[t]);
            for (std::uint32_t i = adjacency_.first[t]; i < adjacency_.first[t + 1]; ++i) {
                const std::uint32_t next = adjacency_.neighbor[i];
                if (chart_of_[next] != kNone || !belongs(next)) continue;
                const Box2f grown = grown_box(next);
                if (std::max(grown.size().x, grown.size().y) > kMaxChartTexels * texel_m_) continue;
                box = grown;
                chart_of_[next] = id;
                queue.push_back(next);
            }
        }
        std::sort(chart.triangles.begin(), chart.triangles.end());
        const float length = glm::length(normal_sum);
        if (normal != up && length > 1e-6f) normal = normal_sum / length;
        finish(chart, normal, is_relief);
        charts_.push_back(std::move(chart));
    }

    /// Frame, extent and texel grid of a chart whose triangles are known.
    void finish(Chart& chart, const Vec3f& normal, bool is_relief) {
        const Frame frame =
            frame_of(normal, is_relief ? Vec3f(1.0f, 0.0f, 0.0f) : longest_border(scene_, chart.triangles));
        chart.normal = frame.normal;
        Box2f box;
        double height_sum = 0.0;
        for (const std::uint32_t t : chart.triangles) {
            for (const Vec3f& p : scene_.triangles[t]) {
                box.extend(Vec2f(glm::dot(p, frame.u), glm::dot(p, frame.v)));
                height_sum += static_cast<double>(glm::dot(p, frame.normal));
            }
            const float cosine = glm::dot(normal_[t], frame.normal);
            // Within half a degree is one plane: its own slant is that of rounded corners.
            if (cosine < 0.99996f)
                chart.min_normal_cosine = std::clamp(std::min(chart.min_normal_cosine, cosine), 0.1f, 1.0f);
        }
        Vec2f texel(texel_m_);
        for (int axis = 0; axis < 2; ++axis) {
            const float width = box.size()[axis];
            if (is_relief) {
                // The lattice of neighbouring pieces goes on.
                box.lo[axis] = std::floor(box.lo[axis] / texel_m_) * texel_m_;
                chart.size[axis] =
                    std::max(1, static_cast<int>(std::ceil((box.hi[axis] - box.lo[axis]) / texel_m_ - 1e-3f)));
            } else {
                // A whole number of texels from edge to edge: none is cut by a straight wall's border.
                chart.size[axis] = std::max(1, static_cast<int>(std::ceil(width / texel_m_ - 1e-3f)));
                texel[axis] = std::max(width / static_cast<float>(chart.size[axis]), 1e-4f);
            }
        }
        const double height = height_sum / static_cast<double>(3 * chart.triangles.size());
        chart.u = texel.x * frame.u;
        chart.v = texel.y * frame.v;
        chart.origin = box.lo.x * frame.u + box.lo.y * frame.v + static_cast<float>(height) * frame.normal;
        const std::uint32_t first = chart.triangles.front();
        const Face& face = face_of(first);
        chart.stable_id = hash_combine(hash_of(scene_.objects[face.object].id),
                                       hash_combine(face.source_index, first - face.first_triangle));
    }

    const Scene& scene_;
    float texel_m_;
    Adjacency adjacency_;
    std::vector<Vec3f> normal_, face_normal_;
    std::vector<float> face_area_;
    std::vector<std::uint32_t> chart_of_;
    std::vector<Chart> charts_;
};

}  // namespace

std::uint64_t Atlas::texel_count() const {
    std::uint64_t count = 0;
    for (const Chart& chart : charts)
        count += static_cast<std::uint64_t>(chart.size.x) * static_cast<std::uint64_t>(chart.size.y);
    return count;
}

Vec2f texel_coordinate(const Chart& chart, const Vec3f& p) {
    const Vec3f d = p - chart.origin;
    return {glm::dot(d, chart.u) / glm::dot(chart.u, chart.u), glm::dot(d, chart.v) / glm::dot(chart.v, chart.v)};
}

Atlas build_atlas(const Scene& scene, const AtlasOptions& options) {
    SKYBAKE_CHECK(options.texel_m > 0.0f);
    Atlas atlas;
    atlas.texel_m = options.texel_m;
    ChartBuilder(scene, options.texel_m).build(atlas);
    atlas.pages = pack_charts(atlas.charts);
    atlas.triangle_chart.resize(scene.triangles.size());
    atlas.triangle_texels.resize(scene.triangles.size());
    for (std::size_t c = 0; c < atlas.charts.size(); ++c) {
        const Chart& chart = atlas.charts[c];
        for (const std::uint32_t t : chart.triangles) {
            atlas.triangle_chart[t] = ChartId(c);
            for (int k = 0; k < 3; ++k)
                atlas.triangle_texels[t][k] = texel_coordinate(chart, scene.triangles[t][k]) + Vec2f(chart.position);
        }
    }
    return atlas;
}

}  // namespace skybake
