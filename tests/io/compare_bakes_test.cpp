// compare: known differences give known figures.
#include "io/manifest/compare_bakes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/manifest/write_bake.h"
#include "scratch_folder.h"
#include "small_bake.h"

namespace skybake::io {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class CompareBakes : public ::testing::Test {
  protected:
    ScratchFolder folder{"compare"};

    StoredBake stored(const std::string& name, const SmallBake& bake) {
        BakeDescription description;
        description.sampling = "full";
        for (const BakedInstant& instant : bake.light.instants) {
            InstantDescription of_instant;
            of_instant.sky_model = instant.daylight.label;
            of_instant.sky_panorama.assign(std::size_t{kPanoramaWidth} * kPanoramaHeight, Rgb(0.0f));
            description.instants.push_back(of_instant);
        }
        SilentProgress progress;
        write_bake(folder / name, {bake.scene, bake.atlas, bake.light, description, {}, {}}, progress);
        return open_bake(folder / name);
    }
    BakeComparison compare(const SmallBake& a, const SmallBake& b, const CompareOptions& options = {}) {
        SilentProgress progress;
        return compare_bakes(stored("a", a), stored("b", b), options, progress);
    }
};

/// Uniform light, so that means are known without a sum.
SmallBake uniform_bake(float sky_lx, float sun_cosine) {
    SmallBake bake = make_small_bake("");
    for (BakedInstant& instant : bake.light.instants) {
        instant.daylight.sun.normal_illuminance = Rgb(50000.0f);
        for (LightmapLayer& layer : instant.pages) {
            std::fill(layer.sky.begin(), layer.sky.end(), Rgb(sky_lx));
            std::fill(layer.sun_cosine.begin(), layer.sun_cosine.end(), sun_cosine);
        }
    }
    return bake;
}

// 40·32 + 16·12 + 8·12 + 16·4 texels of charts, less the buried one.
constexpr std::uint64_t kTexels = 40 * 32 + 16 * 12 + 8 * 12 + 16 * 4 - 1;

TEST_F(CompareBakes, EqualBakesDoNotDiffer) {
    const BakeComparison c = compare(make_small_bake(""), make_small_bake(""));
    EXPECT_EQ(c.all.total.texels, 2 * kTexels);
    EXPECT_EQ(c.all.total.rmse, 0.0);
    EXPECT_EQ(c.all.total.max_abs, 0.0);
    EXPECT_GT(c.all.total.mean, 0.0);
    EXPECT_EQ(c.all.texels_off, 0u);
    EXPECT_TRUE(c.worst.empty());
}

// A constant difference is bias, RMSE and maximum at once; it shows in its own part only.
TEST_F(CompareBakes, ConstantDifferenceIsBiasAndRmse) {
    const BakeComparison c = compare(uniform_bake(10300.0f, 0.5f), uniform_bake(10000.0f, 0.5f));
    const double tolerance = 1e-2;  // float luminance of 35,000 lx
    EXPECT_NEAR(c.all.total.mean, 35000.0, tolerance);
    EXPECT_NEAR(c.all.total.bias, 300.0, tolerance);
    EXPECT_NEAR(c.all.total.rmse, 300.0, tolerance);
    EXPECT_NEAR(c.all.total.max_abs, 300.0, tolerance);
    EXPECT_NEAR(c.all.total.rmse_over_mean(), 300.0 / 35000.0, 1e-6);
    EXPECT_NEAR(c.all.sky.bias, 300.0, tolerance);
    EXPECT_NEAR(c.all.sky.mean, 10000.0, tolerance);
    EXPECT_EQ(c.all.sun.rmse, 0.0);
    EXPECT_NEAR(c.all.sun.mean, 25000.0, tolerance);
    EXPECT_EQ(c.all.texels_off, 0u);
}

// Reflected light is a part of its own, and of the total; a bake without has none.
TEST_F(CompareBakes, ReflectedLightIsCompared) {
    const auto with_indirect = [](float lx) {
        SmallBake bake = uniform_bake(10000.0f, 0.0f);
        for (BakedInstant& instant : bake.light.instants) {
            for (LightmapLayer& layer : instant.pages) layer.indirect.assign(layer.sky.size(), Rgb(lx));
        }
        return bake;
    };
    const BakeComparison c = compare(with_indirect(1200.0f), with_indirect(1000.0f));
    EXPECT_NEAR(c.all.indirect.mean, 1000.0, 1e-2);
    EXPECT_NEAR(c.all.indirect.bias, 200.0, 1e-2);
    EXPECT_NEAR(c.all.total.bias, 200.0, 1e-2);
    EXPECT_NEAR(c.all.total.mean, 11000.0, 1e-2);
    EXPECT_EQ(c.all.sky.rmse, 0.0);
    const BakeComparison none = compare(uniform_bake(10000.0f, 0.0f), with_indirect(1000.0f));
    EXPECT_NEAR(none.all.indirect.bias, -1000.0, 1e-2);
    EXPECT_EQ(compare(uniform_bake(1.0f, 0.0f), uniform_bake(1.0f, 0.0f)).all.indirect.mean, 0.0);
}

// One texel of one instant: RMSE = d/√n, the share above 10 % of the mean is one texel, and the list names its place.
TEST_F(CompareBakes, SingleTexelIsFoundAndNamed) {
    SmallBake a = uniform_bake(10000.0f, 0.0f);
    const std::size_t texel = static_cast<std::size_t>(7 * 32 + 24);  // page 1, the wall to the west
    a.light.instants[1].pages[1].sky[texel] = Rgb(4000.0f);
    const BakeComparison c = compare(a, uniform_bake(10000.0f, 0.0f));
    EXPECT_EQ(c.all.texels_off, 1u);
    EXPECT_EQ(c.instants[0].deviations.texels_off, 0u);
    EXPECT_EQ(c.instants[1].deviations.texels_off, 1u);
    EXPECT_NEAR(c.instants[1].deviations.total.rmse, 6000.0 / std::sqrt(static_cast<double>(kTexels)), 1e-2);
    EXPECT_NEAR(c.all.total.rmse, 6000.0 / std::sqrt(2.0 * static_cast<double>(kTexels)), 1e-2);
    EXPECT_NEAR(c.all.total.max_abs, 6000.0, 1e-2);
    ASSERT_EQ(c.worst.size(), 1u);
    EXPECT_EQ(c.worst[0].instant, 1u);
    EXPECT_EQ(c.worst[0].page, 1u);
    EXPECT_EQ(c.worst[0].chart, 2u);
    EXPECT_EQ(c.worst[0].column, 24);
    EXPECT_EQ(c.worst[0].row, 7);
    EXPECT_NEAR(c.worst[0].a_lx, 4000.0, 1e-2);
    EXPECT_NEAR(c.worst[0].b_lx, 10000.0, 1e-2);
}

// Gutters and buried texels carry no light of their own and do not count.
TEST_F(CompareBakes, GuttersAndBuriedTexelsAreLeftOut) {
    SmallBake a = uniform_bake(10000.0f, 0.0f);
    for (BakedInstant& instant : a.light.instants) {
        for (std::size_t p = 0; p < 2; ++p) {
            for (std::size_t t = 0; t < a.light.pages[p].state.size(); ++t) {
                if (a.light.pages[p].state[t] != TexelState::chart) instant.pages[p].sky[t] = Rgb(77.0f);
            }
        }
    }
    SmallBake b = uniform_bake(10000.0f, 0.0f);
    b.light.pages[0].state[static_cast<std::size_t>(10 * 48 + 10)] = TexelState::buried;
    const BakeComparison c = compare(a, b);
    EXPECT_EQ(c.all.total.texels, 2 * (kTexels - 1));
    EXPECT_EQ(c.all.total.rmse, 0.0);
    EXPECT_EQ(c.buried_in_one, 1u);
}

TEST_F(CompareBakes, OtherAtlasIsRefusedAndTheDifferenceNamed) {
    const SmallBake b = make_small_bake("");
    SmallBake a = b;
    a.atlas.texel_m = 0.25f;
    EXPECT_THAT([&] { compare(a, b); },
                ThrowsMessage<InputError>(HasSubstr("are not bakes of one atlas: texels are 0.25 m and 0.5 m")));
    a = b;
    a.atlas.charts.pop_back();
    a.light.pages[1].state.assign(a.light.pages[1].state.size(), TexelState::empty);
    EXPECT_THAT([&] { compare(a, b); }, ThrowsMessage<InputError>(HasSubstr("3 charts and 4")));
    a = b;
    a.light.pages[1].chart[static_cast<std::size_t>(5 * 32 + 5)] = ChartId(3);
    EXPECT_THAT([&] { compare(a, b); },
                ThrowsMessage<InputError>(
                    HasSubstr("page 1, column 5, row 5 belongs to chart 3 in the one and to chart 1 in the other")));
    EXPECT_THAT([&] { compare(make_small_bake("", 1), b); },
                ThrowsMessage<InputError>(HasSubstr("have 1 instants and 2")));
}

TEST_F(CompareBakes, LightThatIsNotFiniteIsRefused) {
    SmallBake a = make_small_bake("");
    a.light.instants[0].pages[0].sky[static_cast<std::size_t>(10 * 48 + 10)].y =
        std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT([&] { compare(a, make_small_bake("")); },
                ThrowsMessage<InputError>(HasSubstr("i0_p0.exr: holds light that is not finite")));
}

TEST_F(CompareBakes, PicturesAreRedWhereAIsBrighterAndBlueWhereDarker) {
    SmallBake a = uniform_bake(10000.0f, 0.0f);
    a.light.instants[0].pages[0].sky[static_cast<std::size_t>(10 * 48 + 10)] = Rgb(12000.0f);
    a.light.instants[0].pages[0].sky[static_cast<std::size_t>(10 * 48 + 12)] = Rgb(9500.0f);
    CompareOptions options;
    options.picture_folder = folder / "pictures";
    const BakeComparison c = compare(a, uniform_bake(10000.0f, 0.0f), options);
    ASSERT_EQ(c.pictures.size(), 4u);
    EXPECT_EQ(c.pictures[0], "i0_p0_plus_minus_1000lx.png");  // 10 % of the mean
    const Image8 picture = read_image(folder / "pictures/i0_p0_plus_minus_1000lx.png");
    ASSERT_EQ(picture.width, 48);
    ASSERT_EQ(picture.height, 40 + 16);
    const auto pixel = [&](std::size_t row, std::size_t column, std::size_t channel) {
        return picture.pixels[3 * (48 * row + column) + channel];
    };
    EXPECT_GT(pixel(10, 10, 0), 150);  // beyond the range: full red
    EXPECT_LT(pixel(10, 10, 2), 60);
    EXPECT_GT(pixel(10, 12, 2), pixel(10, 12, 0) + 30);  // half the range: light blue
    EXPECT_EQ(pixel(10, 14, 0), 255);                    // equal: white
    EXPECT_EQ(pixel(0, 0, 0), 96);                       // of no chart: grey
    EXPECT_GT(pixel(55, 1, 2), pixel(55, 1, 0));         // the bar runs from blue
    EXPECT_GT(pixel(55, 46, 0), pixel(55, 46, 2));       // to red
}

}  // namespace
}  // namespace skybake::io
