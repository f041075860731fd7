#include "light/lamp_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace skybake {

namespace {

// Against the rounding of distances and angles, m and rad.
constexpr double kLeastDistance2 = 1e-6;
constexpr float kAngleSlack = 1e-3f;

double least_distance2(const Box3f& a, const Box3f& b) {
    const Vec3d gap = glm::max(Vec3d(0.0), glm::max(Vec3d(a.lo) - Vec3d(b.hi), Vec3d(b.lo) - Vec3d(a.hi)));
    return std::max(glm::dot(gap, gap), kLeastDistance2);
}

/// The largest of dot(normal, p) over the box.
float farthest_along(const Box3f& box, const Vec3f& normal) {
    float sum = 0.0f;
    for (int axis = 0; axis < 3; ++axis) sum += normal[axis] * (normal[axis] > 0.0f ? box.hi[axis] : box.lo[axis]);
    return sum;
}

/// What the lamp sends towards the patch at most, of its peak.
float share_towards(const Lamp& lamp, const Box3f& box) {
    const Vec3f to_center = box.center() - lamp.position;
    const float distance = glm::length(to_center), radius = 0.5f * glm::length(box.size());
    if (distance <= radius) return 1.0f;
    return largest_intensity_share(lamp, to_center / distance, std::asin(radius / distance) + kAngleSlack);
}

}  // namespace

LampTree::LampTree(std::span<const Lamp> lamps) : lamps_(lamps) {
    std::vector<std::uint32_t> order(lamps.size());
    std::iota(order.begin(), order.end(), 0u);
    nodes_.reserve(2 * lamps.size());
    if (!order.empty()) build(order);
}

void LampTree::build(std::span<std::uint32_t> order) {
    const std::size_t own = nodes_.size();
    Node node;
    for (const std::uint32_t l : order) {
        node.box.extend(lamps_[l].position);
        node.intensity_cd += static_cast<double>(luminance(lamps_[l].intensity));
    }
    node.lamp = order.front();
    nodes_.push_back(node);
    if (order.size() == 1) return;
    const Vec3f size = node.box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float x = lamps_[a].position[axis], y = lamps_[b].position[axis];
                         return x != y ? x < y : a < b;
                     });
    build(order.first(half));
    nodes_[own].right = static_cast<std::uint32_t>(nodes_.size());
    build(order.subspan(half));
}

double LampTree::bound(const Node& node, const ReceiverPatch& patch) const {
    const double distance2 = least_distance2(node.box, patch.box);
    double per_candela = 1.0 / distance2;
    if (patch.is_planar) {
        const double height = static_cast<double>(farthest_along(node.box, patch.normal) - patch.plane_offset);
        if (height <= 0.0) return 0.0;
        per_candela = std::min(per_candela, height / (distance2 * std::sqrt(distance2)));
    }
    const double share = node.right == 0 ? static_cast<double>(share_towards(lamps_[node.lamp], patch.box)) : 1.0;
    return node.intensity_cd * share * per_candela;
}

std::vector<std::uint32_t> LampTree::relevant(const ReceiverPatch& patch, double cutoff_lx) const {
    struct Open {
        double bound;
        std::uint32_t node;
        bool operator<(const Open& other) const {
            return bound != other.bound ? bound < other.bound : node > other.node;
        }
    };
    std::vector<std::uint32_t> kept;
    std::priority_queue<Open> open;
    double rest = 0.0;
    const auto put = [&](std::uint32_t node) {
        const double lx = bound(nodes_[node], patch);
        if (!(lx > 0.0)) return;
        open.push({lx, node});
        rest += lx;
    };
    if (!nodes_.empty()) put(0);
    while (!open.empty() && rest > cutoff_lx) {
        const Open top = open.top();
        open.pop();
        const Node& node = nodes_[top.node];
        rest -= top.bound;
        if (node.right == 0) {
            kept.push_back(node.lamp);
        } else {
            put(top.node + 1);
            put(node.right);
        }
        // Differences of large bounds leave rounding behind: what is left is summed anew when it might decide.
        if (rest <= cutoff_lx + 1e-9 * top.bound) {
            auto copy = open;
            for (rest = 0.0; !copy.empty(); copy.pop()) rest += copy.top().bound;
        }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

}  // namespace skybake
