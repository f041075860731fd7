#include "city/town/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "city/town/plane_geometry.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

/// Heading of river segment number k, radians clockwise from north: two meanders of 0.9 and 2.3 km that add up to bends
/// of at most 11° a corner. By the old town the river swings towards it and, north and south of it, away: it keeps
/// clear of the castle hill.
double heading(std::uint64_t seed, int k) {
    const double s = k * River::kStep;
    return -0.42 * std::sin(2 * kPi * s / 900.0 + draw(seed, 1, 1, -0.2, 0.4)) +
           0.14 * std::sin(2 * kPi * s / 2300.0 + draw(seed, 1, 2, 0.0, 2 * kPi));
}

Vec2d direction(double azimuth) {
    return {std::sin(azimuth), std::cos(azimuth)};
}

/// Value noise in -1 … 1 with a lattice of 260 m, quintic blend (second derivatives are continuous: no kinks in the
/// light).
double noise(std::uint64_t seed, Vec2d p) {
    p /= 260.0;
    const Vec2d f{std::floor(p.x), std::floor(p.y)};
    const Vec2d t = p - f;
    const auto at = [&](int dx, int dy) {
        const auto x = static_cast<std::uint64_t>(static_cast<std::int64_t>(f.x) + dx);
        const auto y = static_cast<std::uint64_t>(static_cast<std::int64_t>(f.y) + dy);
        return draw(seed, hash_combine(x, y), 3, -1.0, 1.0);
    };
    const auto ease = [](double v) { return v * v * v * (v * (6 * v - 15) + 10); };
    const double u = ease(t.x);
    const double v = ease(t.y);
    return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

}  // namespace

River::River(std::uint64_t seed, double reach) {
    const int half =
        static_cast<int>(std::ceil(reach * 1.35 / kStep)) + 2;  // 1.35: the course's length against its chord, and more
    std::vector<Vec2d> south;
    const Vec2d start = kStart;
    Vec2d p = start - direction(heading(seed, 0)) * (0.5 * kStep);
    for (int k = -1; k >= -half; --k) {
        p -= direction(heading(seed, k)) * kStep;
        south.push_back(p);
    }
    corners_.assign(south.rbegin(), south.rend());
    middle_ = static_cast<int>(corners_.size());
    p = start - direction(heading(seed, 0)) * (0.5 * kStep);
    corners_.push_back(p);
    for (int k = 0; k <= half; ++k) {
        p += direction(heading(seed, k)) * kStep;
        corners_.push_back(p);
    }
}

Vec2d River::along(int i) const {
    return (corner(i + 1) - corner(i)) / kStep;
}

Vec2d River::corner_beside(int i, double offset) const {
    const int last = segment_count();
    const Vec2d before = i > 0 ? along(i - 1) : along(i);
    const Vec2d after = i < last ? along(i) : along(i - 1);
    const Vec2d mean = glm::normalize(before + after);
    const Vec2d right{mean.y, -mean.x};
    return corner(i) + right * (offset / glm::dot(mean, after));
}

double River::distance_to(Vec2d p) const {
    // The course only runs north, at most 40° off, so the nearest point lies within twice the distance in y.
    const auto by_y = [](const Vec2d& c, double y) { return c.y < y; };
    const auto near = std::lower_bound(corners_.begin(), corners_.end(), p.y, by_y);
    const auto at = static_cast<int>(near - corners_.begin());
    double nearest = std::numeric_limits<double>::max();
    for (int i = std::max(0, at - 4); i < std::min(segment_count(), at + 4); ++i) {
        const double t = std::clamp(glm::dot(p - corner(i), along(i)), 0.0, kStep);
        nearest = std::min(nearest, glm::length(p - (corner(i) + along(i) * t)));
    }
    return nearest;
}

double Relief::hill_foot(Vec2d p) {
    const Vec2d d = p - kHillMiddle;
    const double a = std::atan2(d.y, d.x);
    return 104.0 * (1.0 + 0.12 * std::sin(2 * a + 1.0) + 0.06 * std::sin(5 * a + 2.0));
}

double Relief::ground(Vec2d p) const {
    double z = 350.0 + 4.0 * std::tanh((p.x - River::kStart.x) / 420.0) + 0.0006 * p.y + 0.9 * noise(seed_, p);
    const double r = glm::length(p - kHillMiddle);
    if (r < kHillReach) {
        const double foot = hill_foot(p);
        const double t = std::clamp((foot - r) / (foot * (1.0 - kPlateau)), 0.0, 1.0);
        z += kHillHeight * t * t * (3.0 - 2.0 * t);
    }
    return z;
}

double Relief::water(Vec2d p) const {
    return 345.2 + 0.0006 * p.y;
}

}  // namespace skybake::town
