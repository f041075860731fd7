// Which objects make the city: by rectangle, by id, each once.
#include "city/select.h"

#include <gtest/gtest.h>

#include "city/extrude.h"

namespace skybake {
namespace {

CityObject house(const std::string& id, double x, const std::string& parent = "") {
    CityObject object;
    object.id = id;
    object.parent_id = parent;
    object.type = parent.empty() ? ObjectType::building : ObjectType::building_part;
    extrude({.rings = {{{x, 0}, {x + 5, 0}, {x + 5, 5}, {x, 5}}}, .ridge_m = 9.0}, object.geometry);
    return object;
}

TEST(Select, TheSameHouseUnderAnotherIdIsLeftOut) {
    CityModel city;
    city.objects = {house("a", 0), house("b", 10), house("c", 0.01), house("d", 10.2)};
    FindingLog findings;
    drop_duplicates(city, 2, findings);
    EXPECT_TRUE(city.objects[2].geometry.is_empty()) << "a again, a centimetre away";
    EXPECT_FALSE(city.objects[3].geometry.is_empty()) << "20 cm away is another house";
    EXPECT_EQ(findings.count("SB217"), 1u);
}

TEST(Select, ARectangleKeepsWholeFamiliesAndCutsGround) {
    CityModel city;
    city.objects = {house("a", 0), house("a-1", 4, "a"), house("b", 100)};
    CityObject ground = house("g", 0);
    ground.type = ObjectType::terrain;
    Geometry more = house("", 100).geometry;
    for (Vec3d& p : more.vertices) ground.geometry.vertices.push_back(p);
    extrude({.rings = {{{100, 0}, {105, 0}, {105, 5}, {100, 5}}}, .ridge_m = 1.0}, ground.geometry);
    city.objects.push_back(ground);
    FindingLog findings;
    keep_within(city, {{-1, -1}, {20, 20}}, findings);
    ASSERT_EQ(city.objects.size(), 3u);
    EXPECT_EQ(city.objects[1].id, "a-1");
    EXPECT_EQ(city.objects[2].geometry.surfaces.size(), 6u);
    EXPECT_EQ(findings.count("SB121"), 1u);
}

TEST(Select, WhatIsExcludedTakesItsPartsAlong) {
    CityModel city;
    city.objects = {house("a-1", 4, "a"), house("a", 0), house("b", 100)};
    FindingLog findings;
    EXPECT_EQ(exclude(city, {"x"}, findings), "x");
    EXPECT_EQ(city.objects.size(), 3u);
    EXPECT_EQ(exclude(city, {"a"}, findings), std::nullopt);
    ASSERT_EQ(city.objects.size(), 1u);
    EXPECT_EQ(city.objects[0].id, "b");
}

}  // namespace
}  // namespace skybake
