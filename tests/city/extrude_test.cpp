// Bodies on footprints: closed, of the volume that geometry gives.
#include "city/extrude.h"

#include <gtest/gtest.h>

#include <map>

#include "city/polygon.h"

namespace skybake {
namespace {

const std::vector<Vec2d> kRectangle = {{0, 0}, {10, 0}, {10, 6}, {0, 6}};

/// The volume by the divergence theorem; fails unless each edge is used once each way.
double volume_of(const Geometry& g) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    double volume = 0.0;
    for (const Surface& surface : g.surfaces) {
        volume += glm::dot(g.vertices[ring_of(g, surface.ring_begin)[0]], surface_area_vector(g, surface)) / 3.0;
        for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
            const auto ring = ring_of(g, r);
            for (std::size_t i = 0; i < ring.size(); ++i) ++uses[{ring[i], ring[(i + 1) % ring.size()]}];
        }
    }
    for (const auto& [edge, count] : uses) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(uses.count({edge.second, edge.first}), 1u) << "open edge";
    }
    return volume;
}

Geometry built(Footprint footprint) {
    footprint.base_m = 1.0;
    footprint.eaves_m = 4.0;
    footprint.ridge_m = 6.0;
    Geometry g;
    extrude(footprint, g);
    return g;
}

TEST(Extrude, BodiesAreClosedAndOfTheRightVolume) {
    const double below = 10.0 * 6.0 * 3.0;
    EXPECT_NEAR(volume_of(built({.rings = {kRectangle}})), 10.0 * 6.0 * 5.0, 1e-9);
    EXPECT_NEAR(volume_of(built({.rings = {kRectangle}, .roof = RoofShape::gabled})), below + 0.5 * 2 * 6 * 10, 1e-9);
    EXPECT_NEAR(volume_of(built({.rings = {kRectangle}, .roof = RoofShape::gabled, .is_ridge_across = true})),
                below + 0.5 * 2 * 6 * 10, 1e-9);
    EXPECT_NEAR(volume_of(built({.rings = {kRectangle}, .roof = RoofShape::pyramidal})), below + 10 * 6 * 2 / 3.0,
                1e-9);
    // A hipped roof: the prism over the ridge, and the halves of a pyramid at both ends.
    EXPECT_NEAR(volume_of(built({.rings = {kRectangle}, .roof = RoofShape::hipped})),
                below + 0.5 * 2 * 6 * 4 + 6 * 6 * 2 / 3.0, 1e-9);
}

TEST(Extrude, CourtsStayOpenWhicheverWayRingsRun) {
    std::vector<Vec2d> court = {{2, 2}, {4, 2}, {4, 4}, {2, 4}};
    for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(volume_of(built({.rings = {kRectangle, court}})), (60.0 - 4.0) * 5.0, 1e-9);
        std::reverse(court.begin(), court.end());
    }
    EXPECT_NEAR(volume_of(built({.rings = {{kRectangle.rbegin(), kRectangle.rend()}}})), 300.0, 1e-9);
}

TEST(Extrude, RidgesRunAlongTheLongerSides) {
    const auto ridge = [](const Geometry& g) {
        Vec3d lo(1e9), hi(-1e9);
        for (const Vec3d& p : g.vertices) {
            if (p.z < 6.0) continue;
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
        }
        return hi - lo;
    };
    EXPECT_EQ(ridge(built({.rings = {kRectangle}, .roof = RoofShape::gabled})), Vec3d(10, 0, 0));
    EXPECT_EQ(ridge(built({.rings = {kRectangle}, .roof = RoofShape::gabled, .is_ridge_across = true})),
              Vec3d(0, 6, 0));
    // In degrees at 60° north, ten of longitude are shorter than six of latitude.
    EXPECT_EQ(ridge(built({.rings = {kRectangle}, .metres_per_unit = {0.5, 1.0}, .roof = RoofShape::gabled})),
              Vec3d(0, 6, 0));
    EXPECT_FALSE(fits(RoofShape::gabled, {.rings = {{{0, 0}, {5, 0}, {5, 5}}}}));
    EXPECT_FALSE(fits(RoofShape::pyramidal, {.rings = {{{0, 0}, {5, 0}, {1, 1}, {0, 5}}}})) << "not convex";
}

}  // namespace
}  // namespace skybake
