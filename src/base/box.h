// Axis-aligned boxes. An empty box has lo > hi and grows from the first point.
#pragma once

#include <limits>

#include "base/vec.h"

namespace skybake {

template <typename V>
struct Box {
    using Scalar = typename V::value_type;
    V lo{std::numeric_limits<Scalar>::max()};
    V hi{std::numeric_limits<Scalar>::lowest()};

    bool is_empty() const { return lo.x > hi.x; }
    void extend(const V& p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void extend(const Box& b) {
        lo = glm::min(lo, b.lo);
        hi = glm::max(hi, b.hi);
    }
    V size() const { return is_empty() ? V(Scalar(0)) : hi - lo; }
    V center() const { return (lo + hi) * Scalar(0.5); }
};

using Box2f = Box<Vec2f>;
using Box3f = Box<Vec3f>;
using Box2d = Box<Vec2d>;
using Box3d = Box<Vec3d>;

}  // namespace skybake
