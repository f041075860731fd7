// Eight-bit pictures: PNG in and out, JPEG in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "city/city_model.h"

namespace skybake::io {

/// Interleaved channels (1 grey, 3 RGB, 4 RGBA), row 0 on top.
struct Image8 {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<std::uint8_t> pixels;  // width × height × channels
};

/// Writes beside and renames, so that no half file ever stands under the name. Throws InputError when the place cannot
/// be written.
void write_png(const std::filesystem::path& path, const Image8& image);

/// The same bytes in memory. Lossless; the same bytes for the same image, everywhere.
std::vector<std::uint8_t> encode_png(const Image8& image);

/// Reads a PNG or a JPEG, told apart by content, as 8 bit: grey stays one channel, palettes become RGB, grey with alpha
/// becomes RGBA, 16 bit is rounded, CMYK becomes RGB. The values are sRGB-encoded as in the file; a PNG that states
/// another gamma is converted. Throws InputError for anything else, for files that end early, and above `max_pixels`.
Image8 read_image(const std::filesystem::path& path, std::uint64_t max_pixels = 1ull << 28);

/// The same for the picture of a texture, be it a file or embedded in the city's own.
Image8 read_image(const Texture& texture, std::uint64_t max_pixels = 1ull << 28);

/// The same from bytes in memory; `name` is what messages call it.
Image8 decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                    std::uint64_t max_pixels = 1ull << 28);

enum class ImageFormat : std::uint8_t { png, jpeg, other };
/// By the first bytes of the file.
ImageFormat image_format(std::span<const std::uint8_t> bytes);

struct ImageSize {
    int width = 0;
    int height = 0;
};
/// What the head of a PNG or JPEG file states, without decoding it; none for other files.
std::optional<ImageSize> image_size(const std::filesystem::path& path);

}  // namespace skybake::io
