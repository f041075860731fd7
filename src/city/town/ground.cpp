#include "city/town/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "city/town/delaunay.h"
#include "city/town/styles.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

constexpr double kHillMesh = 8.0;  // metres between points on the hill; elsewhere corners of streets do

Vec3d on_ground(const Relief& relief, Vec2d p) {
    return {p.x, p.y, relief.ground(p)};
}

Finish ground_finish(SurfaceType type, Picture picture, double period) {
    return {type, id_of(picture), ground_frame(period)};
}

/// A triangle of ground, unless it is thinner than a millimetre.
void add_triangle(ObjectBuilder& builder, const Relief& relief, Vec2d a, Vec2d b, Vec2d c, const Finish& finish) {
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    if (cross(b - a, c - a) < 2e-3 * longest) return;
    builder.add({on_ground(relief, a), on_ground(relief, b), on_ground(relief, c)}, finish);
}

/// Points of edge i of the cell's land: ends, and on the hill some between. The same from both sides of the edge.
std::vector<Vec2d> edge_points(const Layout& layout, const Cell& cell, std::size_t i) {
    const Vec2d a = cell.land.corner(i);
    const Vec2d b = cell.land.corner(i + 1);
    const int label = cell.land.labels[i];
    const bool is_beside_hill = label >= 0 && static_cast<std::size_t>(label) < layout.cells.size() &&
                                layout.cells[static_cast<std::size_t>(label)].use == CellUse::hill;
    // The river's banks have their corners only at the ends of its segments.
    if (label == kRiverbank || (cell.use != CellUse::hill && !is_beside_hill)) return {a, b};
    const bool is_turned = a.x != b.x ? a.x > b.x : a.y > b.y;
    const Vec2d from = is_turned ? b : a;
    const Vec2d to = is_turned ? a : b;
    const int count = std::max(1, static_cast<int>(std::ceil(glm::length(b - a) / kHillMesh)));
    std::vector<Vec2d> points;
    for (int k = 0; k <= count; ++k) points.push_back(from + (to - from) * (static_cast<double>(k) / count));
    points.back() = to;
    if (is_turned) std::reverse(points.begin(), points.end());
    return points;
}

/// Fills a star-shaped ring from its middle.
void fill(ObjectBuilder& builder, const Relief& relief, const std::vector<Vec2d>& rim, const Finish& finish) {
    const Vec2d centre = middle(rim);
    for (std::size_t i = 0; i < rim.size(); ++i)
        add_triangle(builder, relief, rim[i], rim[(i + 1) % rim.size()], centre, finish);
}

/// Fills a convex ring with a net of kHillMesh, for steep ground.
void fill_finely(ObjectBuilder& builder, const Relief& relief, const std::vector<Vec2d>& rim, const Finish& finish) {
    std::vector<Vec2d> points = rim;
    Vec2d lo = rim[0];
    Vec2d hi = rim[0];
    for (const Vec2d& p : rim) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    // A lattice of equilateral triangles, the same all over the hill, that keeps away from the rim.
    const double row = kHillMesh * std::sqrt(0.75);
    for (double j = std::ceil(lo.y / row); j * row < hi.y; ++j) {
        const double shift = std::fmod(std::abs(j), 2.0) > 0.5 ? 0.5 : 0.0;
        for (double i = std::ceil(lo.x / kHillMesh) - 1; (i + shift) * kHillMesh < hi.x; ++i) {
            const Vec2d p{(i + shift) * kHillMesh, j * row};
            if (depth_inside(rim, p) > 0.45 * kHillMesh) points.push_back(p);
        }
    }
    for (const auto& [a, b, c] : delaunay(points))
        add_triangle(builder, relief, points[a], points[b], points[c], finish);
}

/// The band between the land's edge and the block.
void add_streets(ObjectBuilder& builder, const Layout& layout, const Cell& cell, const Relief& relief,
                 const Finish& finish) {
    const ConvexPolygon& block = cell.block;
    const std::size_t n = cell.land.size();
    std::vector<std::vector<Vec2d>> edges;
    for (std::size_t i = 0; i < n; ++i) edges.push_back(edge_points(layout, cell, i));
    const auto fan = [&](std::size_t edge, Vec2d tip) {
        for (std::size_t k = 0; k + 1 < edges[edge].size(); ++k)
            add_triangle(builder, relief, edges[edge][k], edges[edge][k + 1], tip, finish);
    };
    std::size_t first = 0;
    while (block.labels[first] < 0) ++first;  // at least three edges of a block lie along streets
    auto land_edge = static_cast<std::size_t>(block.labels[first]);
    for (std::size_t k = 0; k < block.size(); ++k) {
        const std::size_t j = (first + k) % block.size();
        const Vec2d from = block.corner(j);
        const Vec2d to = block.corner(j + 1);
        if (block.labels[j] < 0) {  // a cut corner: one triangle from the land's corner
            add_triangle(builder, relief, edges[land_edge].front(), to, from, finish);
            continue;
        }
        for (; land_edge != static_cast<std::size_t>(block.labels[j]); land_edge = (land_edge + 1) % n)
            fan(land_edge, from);
        const std::vector<Vec2d>& points = edges[land_edge];
        const std::size_t half = points.size() / 2;
        for (std::size_t i = 0; i < half; ++i) add_triangle(builder, relief, points[i], points[i + 1], from, finish);
        add_triangle(builder, relief, points[half], to, from, finish);
        for (std::size_t i = half; i + 1 < points.size(); ++i)
            add_triangle(builder, relief, points[i], points[i + 1], to, finish);
        land_edge = (land_edge + 1) % n;
    }
    const Vec2d last = block.corner(first);
    for (; land_edge != static_cast<std::size_t>(block.labels[first]); land_edge = (land_edge + 1) % n)
        fan(land_edge, last);
}

CityObject finished(ObjectBuilder& builder) {
    builder.close_shell(Shell::Kind::loose);
    return builder.take();
}

}  // namespace

std::vector<CityObject> build_ground(const Layout& layout, const Cell& cell, const Relief& relief) {
    std::vector<CityObject> objects;
    if (cell.use == CellUse::hill || cell.use == CellUse::field) {
        ObjectBuilder builder("terrain-" + cell.name, ObjectType::terrain, "TINRelief");
        std::vector<Vec2d> rim;
        for (std::size_t i = 0; i < cell.land.size(); ++i) {
            const std::vector<Vec2d> points = edge_points(layout, cell, i);
            rim.insert(rim.end(), points.begin(), points.end() - 1);
        }
        const Finish grass = ground_finish(SurfaceType::terrain, Picture::grass, kGrassPeriod);
        if (cell.use == CellUse::hill) {
            fill_finely(builder, relief, rim, grass);
        } else {
            fill(builder, relief, rim, grass);
        }
        objects.push_back(finished(builder));
        return objects;
    }
    ObjectBuilder streets("street-" + cell.name, ObjectType::road, "Road");
    add_streets(streets, layout, cell, relief, ground_finish(SurfaceType::road, Picture::cobbles, kCobblePeriod));
    objects.push_back(finished(streets));
    switch (cell.use) {
        case CellUse::square:
        case CellUse::church: {
            ObjectBuilder square("square-" + cell.name, ObjectType::square, "TransportSquare");
            fill(square, relief, cell.block.corners, ground_finish(SurfaceType::road, Picture::slabs, kCobblePeriod));
            objects.push_back(finished(square));
            break;
        }
        case CellUse::park:
        case CellUse::tower_site: {
            ObjectBuilder lawn("lawn-" + cell.name, ObjectType::plant_cover, "PlantCover");
            fill(lawn, relief, cell.block.corners,
                 ground_finish(SurfaceType::vegetation, Picture::grass, kGrassPeriod));
            objects.push_back(finished(lawn));
            break;
        }
        default: {
            ObjectBuilder court("court-" + cell.name, ObjectType::land_use, "LandUse");
            const bool is_green = (cell.key >> 7) % 3 == 0;
            fill(court, relief, cell.block.corners,
                 is_green ? ground_finish(SurfaceType::terrain, Picture::grass, kGrassPeriod)
                          : ground_finish(SurfaceType::terrain, Picture::gravel, kCobblePeriod));
            objects.push_back(finished(court));
        }
    }
    return objects;
}

std::vector<CityObject> build_river(const Layout& layout, int segment, const Relief& relief) {
    const River& river = layout.river;
    std::vector<CityObject> objects;
    const std::string name = signed_name('n', 's', river.number_of(segment));
    const auto at = [&](int corner, double offset, double z) {
        const Vec2d p = river.corner_beside(corner, offset);
        return Vec3d(p, z);
    };
    const auto bank = [&](int corner, double side) {
        return on_ground(relief, river.corner_beside(corner, side * River::kBankOffset));
    };
    const auto water = [&](int corner) { return relief.water(river.corner(corner)); };
    constexpr double kDepth = 2.2;
    const auto bed = [&](int corner, double side) {
        return at(corner, side * River::kBedOffset, water(corner) - kDepth);
    };

    ObjectBuilder land("riverbed-" + name, ObjectType::terrain, "TINRelief");
    const Finish stone = ground_finish(SurfaceType::terrain, Picture::gravel, kCobblePeriod);
    const auto quad = [](ObjectBuilder& builder, Vec3d a, Vec3d b, Vec3d c, Vec3d d, const Finish& finish) {
        builder.add({a, b, c}, finish);
        builder.add({a, c, d}, finish);
    };
    const int s = segment;
    quad(land, bed(s, -1), bed(s, 1), bed(s + 1, 1), bed(s + 1, -1), stone);
    // The banks are walls of rough stone, leaning: u along the river, v up the slope.
    for (const double side : {1.0, -1.0}) {
        const Vec3d foot = bed(s, side);
        const Vec3d top = bank(s, side);
        const Vec3d up = glm::normalize(top - foot) / kMasonryPeriod;
        const Finish masonry{SurfaceType::terrain,
                             id_of(Picture::masonry),
                             {foot, Vec3d(river.along(s), 0.0) / kMasonryPeriod, up, Vec2d(0.0)}};
        if (side > 0) {
            quad(land, bed(s, side), bank(s, side), bank(s + 1, side), bed(s + 1, side), masonry);
        } else {
            quad(land, bank(s, side), bed(s, side), bed(s + 1, side), bank(s + 1, side), masonry);
        }
    }
    objects.push_back(finished(land));

    ObjectBuilder sheet("river-" + name, ObjectType::water, "WaterBody");
    const Finish wet = ground_finish(SurfaceType::water, Picture::water, kWaterPeriod);
    quad(sheet, at(s, -River::kWaterOffset, water(s)), at(s, River::kWaterOffset, water(s)),
         at(s + 1, River::kWaterOffset, water(s + 1)), at(s + 1, -River::kWaterOffset, water(s + 1)), wet);
    objects.push_back(finished(sheet));
    return objects;
}

}  // namespace skybake::town
