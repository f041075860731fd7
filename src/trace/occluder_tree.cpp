#include "trace/occluder_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

namespace skybake {

namespace {

constexpr int kBins = 16;

double surface_area(const Box3f& box) {
    if (box.is_empty()) return 0.0;
    const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Leaves that so many quads fill.
double blocks(std::size_t count) {
    return static_cast<double>((count + OccluderTree::kWidth - 1) / OccluderTree::kWidth);
}

using Quad = std::array<Vec3f, 4>;

// Two triangles make one quad when the second lies in the first one's plane to within this distance, metres.
constexpr float kFlat = 1e-3f;

bool is_before(const Vec3f& a, const Vec3f& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Seen along its normal, every corner turns the same way.
bool is_convex(const Quad& quad) {
    const Vec3f normal = glm::cross(quad[2] - quad[0], quad[3] - quad[1]);
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3f in = quad[(k + 1) % 4] - quad[k], out = quad[(k + 2) % 4] - quad[(k + 1) % 4];
        if (glm::dot(glm::cross(in, out), normal) < 0.0f) return false;
    }
    return true;
}

/// The two triangles as one convex flat quad, if they are; `edge` of `a` (from that corner to the next) is the one they
/// share, and `apex` the corner of the other one that is not on it.
std::optional<Quad> joined(const std::array<Vec3f, 3>& a, std::size_t edge, const Vec3f& apex) {
    const Vec3f normal = glm::cross(a[1] - a[0], a[2] - a[0]);
    const float length = glm::length(normal);
    if (!(length > 0.0f) || std::abs(glm::dot(apex - a[0], normal)) > kFlat * length) return std::nullopt;
    const Quad quad{a[edge], apex, a[(edge + 1) % 3], a[(edge + 2) % 3]};
    return is_convex(quad) ? std::optional(quad) : std::nullopt;
}

/// The scene's triangles, as many of them in pairs as neighbours within a face allow, taken in order.
std::vector<Quad> quads_of(const Scene& scene) {
    struct Edge {
        Vec3f lo, hi;  // its ends, in order
        std::uint32_t triangle, corner;
    };
    std::vector<Quad> quads;
    std::vector<bool> is_taken(scene.triangles.size(), false);
    for (const Crown& crown : scene.crowns)  // what dims does not hide
        std::fill_n(is_taken.begin() + crown.first_triangle, crown.triangle_count, true);
    std::vector<Edge> edges;
    for (const Face& face : scene.faces) {
        edges.clear();
        for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const Vec3f &a = scene.triangles[t][k], &b = scene.triangles[t][(k + 1) % 3];
                edges.push_back(is_before(a, b) ? Edge{a, b, t, k} : Edge{b, a, t, k});
            }
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            if (a.lo != b.lo) return is_before(a.lo, b.lo);
            if (a.hi != b.hi) return is_before(a.hi, b.hi);
            return a.triangle < b.triangle;
        });
        for (std::size_t i = 1; i < edges.size(); ++i) {
            const Edge &first = edges[i - 1], &second = edges[i];
            if (first.lo != second.lo || first.hi != second.hi || is_taken[first.triangle] || is_taken[second.triangle])
                continue;
            const auto quad = joined(scene.triangles[first.triangle], first.corner,
                                     scene.triangles[second.triangle][(second.corner + 2) % 3]);
            if (!quad) continue;
            is_taken[first.triangle] = is_taken[second.triangle] = true;
            quads.push_back(*quad);
        }
    }
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const std::array<Vec3f, 3>& corners = scene.triangles[t];
        if (!is_taken[t]) quads.push_back({corners[0], corners[1], corners[2], corners[2]});
    }
    return quads;
}

}  // namespace

/// Top down; each binary split is the best of 16 bins a side by the surface area heuristic (Wald 2007), its cost
/// counted in whole leaves; a node takes splits, the dearest range first, until it has 16 children.
class OccluderTree::Builder {
  public:
    Builder(const Scene& scene, OccluderTree& tree) : quads_(quads_of(scene)), tree_(tree), boxes_(quads_.size()) {
        order_.resize(boxes_.size());
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            for (const Vec3f& corner : quads_[i]) boxes_[i].extend(corner);
            order_[i] = static_cast<std::uint32_t>(i);
        }
    }

    void build() {
        if (!order_.empty()) tree_.root_ = build(range_of(order_));
    }

  private:
    struct Range {
        std::span<std::uint32_t> quads;
        Box3f box;
        double cost() const { return surface_area(box) * blocks(quads.size()); }
        bool is_leaf() const { return quads.size() <= static_cast<std::size_t>(kWidth); }
    };

    Range range_of(std::span<std::uint32_t> quads) const {
        Range range{quads, {}};
        for (const std::uint32_t q : quads) range.box.extend(boxes_[q]);
        return range;
    }

    std::uint32_t build(const Range& range) {
        if (range.is_leaf()) return leaf_of(range);
        std::vector<Range> children{range};
        while (children.size() < static_cast<std::size_t>(kWidth)) {
            auto dearest = children.end();
            for (auto child = children.begin(); child != children.end(); ++child) {
                if (!child->is_leaf() && (dearest == children.end() || child->cost() > dearest->cost()))
                    dearest = child;
            }
            if (dearest == children.end()) break;
            const std::size_t left = split(*dearest);
            const Range second = range_of(dearest->quads.subspan(left));
            *dearest = range_of(dearest->quads.first(left));
            children.push_back(second);
        }
        const std::uint32_t index = static_cast<std::uint32_t>(tree_.nodes_.size());
        tree_.nodes_.emplace_back();
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        Node node;
        for (int axis = 0; axis < 3; ++axis) {
            std::fill_n(node.center[axis], kWidth, kNan);
            std::fill_n(node.extent[axis], kWidth, kNan);
        }
        std::fill_n(node.child, kWidth, 0u);
        for (std::size_t c = 0; c < children.size(); ++c) {
            for (int axis = 0; axis < 3; ++axis) {
                const float lo = children[c].box.lo[axis], hi = children[c].box.hi[axis];
                const float center = 0.5f * (lo + hi);
                node.center[axis][c] = center;
                // Half the size, and what rounding took from the centre.
                node.extent[axis][c] = std::max(hi - center, center - lo) + std::abs(center) * 0x1p-22f;
            }
            node.child[c] = build(children[c]);
        }
        tree_.nodes_[index] = node;
        return index;
    }

    std::uint32_t leaf_of(const Range& range) {
        Leaf leaf;
        std::fill_n(&leaf.corner[0][0][0], sizeof(leaf.corner) / sizeof(float),
                    std::numeric_limits<float>::quiet_NaN());
        for (std::size_t lane = 0; lane < range.quads.size(); ++lane) {
            const Quad& quad = quads_[range.quads[lane]];
            for (std::size_t corner = 0; corner < 4; ++corner) {
                for (int axis = 0; axis < 3; ++axis) leaf.corner[corner][axis][lane] = quad[corner][axis];
            }
        }
        tree_.leaves_.push_back(leaf);
        return static_cast<std::uint32_t>(tree_.leaves_.size() - 1) | kLeaf;
    }

    /// Sorts the range into two and returns the size of the first; neither is empty.
    std::size_t split(const Range& range) {
        Box3f centers;
        for (const std::uint32_t q : range.quads) centers.extend(boxes_[q].center());
        struct Bin {
            Box3f box;
            std::size_t count = 0;
        };
        double best_cost = std::numeric_limits<double>::max();
        int best_axis = -1, best_bin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centers.hi[axis] > centers.lo[axis])) continue;
            std::array<Bin, kBins> bins;
            for (const std::uint32_t q : range.quads) {
                Bin& bin = bins[static_cast<std::size_t>(bin_of(boxes_[q], centers, axis))];
                bin.box.extend(boxes_[q]);
                ++bin.count;
            }
            std::array<double, kBins> right_cost{};
            Bin right;
            for (int b = kBins - 1; b > 0; --b) {
                right.box.extend(bins[static_cast<std::size_t>(b)].box);
                right.count += bins[static_cast<std::size_t>(b)].count;
                right_cost[static_cast<std::size_t>(b)] = surface_area(right.box) * blocks(right.count);
            }
            Bin left;
            for (int b = 1; b < kBins; ++b) {
                left.box.extend(bins[static_cast<std::size_t>(b - 1)].box);
                left.count += bins[static_cast<std::size_t>(b - 1)].count;
                if (left.count == 0 || left.count == range.quads.size()) continue;
                const double cost =
                    surface_area(left.box) * blocks(left.count) + right_cost[static_cast<std::size_t>(b)];
                if (cost < best_cost) {
                    best_cost = cost;
                    best_axis = axis;
                    best_bin = b;
                }
            }
        }
        if (best_axis < 0) return range.quads.size() / 2;  // all in one place
        const auto middle = std::partition(range.quads.begin(), range.quads.end(), [&](std::uint32_t q) {
            return bin_of(boxes_[q], centers, best_axis) < best_bin;
        });
        return static_cast<std::size_t>(middle - range.quads.begin());
    }

    static int bin_of(const Box3f& box, const Box3f& centers, int axis) {
        const float share = (box.center()[axis] - centers.lo[axis]) / (centers.hi[axis] - centers.lo[axis]);
        return std::clamp(static_cast<int>(share * static_cast<float>(kBins)), 0, kBins - 1);
    }

    std::vector<Quad> quads_;
    OccluderTree& tree_;
    std::vector<Box3f> boxes_;
    std::vector<std::uint32_t> order_;
};

OccluderTree::OccluderTree(const Scene& scene) {
    Builder(scene, *this).build();
}

}  // namespace skybake
