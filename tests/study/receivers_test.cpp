// Receivers of a scene whose areas and storeys are known.
#include "study/receivers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "study/study_scenes.h"

namespace skybake {
namespace {

ReceiverSet receivers(QuadScene& quads, ReceiverOptions options) {
    Scene scene = quads.scene();
    // Faces without semantics, as a block model has them.
    for (Face& face : scene.faces) face.type = SurfaceType::unknown;
    const RayScene rays(scene);
    return make_receivers(scene, rays, options);
}

double area_of(const ReceiverSet& set) {
    double area = 0.0;
    for (const Sample& sample : set.samples) area += static_cast<double>(sample.area_m2);
    return area;
}

/// A house of 10 × 8 m, 7 m high, on ground of 40 × 40 m.
TEST(Receivers, FacadesByStoreys) {
    QuadScene quads;
    quads.ground(20).box({-5, -4, 0}, {5, 4, 7});
    const ReceiverSet set = receivers(quads, {.kinds = {ReceiverKind::facade}, .cell_m = 0.7});
    EXPECT_NEAR(area_of(set), 2 * 7.0 * (10 + 8), 1e-3);
    EXPECT_EQ(set.receivers.size(), 4u * 3u);  // storeys of 3, 3 and 1 m
    std::set<std::string> ids;
    for (const Receiver& receiver : set.receivers) {
        ids.insert(receiver.id);
        ASSERT_TRUE(receiver.storey.has_value());
        const double width = receiver.area_m2 / (*receiver.storey == 2 ? 1.0 : 3.0);
        EXPECT_TRUE(std::abs(width - 10.0) < 1e-3 || std::abs(width - 8.0) < 1e-3) << width;
        for (std::uint32_t i = receiver.sample_begin; i < receiver.sample_end; ++i) {
            EXPECT_EQ(static_cast<int>(set.samples[i].position.z / 3.0), *receiver.storey);
            EXPECT_LE(glm::length(set.samples[i].u), 0.7f + 1e-4f);
            EXPECT_LE(glm::length(set.samples[i].v), 0.7f + 1e-4f);
        }
    }
    EXPECT_EQ(ids.size(), set.receivers.size());
}

TEST(Receivers, RoofsAndGroundOutsideTheHouse) {
    QuadScene quads;
    quads.ground(20).box({-5, -4, 0}, {5, 4, 7});
    EXPECT_NEAR(area_of(receivers(quads, {.kinds = {ReceiverKind::roof}})), 80.0, 1e-3);
    const ReceiverSet ground = receivers(quads, {.kinds = {ReceiverKind::ground}, .height_m = 1.5});
    EXPECT_NEAR(area_of(ground), 1600.0 - 80.0, 1e-3);
    EXPECT_EQ(ground.enclosed, 80u);
    for (const Sample& sample : ground.samples) EXPECT_NEAR(sample.position.z, 1.5, 1e-6);
}

/// Two houses share a party wall: of it, only what stands above the lower one is a façade.
TEST(Receivers, PartyWallsAreNoFacades) {
    QuadScene quads;
    quads.ground(20).box({-5, -4, 0}, {0, 4, 9}).box({0, -4, 0}, {5, 4, 6});
    const ReceiverSet set = receivers(quads, {.kinds = {ReceiverKind::facade}});
    EXPECT_NEAR(area_of(set), 9.0 * (5 + 5 + 8) + 6.0 * (5 + 5 + 8) + 3.0 * 8, 1e-3);
}

/// In a row of three, the middle house's party walls see, through the neighbour, two walls in one place.
TEST(Receivers, RowsOfHousesHaveTwoFacadesEach) {
    QuadScene quads;
    quads.ground(40).box({-15, -4, 0}, {-5, 4, 6}).box({-5, -4, 0}, {5, 4, 6}).box({5, -4, 0}, {15, 4, 6});
    quads.box({15, -4, 0}, {25, 4, 6});
    EXPECT_NEAR(area_of(receivers(quads, {.kinds = {ReceiverKind::facade}})), 6.0 * (2 * 40 + 2 * 8), 1e-3);
}

TEST(Receivers, PolygonsHoldTheCellsInThem) {
    QuadScene quads;
    quads.ground(20);
    const AreaPolygon ring{"park", {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{2, 2}, {4, 2}, {4, 4}, {2, 4}}}};
    const AreaPolygon outside{"far", {{{100, 100}, {110, 100}, {110, 110}}}};
    const ReceiverSet set =
        receivers(quads, {.kinds = {ReceiverKind::polygon}, .cell_m = 0.5, .polygons = {ring, outside}});
    EXPECT_NEAR(area_of(set), 96.0, 1e-3);
    ASSERT_EQ(set.receivers.size(), 2u);
    EXPECT_EQ(set.receivers[1].sample_begin, set.receivers[1].sample_end);
}

}  // namespace
}  // namespace skybake
