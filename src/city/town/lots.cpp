// Houses side by side along the edges of a block, about a court. A house at a block's corner has two wings; all others
// are rectangles square to the street, so that roofs of one street run level with each other.
#include <algorithm>
#include <cmath>

#include "city/town/layout.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

constexpr double kLeastWidth = 6.0;
constexpr double kMostWidth = 14.0;
constexpr double kLeastAngle = 1.15;  // 66°: sharper corners are cut off, as their houses would be all corner
constexpr double kLeastCourt = 7.0;   // from the houses' backs to the court's middle
constexpr double kLeastWing = 0.45;   // beyond what the re-entrant corner's eaves need

/// From a block's corner along its edge to the foot of the court's corner.
double foot(double depth, double angle) {
    return depth / std::tan(0.5 * angle);
}

/// How far a corner house must reach beyond that foot, so that eaves of `overhang` meet inside its own lot.
double least_wing(double angle) {
    return 0.5 / std::tan(0.5 * angle) + kLeastWing;
}

/// Joins the ends of edge i in its middle: the polygon stays convex and only loses land.
void collapse_edge(ConvexPolygon& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    const Vec2d mid = 0.5 * (polygon.corner(i) + polygon.corner(i + 1));
    polygon.corners[(i + 1) % n] = mid;
    polygon.corners.erase(polygon.corners.begin() + static_cast<std::ptrdiff_t>(i));
    polygon.labels.erase(polygon.labels.begin() + static_cast<std::ptrdiff_t>(i));
}

void cut_sharp_corners(ConvexPolygon& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const double angle = angle_at(polygon, i);
        if (angle >= kLeastAngle) continue;
        const std::size_t n = polygon.size();
        const Vec2d p = polygon.corner(i);
        const Vec2d back = polygon.corner(i + n - 1) - p;
        const Vec2d ahead = polygon.corner(i + 1) - p;
        const double t = std::min({9.0 / std::sin(0.5 * angle), 0.4 * glm::length(back), 0.4 * glm::length(ahead)});
        const auto at = static_cast<std::ptrdiff_t>(i);
        polygon.corners[i] = p + glm::normalize(back) * t;
        polygon.corners.insert(polygon.corners.begin() + at + 1, p + glm::normalize(ahead) * t);
        polygon.labels.insert(polygon.labels.begin() + at, kCutCorner);
        ++i;
    }
}

/// Room along edge i between the corner houses' least frontages.
double spare(const ConvexPolygon& polygon, std::size_t i, double depth) {
    const double a = angle_at(polygon, i);
    const double b = angle_at(polygon, i + 1);
    return glm::length(polygon.corner(i + 1) - polygon.corner(i)) - foot(depth, a) - foot(depth, b) - least_wing(a) -
           least_wing(b);
}

/// Widths of the row houses that fill `length` exactly, each in its bounds (or the whole when shorter than two).
std::vector<double> row_widths(std::uint64_t seed, std::uint64_t thing, double length) {
    const double typical = draw(seed, thing, 40, 8.2, 10.8);
    const int fewest = static_cast<int>(std::ceil(length / kMostWidth));
    const int most = std::max(1, static_cast<int>(length / kLeastWidth));
    const int count = std::clamp(static_cast<int>(std::lround(length / typical)), fewest, most);
    std::vector<double> widths;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        widths.push_back(draw(seed, hash_combine(thing, static_cast<std::uint64_t>(i)), 41, 0.7, 1.3));
        sum += widths.back();
    }
    const double mean = length / count;
    // Shrink the spread until all are in bounds; with equal widths they are.
    double spread = 1.0;
    for (const double w : widths) {
        const double off = w * count / sum - 1.0;
        if (off > 0) spread = std::min(spread, std::max(0.0, kMostWidth / mean - 1.0) / off);
        if (off < 0) spread = std::min(spread, std::max(0.0, 1.0 - kLeastWidth / mean) / -off);
    }
    for (double& w : widths) w = mean * (1.0 + spread * (w * count / sum - 1.0));
    return widths;
}

}  // namespace

void divide_into_lots(std::uint64_t seed, Cell& cell) {
    cell.lots.clear();
    ConvexPolygon& block = cell.block;
    double depth = draw(seed, cell.key, 42, 10.0, 12.6);
    const auto drop_short_edges = [&] {
        while (block.size() > 3) {
            std::size_t worst = 0;
            for (std::size_t i = 1; i < block.size(); ++i) {
                if (spare(block, i, depth) < spare(block, worst, depth)) worst = i;
            }
            if (spare(block, worst, depth) >= 0.0) return;
            collapse_edge(block, worst);
        }
    };
    drop_short_edges();
    cut_sharp_corners(block);
    drop_short_edges();
    depth = std::min(depth, depth_inside(block.corners, middle(block.corners)) - kLeastCourt);
    const std::size_t n = block.size();
    if (n < 3 || depth < 7.5) return;
    for (std::size_t i = 0; i < n; ++i) {
        if (spare(block, i, depth) < 0.0 || angle_at(block, i) < 0.8) return;
    }
    cell.house_depth = depth;

    // Share the spare length of each edge between its two corner houses and the row between them.
    std::vector<double> wing_ahead(n);   // of the corner house at corner i, along edge i
    std::vector<double> wing_behind(n);  // of the corner house at corner i, along edge i - 1
    std::vector<std::vector<double>> rows(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint64_t thing = hash_combine(cell.key, i);
        const std::size_t next = (i + 1) % n;
        double room = spare(block, i, depth);
        const auto wanted = [&](std::size_t corner, std::uint64_t purpose) {
            const double angle = angle_at(block, corner);
            const double frontage = draw(seed, thing, purpose, 7.5, 11.0);
            return std::max(0.0, frontage - foot(depth, angle) - least_wing(angle));
        };
        double a = wanted(i, 43);
        double b = wanted(next, 44);
        if (a + b > room - kLeastWidth) {  // no row between: the corner houses meet
            a = b = 0.0;
            if (room < kLeastWidth) {
                a = b = 0.5 * room;
                room = 0.0;
            }
        }
        wing_ahead[i] = a + least_wing(angle_at(block, i));
        wing_behind[next] = b + least_wing(angle_at(block, next));
        const double run = room > 0.0 ? room - a - b : 0.0;
        if (run > 0.0) rows[i] = row_widths(seed, thing, run);
    }

    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d p = block.corner(i);
        const Vec2d ahead = glm::normalize(block.corner(i + 1) - p);
        const Vec2d behind = glm::normalize(p - block.corner(i + n - 1));
        const double angle = angle_at(block, i);
        const double f = foot(depth, angle);
        const Vec2d in_ahead = left_of(ahead) * depth;
        const Vec2d in_behind = left_of(behind) * depth;
        const Vec2d a = p - behind * (f + wing_behind[i]);
        const Vec2d b = p + ahead * (f + wing_ahead[i]);
        const Vec2d q = p + ahead * f + in_ahead;
        cell.lots.push_back({{a, p, b, b + in_ahead, q, a + in_behind}, static_cast<int>(cell.lots.size())});
        double x = f + wing_ahead[i];
        for (std::size_t k = 0; k < rows[i].size(); ++k) {
            const double w = rows[i][k];
            const std::uint64_t thing = hash_combine(hash_combine(cell.key, i), k);
            // Some houses are shallower than their neighbours: courts are not smooth.
            const double d = depth - (draw(seed, thing, 45) < 0.45 ? draw(seed, thing, 46, 0.5, 2.4) : 0.0);
            const Vec2d origin = p + ahead * x;
            const Vec2d back = left_of(ahead) * d;
            cell.lots.push_back({{origin, origin + ahead * w, origin + ahead * w + back, origin + back},
                                 static_cast<int>(cell.lots.size())});
            x += w;
        }
    }
}

}  // namespace skybake::town
