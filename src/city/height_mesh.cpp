// Based on: Evans, Kirkpatrick, Townsend, "Right-Triangulated Irregular Networks", Algorithmica 30, 2001. Their
// triangles: the square is cut along a diagonal, each triangle from its right angle to the middle of its hypotenuse.
// Here the error of a triangle is that of all heights in it, not of its middle alone, so that the bound holds.
#include "city/height_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/check.h"

namespace skybake {
namespace {

constexpr float kMustSplit = std::numeric_limits<float>::infinity();

/// A corner of the square, in steps of the grid.
struct Node {
    std::int32_t x = 0, y = 0;
    friend Node middle(Node a, Node b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }
};

/// The hypotenuse from a to b, the right angle at c.
struct Triangle {
    Node a, b, c;
};

class Network {
  public:
    Network(const HeightGrid& grid, double max_error_m) : grid_(grid), max_error_(static_cast<float>(max_error_m)) {
        while (side_ + 1 < static_cast<std::int32_t>(std::max(grid.columns, grid.rows))) {
            side_ *= 2;
            ++depth_;
        }
        const auto nodes = static_cast<std::size_t>(side_ + 1);
        errors_.assign(nodes * nodes, 0.0f);
        numbers_.assign(nodes * nodes, 0);
    }

    Geometry mesh() {
        // From the smallest triangles that can be divided to the two largest: a middle's error is that of the triangles
        // on both sides and of all below them, so that who divides has divided its neighbour, too.
        for (int level = 2 * depth_ - 1; level >= 0; --level) {
            for (std::uint32_t i = 0; i < (std::uint32_t{2} << level); ++i) {
                const Triangle t = triangle(i, level);
                float error = error_of(t);
                for (const bool is_second : {false, true}) {
                    const Triangle h = half(t, is_second);
                    if (is_divisible(h)) error = std::max(error, errors_[at(middle(h.a, h.b))]);
                }
                float& known = errors_[at(middle(t.a, t.b))];
                known = std::max(known, error);
            }
        }
        emit_from({{0, 0}, {side_, side_}, {side_, 0}});
        emit_from({{side_, side_}, {0, 0}, {0, side_}});
        Shell shell;
        shell.surface_end = static_cast<std::uint32_t>(geometry_.surfaces.size());
        if (shell.surface_end > 0) geometry_.shells.push_back(shell);
        return std::move(geometry_);
    }

  private:
    std::size_t at(Node n) const {
        return static_cast<std::size_t>(n.y) * static_cast<std::size_t>(side_ + 1) + static_cast<std::size_t>(n.x);
    }
    float height(std::int32_t x, std::int32_t y) const {
        const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
        return column < grid_.columns && row < grid_.rows ? grid_.heights[row * grid_.columns + column]
                                                          : std::numeric_limits<float>::quiet_NaN();
    }
    float height(Node n) const { return height(n.x, n.y); }

    /// Triangle `i` of 2 · 2^level: the first bit chooses the half of the square, each further one a half of the half.
    Triangle triangle(std::uint32_t i, int level) const {
        Triangle t = (i >> level) & 1u ? Triangle{{side_, side_}, {0, 0}, {0, side_}}
                                       : Triangle{{0, 0}, {side_, side_}, {side_, 0}};
        for (int bit = level - 1; bit >= 0; --bit) t = half(t, (i >> bit) & 1u);
        return t;
    }
    static Triangle half(const Triangle& t, bool is_second) {
        const Node m = middle(t.a, t.b);
        return is_second ? Triangle{t.b, t.c, m} : Triangle{t.c, t.a, m};
    }
    bool is_divisible(const Triangle& t) const {
        return std::max(std::abs(t.a.x - t.b.x), std::abs(t.a.y - t.b.y)) > 1;
    }

    /// The largest error of a height in the triangle against its plane; kMustSplit between heights and gaps.
    float error_of(const Triangle& t) const {
        const auto [x0, x1] = std::minmax({t.a.x, t.b.x, t.c.x});
        const auto [y0, y1] = std::minmax({t.a.y, t.b.y, t.c.y});
        if (static_cast<std::size_t>(x0) >= grid_.columns || static_cast<std::size_t>(y0) >= grid_.rows) return 0.0f;
        const float za = height(t.a), zb = height(t.b), zc = height(t.c);
        const bool has_height = std::isfinite(za);
        if (std::isfinite(zb) != has_height || std::isfinite(zc) != has_height) return kMustSplit;
        // Heights along the two legs from c: every node in the triangle is c + u (a - c) + v (b - c), u, v, 1 - u - v ≥
        // 0.
        const Vec2d ca(t.a.x - t.c.x, t.a.y - t.c.y), cb(t.b.x - t.c.x, t.b.y - t.c.y);
        const double leg2 = glm::dot(ca, ca);  // both legs are as long, and at right angles
        double worst = 0.0;
        for (std::int32_t y = y0; y <= y1; ++y) {
            for (std::int32_t x = x0; x <= x1; ++x) {
                const Vec2d d(x - t.c.x, y - t.c.y);
                const double u = glm::dot(d, ca), v = glm::dot(d, cb);
                if (u < 0.0 || v < 0.0 || u + v > leg2) continue;
                const float z = height(x, y);
                if (std::isfinite(z) != has_height) return kMustSplit;
                if (!has_height) continue;
                const double plane = zc + (u * (za - zc) + v * (zb - zc)) / leg2;
                worst = std::max(worst, std::abs(plane - static_cast<double>(z)));
            }
        }
        // Rounded up, so that the bound is kept.
        return std::nextafter(static_cast<float>(worst), worst > 0.0 ? kMustSplit : 0.0f);
    }
    void emit_from(const Triangle& t) {
        if (is_divisible(t) && errors_[at(middle(t.a, t.b))] > max_error_) {
            emit_from(half(t, false));
            emit_from(half(t, true));
            return;
        }
        if (!std::isfinite(height(t.a) + height(t.b) + height(t.c))) return;
        Surface surface;
        surface.ring_begin = static_cast<std::uint32_t>(geometry_.ring_first.size() - 1);
        surface.ring_end = surface.ring_begin + 1;
        surface.type = SurfaceType::terrain;
        surface.source_index = static_cast<std::uint32_t>(geometry_.surfaces.size());
        for (const Node n : {t.a, t.b, t.c}) geometry_.corners.push_back(number_of(n));
        geometry_.ring_first.push_back(static_cast<std::uint32_t>(geometry_.corners.size()));
        geometry_.surfaces.push_back(surface);
    }

    std::uint32_t number_of(Node n) {
        std::uint32_t& number = numbers_[at(n)];
        if (number == 0) {
            const Vec2d place = grid_.north_west + Vec2d(n.x, -n.y) * grid_.step;
            geometry_.vertices.emplace_back(place, height(n));
            number = static_cast<std::uint32_t>(geometry_.vertices.size());
        }
        return number - 1;
    }

    const HeightGrid& grid_;
    float max_error_;
    std::int32_t side_ = 1;
    int depth_ = 0;
    std::vector<float> errors_;           // by the node in the middle of hypotenuses
    std::vector<std::uint32_t> numbers_;  // of nodes in the mesh, from 1
    Geometry geometry_;
};

}  // namespace

Geometry height_mesh(const HeightGrid& grid, double max_error_m) {
    SKYBAKE_CHECK(grid.columns >= 2 && grid.rows >= 2 && grid.columns <= kLongestGrid && grid.rows <= kLongestGrid);
    SKYBAKE_CHECK(grid.heights.size() == grid.columns * grid.rows);
    return Network(grid, max_error_m).mesh();
}

}  // namespace skybake
