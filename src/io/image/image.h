// Eight-bit pictures: PNG in and out, JPEG in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace skybake::io {

/// Interleaved channels (1 grey, 3 RGB, 4 RGBA), row 0 on top.
struct Image8 {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<std::uint8_t> pixels;  // width × height × channels
};

/// Writes beside and renames, so that no half file ever stands under the name. Throws InputError when the place cannot be written.
void write_png(const std::filesystem::path& path, const Image8& image);

/// The same bytes in memory.
std::vector<std::uint8_t> encode_png(const Image8& image);

/// Reads a PNG or a JPEG, told apart by content, as 8 bit. Throws InputError for anything else, and above `max_pixels`.
Image8 read_image(const std::filesystem::path& path, std::uint64_t max_pixels = 1ull << 28);

}  // namespace skybake::io
