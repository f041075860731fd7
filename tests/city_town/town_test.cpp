// The town is held against its promises (city/town/town.h): closed, outward, planar shells that do not overlap; ground
// without gaps; the same bits for the same options; a variant that changes nothing but the plan.
#include "city/town/town.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/rgb.h"
#include "city/polygon.h"

namespace skybake {
namespace {

Town town_of(std::uint32_t buildings, std::uint64_t seed, TownVariant variant = TownVariant::as_built) {
    return build_town({.buildings = buildings, .seed = seed, .variant = variant});
}

const Town& small_town() {
    static const Town town = town_of(250, 0);
    return town;
}

std::size_t count_buildings(const CityModel& city) {
    return static_cast<std::size_t>(std::count_if(city.objects.begin(), city.objects.end(),
                                                  [](const CityObject& o) { return o.type == ObjectType::building; }));
}

bool are_equal(const CityObject& a, const CityObject& b) {
    const Geometry& g = a.geometry;
    const Geometry& h = b.geometry;
    const auto same_surface = [](const Surface& s, const Surface& t) {
        return s.ring_begin == t.ring_begin && s.ring_end == t.ring_end && s.type == t.type && s.texture == t.texture;
    };
    return a.id == b.id && a.parent_id == b.parent_id && a.type == b.type && a.attributes_json == b.attributes_json &&
           g.vertices == h.vertices && g.corners == h.corners && g.corner_uv == h.corner_uv &&
           g.ring_first == h.ring_first &&
           std::equal(g.surfaces.begin(), g.surfaces.end(), h.surfaces.begin(), h.surfaces.end(), same_surface);
}

std::map<std::string, const CityObject*> by_id(const CityModel& city) {
    std::map<std::string, const CityObject*> objects;
    for (const CityObject& object : city.objects) {
        EXPECT_TRUE(objects.emplace(object.id, &object).second) << object.id << " twice";
    }
    return objects;
}

/// Six times the volume: the sum of a·(b × c) over a fan of each ring, about a corner of the shell (divergence
/// theorem).
double six_volumes(const Geometry& g, const Shell& shell) {
    const Vec3d about = g.vertices[g.corners[g.ring_first[g.surfaces[shell.surface_begin].ring_begin]]];
    double sum = 0.0;
    for (std::uint32_t s = shell.surface_begin; s < shell.surface_end; ++s) {
        for (std::uint32_t r = g.surfaces[s].ring_begin; r < g.surfaces[s].ring_end; ++r) {
            const auto ring = ring_of(g, r);
            for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
                sum += glm::dot(g.vertices[ring[0]] - about,
                                glm::cross(g.vertices[ring[i]] - about, g.vertices[ring[i + 1]] - about));
            }
        }
    }
    return sum;
}

/// Edges of the shell that do not run exactly once there and once back.
std::size_t open_edges(const Geometry& g, const Shell& shell) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
    for (std::uint32_t s = shell.surface_begin; s < shell.surface_end; ++s) {
        for (std::uint32_t r = g.surfaces[s].ring_begin; r < g.surfaces[s].ring_end; ++r) {
            const auto ring = ring_of(g, r);
            for (std::size_t i = 0; i < ring.size(); ++i) ++runs[{ring[i], ring[(i + 1) % ring.size()]}];
        }
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : runs) {
        const auto back = runs.find({edge.second, edge.first});
        if (count != 1 || back == runs.end() || back->second != 1) ++open;
    }
    return open;
}

class TownOf : public testing::TestWithParam<std::pair<std::uint32_t, std::uint64_t>> {};
INSTANTIATE_TEST_SUITE_P(SizesAndSeeds, TownOf,
                         testing::Values(std::pair{10u, 7ull}, std::pair{250u, 0ull}, std::pair{250u, 1ull},
                                         std::pair{1500u, 5ull}));

TEST_P(TownOf, HasTheBuildingsAskedForAndDistinctIds) {
    const Town town = town_of(GetParam().first, GetParam().second);
    EXPECT_EQ(count_buildings(town.city), GetParam().first);
    const auto objects = by_id(town.city);
    for (const char* id : {"church", "castle", "clock-tower", "square-column"}) EXPECT_EQ(objects.count(id), 1u) << id;
    for (const CityObject& object : town.city.objects) {
        if (!object.parent_id.empty()) {
            EXPECT_EQ(objects.count(object.parent_id), 1u) << object.id;
        }
    }
}

TEST_P(TownOf, ShellsAreClosedOutwardAndPlanar) {
    const Town town = town_of(GetParam().first, GetParam().second);
    for (const CityObject& object : town.city.objects) {
        const Geometry& g = object.geometry;
        for (const Shell& shell : g.shells) {
            if (shell.kind == Shell::Kind::loose) continue;
            EXPECT_EQ(open_edges(g, shell), 0u) << object.id;
            EXPECT_GT(six_volumes(g, shell), 0.0) << object.id;
        }
        for (const Surface& s : g.surfaces) {
            const Vec3d normal = surface_area_vector(g, s);
            ASSERT_GT(glm::length(normal), 1e-4) << object.id << " has a face without area";
            const PlaneFrame plane = plane_of(g, s, normal);
            double lowest = 0.0;
            double highest = 0.0;
            for (std::uint32_t c = g.ring_first[s.ring_begin]; c < g.ring_first[s.ring_end]; ++c) {
                lowest = std::min(lowest, plane.height(g.vertices[g.corners[c]]));
                highest = std::max(highest, plane.height(g.vertices[g.corners[c]]));
            }
            // Planar as constructed; rounding to whole millimetres moves a corner by at most √3/2 mm, and so the fitted
            // plane.
            EXPECT_LT(std::max(highest, -lowest), 0.00175) << object.id << " surface " << s.source_index;
        }
    }
}

/// Convex pieces of a footprint: itself, or the two wings of a corner house (city/town/layout.h, Lot).
std::vector<std::vector<Vec2d>> convex_pieces(const CityObject& house) {
    const Geometry& g = house.geometry;
    for (const Surface& s : g.surfaces) {
        if (s.type != SurfaceType::ground) continue;
        std::vector<Vec2d> ring;
        for (const std::uint32_t v : ring_of(g, s.ring_begin)) ring.emplace_back(g.vertices[v]);
        std::reverse(ring.begin(), ring.end());
        if (ring.size() == 6) return {{ring[0], ring[1], ring[4], ring[5]}, {ring[1], ring[2], ring[3], ring[4]}};
        return {ring};
    }
    return {};
}

/// How far two convex rings reach into each other: the least overlap over all their edge normals (separating axis);
/// negative when apart.
double overlap(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
    double least = 1e9;
    for (const auto* ring : {&a, &b}) {
        for (std::size_t i = 0; i < ring->size(); ++i) {
            const Vec2d along = (*ring)[(i + 1) % ring->size()] - (*ring)[i];
            const Vec2d axis = glm::normalize(Vec2d(along.y, -along.x));
            const auto span = [&](const std::vector<Vec2d>& r) {
                std::pair<double, double> lo_hi{1e18, -1e18};
                for (const Vec2d& p : r) {
                    lo_hi.first = std::min(lo_hi.first, glm::dot(p, axis));
                    lo_hi.second = std::max(lo_hi.second, glm::dot(p, axis));
                }
                return lo_hi;
            };
            const auto [alo, ahi] = span(a);
            const auto [blo, bhi] = span(b);
            least = std::min(least, std::min(ahi, bhi) - std::max(alo, blo));
        }
    }
    return least;
}

TEST_P(TownOf, NoTwoBuildingsOverlap) {
    const Town town = town_of(GetParam().first, GetParam().second, TownVariant::with_tower);
    struct Piece {
        const CityObject* house;
        std::vector<Vec2d> ring;
    };
    std::map<std::pair<int, int>, std::vector<Piece>> buckets;
    std::size_t compared = 0;
    for (const CityObject& object : town.city.objects) {
        if (object.type != ObjectType::building && object.type != ObjectType::building_part) continue;
        for (const std::vector<Vec2d>& ring : convex_pieces(object)) {
            const auto x = static_cast<int>(std::floor(ring[0].x / 50.0));
            const auto y = static_cast<int>(std::floor(ring[0].y / 50.0));
            for (int dx = -1; dx <= 1; ++dx) {
                for (int dy = -1; dy <= 1; ++dy) {
                    for (const Piece& other : buckets[{x + dx, y + dy}]) {
                        if (other.house == &object ||
                            (!object.parent_id.empty() && other.house->parent_id == object.parent_id))
                            continue;
                        ++compared;
                        EXPECT_LT(overlap(ring, other.ring), 0.0025)
                            << object.id << " and " << other.house->id;  // rounding to millimetres
                    }
                }
            }
            buckets[{x, y}].push_back({&object, ring});
        }
    }
    EXPECT_GE(compared, 20u);
}

/// Unmatched edges of the ground, water apart, which lies above the river's bed: only the rim of the land may have any.
TEST_P(TownOf, GroundHasNoGapsAndNoOverlaps) {
    const Town town = town_of(GetParam().first, GetParam().second);
    using Place = std::array<long long, 3>;
    std::map<std::pair<Place, Place>, int> runs;
    Vec2d middle{0.0};
    for (const CityObject& object : town.city.objects) {
        const Geometry& g = object.geometry;
        if (object.id == "square-column") middle = Vec2d(g.vertices[0]);
        if (!is_ground(object.type) || object.type == ObjectType::water) continue;
        const auto place = [&](std::uint32_t v) {
            return Place{std::llround(g.vertices[v].x * 1000), std::llround(g.vertices[v].y * 1000),
                         std::llround(g.vertices[v].z * 1000)};
        };
        for (const Surface& s : g.surfaces) {
            const auto ring = ring_of(g, s.ring_begin);
            ASSERT_EQ(ring.size(), 3u);
            EXPECT_GT(surface_area_vector(g, s).z, 0.0) << object.id << " faces down";
            for (std::size_t i = 0; i < 3; ++i) ++runs[{place(ring[i]), place(ring[(i + 1) % 3])}];
        }
    }
    double nearest = 1e9;
    std::size_t doubled = 0;
    for (const auto& [edge, count] : runs) {
        if (count > 1) ++doubled;
        if (runs.count({edge.second, edge.first}) > 0) continue;
        nearest = std::min(nearest, glm::length(Vec2d(static_cast<double>(edge.first[0]) * 1e-3,
                                                      static_cast<double>(edge.first[1]) * 1e-3) -
                                                middle));
    }
    EXPECT_EQ(doubled, 0u);
    EXPECT_GT(nearest, 320.0) << "an edge without neighbour within the town";
}

TEST(Town, FeetStandInTheGround) {
    // The lowest corner of each house lies below the ground at all its corners: seen from the street no foot floats.
    // The ground is the surface of the court and street triangles, which the walls meet; its height there comes from
    // those triangles.
    const CityModel& city = small_town().city;
    std::vector<std::array<Vec3d, 3>> ground;
    for (const CityObject& object : city.objects) {
        if (!is_ground(object.type) || object.type == ObjectType::water) continue;
        const Geometry& g = object.geometry;
        for (const Surface& s : g.surfaces) {
            const auto ring = ring_of(g, s.ring_begin);
            ground.push_back({g.vertices[ring[0]], g.vertices[ring[1]], g.vertices[ring[2]]});
        }
    }
    for (const CityObject& object : city.objects) {
        if (object.type != ObjectType::building && object.type != ObjectType::building_part) continue;
        for (const std::vector<Vec2d>& piece : convex_pieces(object)) {
            double base = 1e9;
            for (const Vec3d& v : object.geometry.vertices) base = std::min(base, v.z);
            for (const Vec2d& p : piece) {
                bool is_found = false;
                for (const auto& [a, b, c] : ground) {
                    const auto side = [&](const Vec3d& from, const Vec3d& to) {
                        return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
                    };
                    const double u = side(b, c);
                    const double v = side(c, a);
                    const double w = side(a, b);
                    if (u < -0.01 || v < -0.01 || w < -0.01) continue;
                    is_found = true;
                    EXPECT_LT(base + 0.25, (u * a.z + v * b.z + w * c.z) / (u + v + w)) << object.id;
                    break;
                }
                EXPECT_TRUE(is_found) << object.id << " stands beside the ground";
            }
        }
    }
}

TEST(Town, SameOptionsGiveTheSameTownAndAnotherSeedAnother) {
    const Town again = town_of(250, 0);
    const Town other = town_of(250, 3);
    ASSERT_EQ(again.city.objects.size(), small_town().city.objects.size());
    for (std::size_t i = 0; i < again.city.objects.size(); ++i)
        EXPECT_TRUE(are_equal(again.city.objects[i], small_town().city.objects[i]));
    for (std::size_t i = 0; i < again.images.size(); ++i)
        EXPECT_EQ(again.images[i].pixels, small_town().images[i].pixels);
    std::size_t equal = 0;
    const auto ours = by_id(small_town().city);
    for (const CityObject& object : other.city.objects) {
        const auto found = ours.find(object.id);
        if (found != ours.end() && object.type == ObjectType::building && are_equal(object, *found->second)) ++equal;
    }
    EXPECT_LE(equal, 2u);  // church and castle, which have no geometry of their own but parts
}

TEST(Town, VariantDiffersByThePlannedTowerOnly) {
    const Town plan = town_of(250, 0, TownVariant::with_tower);
    EXPECT_EQ(plan.city.objects.size(), small_town().city.objects.size() + 1);
    const auto built = by_id(small_town().city);
    for (const CityObject& object : plan.city.objects) {
        const auto found = built.find(object.id);
        if (object.id == "planned-tower") {
            EXPECT_EQ(found, built.end());
            double lowest = 1e9;
            double highest = -1e9;
            for (const Vec3d& v : object.geometry.vertices) {
                lowest = std::min(lowest, v.z);
                highest = std::max(highest, v.z);
            }
            EXPECT_NEAR(highest - lowest, 71.0, 1.0);
        } else {
            ASSERT_NE(found, built.end()) << object.id;
            EXPECT_TRUE(are_equal(object, *found->second)) << object.id;
        }
    }
}

TEST(Town, ALargerTownHoldsTheSmaller) {
    const Town larger = town_of(900, 0);
    const auto objects = by_id(larger.city);
    for (const CityObject& object : small_town().city.objects) {
        if (!is_building(object.type)) continue;
        const auto found = objects.find(object.id);
        ASSERT_NE(found, objects.end()) << object.id;
        EXPECT_TRUE(are_equal(object, *found->second)) << object.id;
    }
}

TEST(Town, PicturesHaveBelievableAlbedo) {
    // Linear mean luminance; ranges as in city/town/paint.h. Façades are darker than plaster by their windows.
    const std::map<std::string, std::pair<double, double>> ranges = {
        {"plaster_", {0.40, 0.70}}, {"facade_", {0.28, 0.62}}, {"tiles_", {0.10, 0.25}},
        {"cobbles", {0.15, 0.30}},  {"slabs", {0.18, 0.35}},   {"gravel", {0.15, 0.35}},
        {"grass", {0.08, 0.25}},    {"water", {0.05, 0.20}},   {"masonry", {0.20, 0.45}}};
    std::set<std::string> checked;
    for (const NamedImage& image : small_town().images) {
        ASSERT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width * image.height * 3));
        double sum = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
            const auto linear = [&](std::size_t c) {
                return linear_from_srgb(static_cast<float>(image.pixels[i + c]) / 255.0f);
            };
            sum += luminance({linear(0), linear(1), linear(2)});
        }
        const double mean = sum / (image.width * image.height);
        for (const auto& [prefix, range] : ranges) {
            if (image.name.rfind(prefix, 0) != 0) continue;
            checked.insert(prefix);
            EXPECT_GT(mean, range.first) << image.name;
            EXPECT_LT(mean, range.second) << image.name;
        }
    }
    EXPECT_EQ(checked.size(), ranges.size());
}

TEST(Town, WindowsStandInWholeBays) {
    // Along a façade the texture runs over a whole number of bays (thirds of the picture), so that no window is cut at
    // a party wall.
    std::size_t walls = 0;
    for (const CityObject& object : small_town().city.objects) {
        if (object.type != ObjectType::building) continue;
        const Geometry& g = object.geometry;
        for (const Surface& s : g.surfaces) {
            const std::uint32_t first = g.ring_first[s.ring_begin];
            if (s.type != SurfaceType::wall || s.texture->index() >= 6 || g.ring_first[s.ring_begin + 1] - first != 4)
                continue;
            const double width = glm::length(Vec2d(g.vertices[g.corners[first + 1]] - g.vertices[g.corners[first]]));
            if (width < 2.0) continue;  // a dormer shows one window, drawn smaller
            const double bays = 3.0 * static_cast<double>(std::abs(g.corner_uv[first + 1].x - g.corner_uv[first].x));
            EXPECT_NEAR(bays, std::round(bays), 1e-3) << object.id;
            ++walls;
        }
    }
    EXPECT_GT(walls, 300u);
}

/// Crossings of the city's faces by the vertical above a point, and how far in plan the nearest wall of its height is.
struct Surroundings {
    int faces_above = 0;
    double wall_m = 1e9;
};
Surroundings around(const CityModel& city, const Vec3d& p) {
    Surroundings found;
    for (const CityObject& object : city.objects) {
        if (!is_building(object.type)) continue;
        const Geometry& g = object.geometry;
        for (const Surface& surface : g.surfaces) {
            bool is_inside = false;
            double lo = 1e9, hi = -1e9, nearest = 1e9;
            Vec3d normal(0.0);
            for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
                for (std::uint32_t c = g.ring_first[r]; c < g.ring_first[r + 1]; ++c) {
                    const std::uint32_t next = c + 1 < g.ring_first[r + 1] ? c + 1 : g.ring_first[r];
                    const Vec3d a = g.vertices[g.corners[c]] - p, b = g.vertices[g.corners[next]] - p;
                    if (r == surface.ring_begin) normal += glm::cross(a, b);
                    lo = std::min(lo, a.z);
                    hi = std::max(hi, a.z);
                    if ((a.y > 0) != (b.y > 0) && a.x + (b.x - a.x) * a.y / (a.y - b.y) > 0) is_inside = !is_inside;
                    const Vec2d along(b - a);
                    const double l2 = glm::dot(along, along);
                    const double t = l2 > 0 ? std::clamp(-glm::dot(Vec2d(a), along) / l2, 0.0, 1.0) : 0.0;
                    nearest = std::min(nearest, glm::length(Vec2d(a) + t * along));
                }
            }
            const Vec3d corner = g.vertices[g.corners[g.ring_first[surface.ring_begin]]] - p;
            if (is_inside && std::abs(normal.z) > 1e-6 && glm::dot(corner, normal) / normal.z > 0) ++found.faces_above;
            if (lo < 0.5 && hi > -0.5) found.wall_m = std::min(found.wall_m, nearest);
        }
    }
    return found;
}

/// Lamps hang free of all walls, in no house and under no roof, 4 to 7 m above the ground
/// (the relief is triangulated, their height is not), and light the town's streets: one each 25 m.
TEST(TownLamps, HangFreeAboutTwentyFiveMetresApart) {
    const Town& town = small_town();
    ASSERT_GT(town.lamps.size(), 50u);
    std::set<std::string> ids;
    for (const StreetLamp& lamp : town.lamps) {
        EXPECT_TRUE(ids.insert(lamp.id).second) << lamp.id;
        const Surroundings about = around(town.city, lamp.position);
        EXPECT_EQ(about.faces_above % 2, 0) << lamp.id << " is inside a house";
        EXPECT_GT(about.wall_m, 1.2) << lamp.id;  // half of the narrowest lane less its eaves
        EXPECT_LE(lamp.color_temperature_k, 3000.0);
        double nearest = 1e9;
        for (const StreetLamp& other : town.lamps) {
            if (&other != &lamp) nearest = std::min(nearest, glm::length(other.position - lamp.position));
        }
        EXPECT_GT(nearest, 3.0) << lamp.id;
        EXPECT_LT(nearest, 40.0) << lamp.id;
    }
    const Town again = town_of(250, 0);
    for (std::size_t i = 0; i < again.lamps.size(); ++i) EXPECT_EQ(again.lamps[i].position, town.lamps[i].position);
}

}  // namespace
}  // namespace skybake
