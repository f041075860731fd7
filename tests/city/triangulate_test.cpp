#include "city/triangulate.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "city/polygon.h"
#include "polygons.h"

namespace skybake {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Vec3d corner(const Geometry& g, std::uint32_t i) {
    return g.vertices[g.corners[i]];
}

/// Area of the triangles along the polygon's normal; a triangle of the wrong side counts negatively.
double signed_area(const Geometry& g, const Surface& s, const Triangles& triangles) {
    const Vec3d normal = glm::normalize(surface_area_vector(g, s));
    double sum = 0.0;
    for (const auto& t : triangles) {
        sum += 0.5 * glm::dot(glm::cross(corner(g, t[1]) - corner(g, t[0]), corner(g, t[2]) - corner(g, t[0])), normal);
    }
    return sum;
}

// Truth for all: the triangles of a simple polygon with n corners and h holes are n + 2h - 2 and have its area (Euler).
void expect_triangulation(const Geometry& g, std::size_t surface, double area, std::size_t count) {
    const Triangles triangles = triangulate(g, g.surfaces[surface]);
    EXPECT_EQ(triangles.size(), count);
    EXPECT_NEAR(signed_area(g, g.surfaces[surface], triangles), area, 1e-9 * area);
    const Vec3d normal = surface_area_vector(g, g.surfaces[surface]);
    for (const auto& t : triangles) {
        EXPECT_GT(glm::dot(glm::cross(corner(g, t[1]) - corner(g, t[0]), corner(g, t[2]) - corner(g, t[0])), normal),
                  0.0);
    }
}

TEST(Triangulate, TrianglesAndQuads) {
    Geometry g;
    add_polygon(g, {{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}});
    add_polygon(g, {{{0, 0, 0}, {0, 5, 0}, {0, 5, 2}, {0, 0, 2}}});
    add_polygon(g, {{{0, 0, 1}, {4, 0, 1}, {1, 1, 1}, {0, 4, 1}}});  // an arrowhead: only one diagonal lies inside
    add_polygon(g, {{{1, 1, 1}, {0, 4, 1}, {0, 0, 1}, {4, 0, 1}}});
    expect_triangulation(g, 0, 6.0, 1);
    expect_triangulation(g, 1, 10.0, 2);
    expect_triangulation(g, 2, 4.0, 2);
    expect_triangulation(g, 3, 4.0, 2);
}

TEST(Triangulate, AClockwiseRingGivesTrianglesOfItsOwnSide) {
    Geometry g;
    add_polygon(g, {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}});
    expect_triangulation(g, 0, 1.0, 2);
    EXPECT_LT(surface_area_vector(g, g.surfaces[0]).z, 0.0);
}

TEST(Triangulate, HolesOfEitherSenseStayOpen) {
    Geometry g;
    const std::vector<Vec3d> outer{{0, 0, 0}, {10, 0, 0}, {10, 0, 10}, {0, 0, 10}};
    add_polygon(g, {outer, {{2, 0, 2}, {4, 0, 2}, {4, 0, 4}, {2, 0, 4}}, {{6, 0, 6}, {6, 0, 8}, {8, 0, 8}, {8, 0, 6}}});
    expect_triangulation(g, 0, 92.0, 12 + 4 - 2);
}

TEST(Triangulate, CollinearCornersAreKept) {
    Geometry g;
    add_polygon(g, {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}}});
    const Triangles triangles = triangulate(g, g.surfaces[0]);
    EXPECT_NEAR(signed_area(g, g.surfaces[0], triangles), 9.0, 1e-9);
    std::vector<int> used(6, 0);
    for (const auto& t : triangles) {
        for (const std::uint32_t c : t) used[c] = 1;
    }
    EXPECT_EQ(used, std::vector<int>(6, 1)) << "a corner that is left out opens a crack to its neighbour";
}

TEST(Triangulate, AConcaveRingAtMapCoordinates) {
    Geometry g;
    const Vec3d o(5.2e6, 4.4e6, 300.0);
    // A comb with 50 teeth of 1 m × 10 m on a back of 99 m × 1 m.
    std::vector<Vec3d> ring{o + Vec3d(0, 0, 0), o + Vec3d(99, 0, 0)};
    for (int i = 49; i >= 0; --i) {
        ring.push_back(o + Vec3d(2 * i + 1, 11, 0));
        ring.push_back(o + Vec3d(2 * i, 11, 0));
        if (i > 0) {
            ring.push_back(o + Vec3d(2 * i, 1, 0));
            ring.push_back(o + Vec3d(2 * i - 1, 1, 0));
        }
    }
    add_polygon(g, {ring});
    expect_triangulation(g, 0, 99.0 + 500.0, ring.size() - 2);
}

TEST(Triangulate, AStarThatWindsTwiceIsRefused) {
    Geometry g;
    std::vector<Vec3d> ring;
    for (int i = 0; i < 5; ++i) ring.push_back({std::cos(i * 4 * kPi / 5), std::sin(i * 4 * kPi / 5), 0.0});
    add_polygon(g, {ring});
    EXPECT_TRUE(triangulate(g, g.surfaces[0]).empty());
}

TEST(Triangulate, WhatHasNoAreaOrCrossesItselfGivesNothing) {
    Geometry g;
    add_polygon(g, {{{0, 0, 0}, {1, 0, 0}}});
    add_polygon(g, {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}});
    add_polygon(g, {{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 3, 0}}});  // a bow tie
    add_polygon(g, {{{0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}}});
    add_polygon(g, {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}},
                    {{3, 1, 0}, {6, 1, 0}, {6, 2, 0}, {3, 2, 0}}});  // hole across the rim
    add_polygon(g, {{{8, 0, 0},
                     {9, 6, 0},
                     {0, 0, 5},
                     {0, 6, 0},
                     {9, 0, 0},
                     {9, 0, 5},
                     {0, 0, 5},
                     {9, 0, 0},
                     {0, 0, 0},
                     {9, 6, 0},
                     {0, 0, 5}}});  // on it GEOS's ear clipping does not end; found by fuzzing
    for (const Surface& surface : g.surfaces) EXPECT_TRUE(triangulate(g, surface).empty());
    EXPECT_TRUE(triangulate(g, Surface{}).empty());
}

TEST(Triangulate, TwoThousandHolesTakeNoLong) {
    Geometry g;
    std::vector<std::vector<Vec3d>> rings{{{0, 0, 0}, {100, 0, 0}, {100, 80, 0}, {0, 80, 0}}};
    for (int x = 0; x < 50; ++x) {
        for (int y = 0; y < 40; ++y) {
            const Vec3d o(2 * x + 0.5, 2 * y + 0.5, 0.0);
            rings.push_back({o, o + Vec3d(0, 1, 0), o + Vec3d(1, 1, 0), o + Vec3d(1, 0, 0)});
        }
    }
    add_polygon(g, rings);
    const auto begun = std::chrono::steady_clock::now();
    expect_triangulation(g, 0, 8000.0 - 2000.0, 8004 + 2 * 2000 - 2);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(), 5.0);
}

}  // namespace
}  // namespace skybake
