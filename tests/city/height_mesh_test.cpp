// Rasters into triangles. Truth: the bound that is promised, checked at every height.
#include "city/height_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "base/hash_rng.h"
#include "city/ground_height.h"

namespace skybake {
namespace {

/// Hills, a cliff of 10 m, and noise of some centimetres.
HeightGrid hills(std::size_t columns, std::size_t rows) {
    HeightGrid grid{columns, rows, {1000.0, 2000.0}, {2.0, 3.0}, {}};
    RandomSequence random(1, 2, 3);
    for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t c = 0; c < columns; ++c) {
            const double x = static_cast<double>(c), y = static_cast<double>(r);
            const double cliff = x > 0.6 * static_cast<double>(columns) ? 10.0 : 0.0;
            grid.heights.push_back(static_cast<float>(5 * std::sin(x / 9) * std::cos(y / 7) + cliff +
                                                      0.05 * static_cast<double>(random.next())));
        }
    }
    return grid;
}

CityModel city_of(Geometry geometry) {
    CityModel city;
    city.objects.emplace_back();
    city.objects[0].type = ObjectType::terrain;
    city.objects[0].geometry = std::move(geometry);
    return city;
}

TEST(HeightMesh, NoHeightIsFurtherOffThanStated) {
    const HeightGrid grid = hills(50, 37);
    std::size_t before = 2 * 49 * 36 + 1;
    for (const double bound : {0.0, 0.05, 0.5, 3.0}) {
        const CityModel city = city_of(height_mesh(grid, bound));
        const std::size_t triangles = city.objects[0].geometry.surfaces.size();
        EXPECT_LT(triangles, before);
        before = triangles;
        const GroundHeight ground(city);
        for (std::size_t r = 0; r < grid.rows; ++r) {
            for (std::size_t c = 0; c < grid.columns; ++c) {
                const Vec2d p = grid.north_west + Vec2d(static_cast<double>(c), -static_cast<double>(r)) * grid.step;
                const auto z = ground.at(p);
                ASSERT_TRUE(z.has_value()) << c << ' ' << r;
                EXPECT_LE(std::abs(*z - static_cast<double>(grid.heights[r * grid.columns + c])), bound + 1e-5);
            }
        }
    }
}

TEST(HeightMesh, EdgesMeetAndFacesLookUp) {
    const Geometry g = height_mesh(hills(33, 20), 0.3);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double area = 0.0;
    for (std::size_t i = 0; i < g.surfaces.size(); ++i) {
        const auto corner = [&](std::size_t k) { return g.corners[3 * i + k % 3]; };
        const auto p = [&](std::size_t k) { return Vec2d(g.vertices[corner(k)]); };
        const double twice = (p(1).x - p(0).x) * (p(2).y - p(0).y) - (p(1).y - p(0).y) * (p(2).x - p(0).x);
        EXPECT_GT(twice, 0.0);
        area += 0.5 * twice;
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(corner(k), corner(k + 1))];
    }
    EXPECT_NEAR(area, 32 * 2.0 * 19 * 3.0, 1e-6);
    for (const auto& [edge, count] : edges) {
        const Vec3d a = g.vertices[edge.first], b = g.vertices[edge.second];
        const auto is_at = [&](double v, double border, double other) { return v == border && other == border; };
        const bool is_border =
            is_at(a.x, 1000, b.x) || is_at(a.x, 1064, b.x) || is_at(a.y, 2000, b.y) || is_at(a.y, 1943, b.y);
        EXPECT_EQ(count, is_border ? 1 : 2) << "no crack, no overlap";
    }
}

TEST(HeightMesh, LevelGroundIsTwoTrianglesAndGapsStayOpen) {
    HeightGrid flat{65, 65, {0, 0}, {1, 1}, std::vector<float>(65 * 65, 7.0f)};
    EXPECT_EQ(height_mesh(flat, 0.01).surfaces.size(), 2u);
    for (std::size_t r = 20; r < 30; ++r) {
        for (std::size_t c = 40; c < 45; ++c) flat.heights[r * 65 + c] = std::numeric_limits<float>::quiet_NaN();
    }
    const CityModel city = city_of(height_mesh(flat, 0.01));
    const GroundHeight ground(city);
    EXPECT_FALSE(ground.at({42.0, -25.0}).has_value());
    EXPECT_TRUE(ground.at({38.0, -25.0}).has_value());
    EXPECT_TRUE(ground.at({42.0, -31.5}).has_value());
    EXPECT_LT(city.objects[0].geometry.surfaces.size(), 300u);
}

}  // namespace
}  // namespace skybake
