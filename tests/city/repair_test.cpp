// Repair of small geometries with one fault each. Truth: cubes, whose volume, normals and closedness are plain.
#include "city/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "city/polygon.h"
#include "polygons.h"

namespace skybake {
namespace {

using Ring = std::vector<Vec3d>;

/// The six outward faces of a box.
std::vector<Ring> box_faces(const Vec3d& lo, const Vec3d& hi) {
    const auto p = [&](int x, int y, int z) { return Vec3d(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
    return {{p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)}, {p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)},
            {p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)}, {p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)},
            {p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1)}, {p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1)}};
}

CityModel city_of(const std::vector<Ring>& faces, Shell::Kind kind = Shell::Kind::outer,
                  ObjectType type = ObjectType::building) {
    CityModel city;
    CityObject object;
    object.id = "b";
    object.type = type;
    object.where = "a.json: #/CityObjects/b";
    for (const Ring& face : faces) add_polygon(object.geometry, {face});
    object.geometry.shells.at(0).kind = kind;
    city.objects.push_back(std::move(object));
    return city;
}

RepairSummary run(CityModel& city, FindingLog& findings) {
    SilentProgress progress;
    return repair(city, findings, progress);
}

/// Volume that the surfaces enclose: positive when they face outward (Gauss).
double volume(const Geometry& g) {
    double sum = 0.0;
    for (const Surface& s : g.surfaces)
        sum += glm::dot(surface_area_vector(g, s), g.vertices[g.corners[g.ring_first[s.ring_begin]]]) / 3.0;
    return sum;
}

TEST(Repair, AGoodCubeStaysAsItIs) {
    CityModel city = city_of(box_faces({0, 0, 0}, {2, 3, 4}));
    FindingLog findings;
    const RepairSummary summary = run(city, findings);
    EXPECT_TRUE(findings.empty());
    EXPECT_EQ(summary.triangles, 12u);
    EXPECT_EQ(summary.closed_shells, 1u);
    EXPECT_EQ(city.objects[0].geometry.vertices.size(), 8u) << "the faces' corners at one place became one vertex";
    EXPECT_NEAR(volume(city.objects[0].geometry), 24.0, 1e-12);
}

TEST(Repair, InvertedFacesAndSolidsAreTurned) {
    for (const int inverted : {0b000001, 0b110000, 0b111110, 0b111111}) {
        std::vector<Ring> faces = box_faces({5e5, 5e6, 0}, {5e5 + 1, 5e6 + 1, 1});
        for (int i = 0; i < 6; ++i) {
            if (inverted >> i & 1)
                std::reverse(faces[static_cast<std::size_t>(i)].begin(), faces[static_cast<std::size_t>(i)].end());
        }
        CityModel city = city_of(faces);
        FindingLog findings;
        run(city, findings);
        EXPECT_NEAR(volume(city.objects[0].geometry), 1.0, 1e-6) << inverted;
        EXPECT_EQ(findings.count(inverted == 0b111111 ? "SB208" : "SB207"), 1u) << inverted;
        CityModel loose = city_of(faces, Shell::Kind::loose);
        run(loose, findings);
        EXPECT_NEAR(volume(loose.objects[0].geometry), 1.0, 1e-6) << inverted;
    }
}

TEST(Repair, ACavityFacesInward) {
    CityModel city = city_of(box_faces({0, 0, 0}, {4, 4, 4}));
    Geometry& g = city.objects[0].geometry;
    for (const Ring& face : box_faces({1, 1, 1}, {3, 3, 3}))
        add_polygon(g, {face});  // outward: the wrong way for a cavity
    g.shells = {{0, 6, Shell::Kind::outer}, {6, 12, Shell::Kind::inner}};
    FindingLog findings;
    run(city, findings);
    EXPECT_NEAR(volume(g), 64.0 - 8.0, 1e-9);
    EXPECT_EQ(findings.count("SB208"), 1u);
}

TEST(Repair, ABoxWithoutFloorFacesOutwardAndIsTold) {
    std::vector<Ring> faces = box_faces({0, 0, 0}, {10, 10, 5});
    faces.erase(faces.begin());
    for (Ring& face : faces) std::reverse(face.begin(), face.end());
    CityModel city = city_of(faces);
    FindingLog findings;
    const RepairSummary summary = run(city, findings);
    EXPECT_EQ(summary.open_shells, 1u);
    EXPECT_EQ(to_text(findings.list().back()),
              "SB209 warning: a.json: #/CityObjects/b: 4 edges of a solid belong to one surface only, the first at "
              "(10.000, 0.000, 0.000). Light may leak in; close the solid where the "
              "picture shows it.");
    EXPECT_GT(surface_area_vector(city.objects[0].geometry, city.objects[0].geometry.surfaces[0]).z, 0.0);
}

TEST(Repair, TerrainFacesUp) {
    CityModel city = city_of({{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, Shell::Kind::loose,
                             ObjectType::terrain);
    FindingLog findings;
    run(city, findings);
    for (const Surface& s : city.objects[0].geometry.surfaces)
        EXPECT_GT(surface_area_vector(city.objects[0].geometry, s).z, 0.0);
    EXPECT_EQ(city.objects[0].geometry.surfaces[0].type, SurfaceType::terrain);
}

TEST(Repair, ABowTieBecomesItsTwoHalves) {
    CityModel city = city_of({{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}}, Shell::Kind::loose);
    FindingLog findings;
    const RepairSummary summary = run(city, findings);
    EXPECT_EQ(summary.surfaces, 2u);
    EXPECT_EQ(summary.triangles, 2u);
    double area = 0.0;  // two triangles of base 2 and height 1
    for (const Surface& s : city.objects[0].geometry.surfaces)
        area += glm::length(surface_area_vector(city.objects[0].geometry, s));
    EXPECT_NEAR(area, 2.0, 1e-12);
    EXPECT_EQ(to_text(findings.list().front()),
              "SB203 warning: a.json: #/CityObjects/b: polygon 0: ring crosses or touches itself or another near "
              "(1.000, 1.000, 0.000) (Self-intersection); replaced by 2 without crossing. "
              "Repair the ring, or pass --strict to stop here.");
}

TEST(Repair, SpikesSliversAndRepetitionsGo) {
    std::vector<Ring> faces = box_faces({0, 0, 0}, {1, 1, 1});
    faces[1] = {{0, 0, 1}, {1, 0, 1}, {1, 0, 1}, {1, 1, 1},
                {1, 3, 1}, {1, 1, 1}, {0, 1, 1}};  // a corner twice, and a spike
    faces.push_back({{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}});
    faces.push_back(faces[2]);
    faces.push_back({{5, 5, 5}, {5, 5, 5}, {6, 6, 6}});
    CityModel city = city_of(faces);
    FindingLog findings;
    const RepairSummary summary = run(city, findings);
    EXPECT_EQ(summary.surfaces, 6u);
    EXPECT_EQ(summary.closed_shells, 1u);
    EXPECT_EQ(findings.count("SB202"), 1u);
    EXPECT_EQ(findings.count("SB204"), 2u);
    EXPECT_EQ(findings.count("SB205"), 1u);
    EXPECT_NEAR(volume(city.objects[0].geometry), 1.0, 1e-12);
}

TEST(Repair, AMillimetreIsMergedAndTwoAreNot) {
    for (const double gap : {0.001, 0.002}) {
        std::vector<Ring> faces = box_faces({0, 0, 0}, {1, 1, 1});
        faces[1][0].z += gap;
        CityModel city = city_of(faces);
        FindingLog findings;
        EXPECT_EQ(run(city, findings).closed_shells, gap < 0.0015 ? 1u : 0u);
        EXPECT_EQ(findings.count("SB210"), gap < 0.0015 ? 1u : 0u);
    }
}

TEST(Repair, WhatIsNoPlaceIsLeftOut) {
    for (const double z :
         {-2147483.648, 1e38, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        std::vector<Ring> faces = box_faces({6.5e5, 6.8e6, 40}, {6.5e5 + 9, 6.8e6 + 9, 60});
        faces[1][0].z = z;
        CityModel city = city_of(faces);
        FindingLog findings;
        EXPECT_EQ(run(city, findings).surfaces, 5u) << z;
        EXPECT_EQ(findings.count("SB211"), 1u) << z;
        EXPECT_EQ(extent_of(city).hi.z, 60.0) << z;
    }
}

TEST(Repair, AFoldAndAnOverlapAreTold) {
    std::vector<Ring> faces = box_faces({0, 0, 0}, {1, 1, 1});
    faces[1][0].z = faces[2][3].z = faces[5][2].z = 1.5;
    CityModel city = city_of(faces);
    CityObject other = city_of(box_faces({0.5, 0.5, 0.2}, {3, 3, 0.6})).objects[0];
    other.id = "c";
    other.parent_id = "b";
    city.objects.push_back(other);
    FindingLog findings;
    run(city, findings);
    EXPECT_EQ(findings.count("SB206"), 1u);
    EXPECT_EQ(findings.count("SB214"), 1u);
}

TEST(Repair, AnObjectFarAwayIsLeftOut) {
    CityModel city;
    for (int i = 0; i < 5; ++i) {
        const Vec3d o = i == 4 ? Vec3d(0.0) : Vec3d(85'000 + 20 * i, 447'000, 0);
        city.objects.push_back(city_of(box_faces(o, o + 10.0)).objects[0]);
    }
    FindingLog findings;
    EXPECT_EQ(run(city, findings).surfaces, 24u);
    EXPECT_EQ(findings.count("SB216"), 1u);
}

TEST(Repair, ManyObjectsTakeLinearTimeAndTheSameResult) {
    CityModel city;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3d o(15.0 * (i % 150), 15.0 * (i / 150), 0);
        city.objects.push_back(city_of(box_faces(o, o + 10.0)).objects[0]);
        city.objects.back().id = std::to_string(i);
    }
    FindingLog findings;
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(run(city, findings).closed_shells, 20'000u);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(), 10.0);
}

TEST(RepairOffset, DoubledCoordinatesMoveBackAndOthersStay) {
    const Vec3d translate(265'000, 6'289'000, 138);
    const Box3d stated{translate - 100.0, translate + 100.0};
    CityModel doubled = city_of(box_faces(2.0 * translate, 2.0 * translate + 10.0));
    FindingLog findings;
    repair_offset(doubled, 0, translate, stated, "a.json", findings);
    EXPECT_EQ(extent_of(doubled).lo, translate);
    EXPECT_EQ(findings.count("SB201"), 1u);
    CityModel good = city_of(box_faces(translate, translate + 10.0));
    FindingLog none;
    repair_offset(good, 0, translate, stated, "a.json", none);
    EXPECT_EQ(extent_of(good).lo, translate);
    EXPECT_TRUE(none.empty());
    CityModel elsewhere = city_of(box_faces({1, 1, 1}, {2, 2, 2}));
    repair_offset(elsewhere, 0, translate, stated, "a.json", none);
    EXPECT_EQ(extent_of(elsewhere).lo, Vec3d(1.0));
    EXPECT_EQ(none.count("SB215"), 1u);
}

}  // namespace
}  // namespace skybake
