// Pictures: what is written comes back, and what is broken is refused by name.
#include "io/image/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include <jpeglib.h>

#include "base/error.h"
#include "base/hash_rng.h"
#include "io/file/replace_file.h"
#include "scratch_folder.h"

namespace skybake::io {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Half smooth, half noise, so that every filter of PNG is chosen somewhere.
Image8 sample_image(int width, int height, int channels) {
    Image8 image{width, height, channels, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < channels; ++c) {
                const std::uint64_t noise = mix64(static_cast<std::uint64_t>((y * width + x) * 4 + c + 1));
                image.pixels.push_back(static_cast<std::uint8_t>(y < height / 2 ? x * 3 + y * 2 + c * 40 : noise));
            }
        }
    }
    return image;
}

std::vector<std::uint8_t> encode_jpeg(const Image8& image, J_COLOR_SPACE space) {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &data, &size);
    info.image_width = static_cast<JDIMENSION>(image.width);
    info.image_height = static_cast<JDIMENSION>(image.height);
    info.input_components = image.channels;
    info.in_color_space = space;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 95, TRUE);
    jpeg_start_compress(&info, TRUE);
    std::vector<std::uint8_t> pixels = image.pixels;
    while (info.next_scanline < info.image_height) {
        JSAMPROW row = pixels.data() + static_cast<std::size_t>(info.next_scanline) *
                                           static_cast<std::size_t>(image.width * image.channels);
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    std::vector<std::uint8_t> bytes(data, data + size);
    jpeg_destroy_compress(&info);
    std::free(data);
    return bytes;
}

class PngChannels : public ::testing::TestWithParam<int> {};

// Lossless: our encoder against libpng's decoder, odd sizes included.
TEST_P(PngChannels, ComesBackBitForBit) {
    for (const auto& [width, height] : {std::pair{1, 1}, {37, 53}, {257, 3}}) {
        const Image8 image = sample_image(width, height, GetParam());
        const std::vector<std::uint8_t> bytes = encode_png(image);
        const Image8 back = decode_image(bytes, "x.png");
        EXPECT_EQ(back.width, width);
        EXPECT_EQ(back.height, height);
        EXPECT_EQ(back.channels, GetParam());
        EXPECT_EQ(back.pixels, image.pixels);
    }
}
INSTANTIATE_TEST_SUITE_P(All, PngChannels, ::testing::Values(1, 3, 4));

TEST(Png, CutOffIsRefusedByName) {
    std::vector<std::uint8_t> bytes = encode_png(sample_image(64, 64, 3));
    bytes.resize(bytes.size() / 2);
    EXPECT_THAT([&] { decode_image(bytes, "half.png"); }, ThrowsMessage<InputError>(HasSubstr("half.png: broken PNG")));
}

TEST(Png, FlippedBitIsRefused) {
    std::vector<std::uint8_t> bytes = encode_png(sample_image(64, 64, 3));
    bytes[bytes.size() / 2] ^= 0x10;
    EXPECT_THAT([&] { decode_image(bytes, "flipped.png"); },
                ThrowsMessage<InputError>(HasSubstr("flipped.png: broken PNG")));
}

// A header that claims more than the limit must not be believed before memory is asked for.
TEST(Png, TooManyPixelsAreRefused) {
    const std::vector<std::uint8_t> bytes = encode_png(sample_image(64, 64, 1));
    EXPECT_THAT([&] { decode_image(bytes, "big.png", 4095); },
                ThrowsMessage<InputError>(HasSubstr("64 x 64 pixels are more than the 4095")));
    EXPECT_NO_THROW(decode_image(bytes, "big.png", 4096));
}

// Quality 95 of a smooth picture: the codec's own error stays within a few steps of 255.
TEST(Jpeg, ColourAndGreyComeBackNearly) {
    for (const int channels : {1, 3}) {
        Image8 image{64, 48, channels, {}};
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                for (int c = 0; c < channels; ++c)
                    image.pixels.push_back(static_cast<std::uint8_t>(2 * x + y + 20 * c));
            }
        }
        const Image8 back = decode_image(encode_jpeg(image, channels == 1 ? JCS_GRAYSCALE : JCS_RGB), "x.jpg");
        ASSERT_EQ(back.channels, channels);
        ASSERT_EQ(back.pixels.size(), image.pixels.size());
        for (std::size_t i = 0; i < back.pixels.size(); ++i)
            ASSERT_NEAR(back.pixels[i], image.pixels[i], 8) << "at " << i;
    }
}

// Inks of a plain CMYK JPEG, as libjpeg writes it with the Adobe marker: stored inverted, 255 means no ink.
TEST(Jpeg, InksBecomeLight) {
    Image8 image{16, 16, 4, {}};
    for (int i = 0; i < 256; ++i) image.pixels.insert(image.pixels.end(), {255, 128, 0, 255});
    const Image8 back = decode_image(encode_jpeg(image, JCS_CMYK), "x.jpg");
    ASSERT_EQ(back.channels, 3);
    EXPECT_NEAR(back.pixels[0], 255, 3);
    EXPECT_NEAR(back.pixels[1], 128, 3);
    EXPECT_NEAR(back.pixels[2], 0, 3);
}

TEST(Jpeg, CutOffIsRefusedByName) {
    std::vector<std::uint8_t> bytes = encode_jpeg(sample_image(64, 64, 3), JCS_RGB);
    bytes.resize(bytes.size() / 2);
    EXPECT_THAT([&] { decode_image(bytes, "half.jpg"); },
                ThrowsMessage<InputError>(HasSubstr("half.jpg: broken JPEG")));
    bytes.resize(30);
    EXPECT_THAT([&] { decode_image(bytes, "tiny.jpg"); },
                ThrowsMessage<InputError>(HasSubstr("tiny.jpg: broken JPEG")));
}

TEST(Image, OtherFormatsAndMissingFilesAreRefused) {
    const ScratchFolder folder("image");
    EXPECT_THAT([&] { read_image(folder / "no.png"); }, ThrowsMessage<InputError>(HasSubstr("cannot be read")));
    EXPECT_THAT([&] { read_image(folder.path()); }, ThrowsMessage<InputError>(HasSubstr("is a folder")));
    write_file(folder / "text.png", std::vector<std::uint8_t>{'h', 'e', 'l', 'l', 'o'});
    EXPECT_THAT([&] { read_image(folder / "text.png"); }, ThrowsMessage<InputError>(HasSubstr("neither PNG nor JPEG")));
}

TEST(FileReplacement, KeepsTheOldFileUntilCommit) {
    const ScratchFolder folder("replace");
    write_file(folder / "a", std::vector<std::uint8_t>{1, 2, 3});
    {
        FileReplacement file(folder / "a");
        file.write("new");
        EXPECT_EQ(read_file(folder / "a"), (std::vector<std::uint8_t>{1, 2, 3}));
    }
    EXPECT_EQ(read_file(folder / "a"), (std::vector<std::uint8_t>{1, 2, 3}));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.part"));
    FileReplacement file(folder / "a");
    file.write("0000");
    file.rewrite(1, std::vector<std::uint8_t>{'x'});
    file.write("1");
    file.commit();
    EXPECT_EQ(read_file(folder / "a"), (std::vector<std::uint8_t>{'0', 'x', '0', '0', '1'}));
    EXPECT_THAT([&] { FileReplacement(folder / "none/a"); }, ThrowsMessage<InputError>(HasSubstr("cannot be written")));
}

}  // namespace
}  // namespace skybake::io
