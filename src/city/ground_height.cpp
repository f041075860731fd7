#include "city/ground_height.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "city/finding_codes.h"
#include "city/repair_steps.h"
#include "city/triangulate.h"

namespace skybake {
namespace {

constexpr std::size_t kMostCells = std::size_t{1} << 24;

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x * b.y - a.y * b.x;
}

/// The height of the triangle at `p`; none outside it or when it stands upright.
std::optional<double> height_in(const Vec3d* t, const Vec2d& p) {
    const Vec2d a(t[0]), b(t[1]), c(t[2]);
    const double area = cross(b - a, c - a);
    if (area == 0.0) return std::nullopt;
    const double u = cross(b - p, c - p) / area, v = cross(c - p, a - p) / area;
    constexpr double kEdge = -1e-9;  // points on an edge belong to both sides
    if (u < kEdge || v < kEdge || 1.0 - u - v < kEdge) return std::nullopt;
    return u * t[0].z + v * t[1].z + (1.0 - u - v) * t[2].z;
}

}  // namespace

GroundHeight::GroundHeight(const CityModel& city) {
    for (const CityObject& object : city.objects) {
        const Geometry& g = object.geometry;
        if (!is_ground(object.type)) continue;
        for (const Surface& surface : g.surfaces) {
            for (const std::array<std::uint32_t, 3>& t : triangulate(g, surface)) {
                for (const std::uint32_t corner : t) {
                    corners_.push_back(g.vertices[g.corners[corner]]);
                    box_.extend(Vec2d(corners_.back()));
                }
            }
        }
    }
    const std::size_t count = corners_.size() / 3;
    if (count == 0) return;
    const Vec2d size = box_.size();
    const double side = std::sqrt(std::max(size.x * size.y, 1e-12) / static_cast<double>(count));
    const auto cells = [&](double length) {
        return std::clamp<std::size_t>(static_cast<std::size_t>(length / side), 1, 4096);
    };
    columns_ = cells(size.x);
    rows_ = std::min(cells(size.y), kMostCells / columns_);
    cell_ = glm::max(size / Vec2d(static_cast<double>(columns_), static_cast<double>(rows_)), Vec2d(1e-12));
    // Counted, then filled: first_ becomes the beginnings.
    first_.assign(columns_ * rows_ + 1, 0);
    const auto for_cells = [&](std::size_t t, auto&& f) {
        Box2d box;
        for (std::size_t k = 0; k < 3; ++k) box.extend(Vec2d(corners_[3 * t + k]));
        const std::size_t lo = cell_of(box.lo.x, box.lo.y), hi = cell_of(box.hi.x, box.hi.y);
        for (std::size_t row = lo / columns_; row <= hi / columns_; ++row) {
            for (std::size_t column = lo % columns_; column <= hi % columns_; ++column) f(row * columns_ + column);
        }
    };
    for (std::size_t t = 0; t < count; ++t) for_cells(t, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < count; ++t)
        for_cells(t, [&](std::size_t cell) { triangles_[next[cell]++] = static_cast<std::uint32_t>(t); });
}

std::size_t GroundHeight::cell_of(double x, double y) const {
    const auto index = [](double offset, double cell, std::size_t count) {
        return std::min(static_cast<std::size_t>(std::max(offset / cell, 0.0)), count - 1);
    };
    return index(y - box_.lo.y, cell_.y, rows_) * columns_ + index(x - box_.lo.x, cell_.x, columns_);
}

std::optional<double> GroundHeight::at(const Vec2d& place) const {
    if (corners_.empty() ||
        !(place.x >= box_.lo.x && place.x <= box_.hi.x && place.y >= box_.lo.y && place.y <= box_.hi.y))
        return std::nullopt;
    const std::size_t cell = cell_of(place.x, place.y);
    std::optional<double> highest;
    for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const std::optional<double> z = height_in(&corners_[3 * std::size_t{triangles_[i]}], place);
        if (z && (!highest || *z > *highest)) highest = z;
    }
    return highest;
}

void stand_on_ground(CityModel& city, std::span<const std::string> ids, FindingLog& findings) {
    if (ids.empty()) return;
    const std::unordered_set<std::string_view> wanted(ids.begin(), ids.end());
    const GroundHeight ground(city);
    for (CityObject& object : city.objects) {
        if (wanted.count(object.id) == 0 || object.geometry.is_empty()) continue;
        double lowest = std::numeric_limits<double>::max();
        for (const Vec3d& p : object.geometry.vertices) {
            if (!repair_steps::is_place(p)) continue;
            if (const std::optional<double> z = ground.at(Vec2d(p))) lowest = std::min(lowest, *z);
        }
        if (lowest == std::numeric_limits<double>::max()) {
            findings.add(make_finding("SB504", object.where, "no ground lies below it; it stands at height 0."));
            continue;
        }
        for (Vec3d& p : object.geometry.vertices) p.z += lowest;
    }
}

}  // namespace skybake
