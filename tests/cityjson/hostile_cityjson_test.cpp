// CityJSON that wants to do harm: an error or findings, soon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "error_of.h"
#include "temporary_city.h"

namespace skybake {
namespace {

using testing::HasSubstr;

class HostileCityJson : public testing::Test {
  protected:
    ~HostileCityJson() override {
        EXPECT_LT(std::chrono::steady_clock::now() - begun_, std::chrono::seconds(20)) << "soon";
    }

  private:
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

std::string error_of(const std::string& text) {
    return skybake::error_of([&] { load_text(text); });
}

TEST_F(HostileCityJson, DeepNestsAreRefused) {
    const std::string deep(1'000'000, '[');
    EXPECT_THAT(error_of(document("\"b\":{\"type\":\"Building\",\"geometry\":" + deep)), HasSubstr("a.city.json"));
    std::string closed = deep;
    closed.append(1'000'000, ']');
    // Whole, it may be an error or a finding; it ends.
    try {
        EXPECT_GT(
            load_text(document("\"b\":{\"type\":\"Building\",\"geometry\":" + closed + "}")).findings.list().size(),
            0u);
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a.city.json"));
    }
}

TEST_F(HostileCityJson, ParentsInCirclesEnd) {
    const LoadedCity loaded = load_text(document(building(solid(), "a", R"("parents":["b"],"children":["b"],)") + "," +
                                                 building(solid(), "b", R"("parents":["a"],"children":["a"],)")));
    EXPECT_GE(loaded.summary.surfaces, 6u);
    const TemporaryFolder folder;
    LoadOptions options;
    options.bbox = Box2d{{-1, -1}, {2, 2}};
    EXPECT_GE(load(folder.write("a.city.json", document(building(solid(), "a", R"("parents":["a"],)"))), options)
                  .summary.surfaces,
              6u);
}

TEST_F(HostileCityJson, NumbersAtTheEndsOfTheirRange) {
    for (const std::string number : {"1e308", "-1e308", "1e38", "-2147483.648", "9223372036854775807", "1e-308"}) {
        const LoadedCity loaded = load_text(document(building(solid()), "[[0,0,0],[1000,0,0],[1000,1000," + number +
                                                                            "],[0,1000,0],[0,0,1000],[1000,0,1000],"
                                                                            "[1000,1000,1000],[0,1000,1000]]"));
        const Vec3d size = extent_of(loaded.city).size();
        EXPECT_LT(size.z, 1e7) << number;
    }
    for (const std::string index : {"-1", "4294967296", "9223372036854775807", "0.5", "null", "\"0\""}) {
        const LoadedCity loaded =
            load_text(document(building(R"({"type":"MultiSurface","lod":"1","boundaries":[[[0,1,)" + index + "]]]}")));
        EXPECT_EQ(loaded.summary.surfaces, 0u) << index;
    }
}

TEST_F(HostileCityJson, ManyOverlappingSurfacesStayCheap) {
    std::string surfaces;
    for (int i = 0; i < 50'000; ++i) surfaces += std::string(i > 0 ? "," : "") + "[[0,1,2,3]]";
    const LoadedCity loaded =
        load_text(document(building(R"({"type":"MultiSurface","lod":"1","boundaries":[)" + surfaces + "]}")));
    EXPECT_EQ(loaded.summary.surfaces, 1u) << "the same surface counts once";
}

}  // namespace
}  // namespace skybake
