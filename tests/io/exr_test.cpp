// EXR: what our writer writes, the OpenEXR library reads back bit for bit.
#include "io/exr/exr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <bit>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/hash_rng.h"
#include "io/file/replace_file.h"
#include "scratch_folder.h"

namespace skybake::io {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<ExrChannel> kChannels = {
    {"sun.R", ExrType::float32}, {"B", ExrType::float32}, {"chart", ExrType::uint32}};

/// Smooth in one channel, noise in another (which does not shrink and is stored), whole numbers in the third.
std::uint32_t sample(int x, int y, std::size_t channel) {
    if (channel == 0)
        return std::bit_cast<std::uint32_t>(std::sin(0.01f * static_cast<float>(x)) * static_cast<float>(y));
    if (channel == 1)
        return static_cast<std::uint32_t>(
            uniform_float(1, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x), 0) * 1e9f);
    return static_cast<std::uint32_t>(x / 7 + y / 3);
}

void write_sample(const std::filesystem::path& path, int width, int height) {
    write_exr(path, width, height, kChannels, [&](int row, std::span<std::uint32_t> samples) {
        for (std::size_t c = 0; c < kChannels.size(); ++c) {
            for (int x = 0; x < width; ++x)
                samples[c * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = sample(x, row, c);
        }
    });
}

// Sizes below, at and above a block of 16 rows, odd ones included.
TEST(Exr, ComesBackBitForBit) {
    const ScratchFolder folder("exr");
    for (const auto& [width, height] : {std::pair{1, 1}, {33, 16}, {65, 47}, {1030, 1100}}) {
        write_sample(folder / "a.exr", width, height);
        ExrReader reader(folder / "a.exr");
        ASSERT_EQ(reader.width(), width);
        ASSERT_EQ(reader.height(), height);
        EXPECT_TRUE(reader.has_channel("chart"));
        EXPECT_FALSE(reader.has_channel("G"));
        std::vector<std::uint32_t> back(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
        reader.read(std::vector<ExrReader::Target>{
            {kChannels[0], back.data(), 3}, {kChannels[1], back.data() + 1, 3}, {kChannels[2], back.data() + 2, 3}});
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    ASSERT_EQ(back[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)) *
                                       3 +
                                   c],
                              sample(x, y, c))
                        << x << " " << y << " " << c;
                }
            }
        }
    }
}

TEST(Exr, SameBytesForAnyNumberOfThreads) {
    const ScratchFolder folder("exr-threads");
    write_sample(folder / "many.exr", 700, 900);
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        write_sample(folder / "one.exr", 700, 900);
    }
    EXPECT_EQ(read_file(folder / "many.exr"), read_file(folder / "one.exr"));
}

TEST(Exr, PictureKeepsEveryBit) {
    const ScratchFolder folder("exr-rgb");
    PictureRgb picture{2,
                       2,
                       {Rgb(0.0f, -0.0f, 1e-42f), Rgb(1e38f, -3.5f, 0.1f), Rgb(std::numeric_limits<float>::infinity()),
                        Rgb(1.0f / 3.0f)}};
    write_exr_rgb(folder / "p.exr", picture, {{"unit", "cd/m2"}});
    const PictureRgb back = read_exr_rgb(folder / "p.exr");
    ASSERT_EQ(back.pixels.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(std::bit_cast<std::uint32_t>(back.pixels[i][c]),
                      std::bit_cast<std::uint32_t>(picture.pixels[i][c]));
    }
}

TEST(Exr, SingleLuminanceChannelIsGrey) {
    const ScratchFolder folder("exr-grey");
    write_exr(folder / "y.exr", 2, 1, std::vector<ExrChannel>{{"Y", ExrType::float32}},
              [](int, std::span<std::uint32_t> samples) {
                  samples[0] = std::bit_cast<std::uint32_t>(2.0f);
                  samples[1] = std::bit_cast<std::uint32_t>(3.0f);
              });
    const PictureRgb back = read_exr_rgb(folder / "y.exr");
    EXPECT_EQ(back.pixels[0], Rgb(2.0f));
    EXPECT_EQ(back.pixels[1], Rgb(3.0f));
}

TEST(Exr, BrokenFilesAreRefusedByName) {
    const ScratchFolder folder("exr-broken");
    EXPECT_THAT([&] { ExrReader(folder / "none.exr"); },
                ThrowsMessage<InputError>(HasSubstr("none.exr: broken EXR, or none")));
    write_file(folder / "text.exr", std::vector<std::uint8_t>(100, 'x'));
    EXPECT_THAT([&] { ExrReader(folder / "text.exr"); },
                ThrowsMessage<InputError>(HasSubstr("text.exr: broken EXR, or none")));

    write_sample(folder / "whole.exr", 300, 300);
    const std::vector<std::uint8_t> whole = read_file(folder / "whole.exr");
    const auto read_all = [&](const std::string& name) {
        ExrReader reader(folder / name);
        std::vector<float> back(300 * 300);
        reader.read(std::vector<ExrReader::Target>{{kChannels[1], back.data(), 1}});
    };
    write_file(folder / "half.exr", std::span(whole).first(whole.size() / 2));
    EXPECT_THAT([&] { read_all("half.exr"); }, ThrowsMessage<InputError>(HasSubstr("half.exr: broken EXR")));
    std::vector<std::uint8_t> flipped = whole;
    for (std::size_t i = whole.size() / 2; i < whole.size() / 2 + 4000; ++i) flipped[i] ^= 0x55;
    write_file(folder / "flipped.exr", flipped);
    EXPECT_THAT([&] { read_all("flipped.exr"); }, ThrowsMessage<InputError>(HasSubstr("flipped.exr: broken EXR")));
    EXPECT_THAT([&] { ExrReader(folder / "whole.exr", 89'999); },
                ThrowsMessage<InputError>(HasSubstr("300 x 300 pixels are more than")));
    EXPECT_THAT([&] { read_exr_rgb(folder / "whole.exr"); },
                ThrowsMessage<InputError>(HasSubstr("has no channel 'R'")));
}

}  // namespace
}  // namespace skybake::io
