// Radiance pictures (.hdr, .pic): four bytes a pixel, three mantissas and a common exponent. After the description in
// Radiance's documentation of its file formats. Read here and not by stb_image, which turns what a cut-off file lacks
// into black and leaves EXPOSURE out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "io/exr/exr.h"

namespace skybake::io {

/// RGB radiances, W m⁻² sr⁻¹, as the file means them: divided by all its EXPOSURE lines. Run-length encoded or flat,
/// rows from top to bottom. Throws InputError when the file is no such picture, is XYZE, is turned, is cut off, or has
/// more than `max_pixels`.
PictureRgb read_radiance_hdr(const std::filesystem::path& path, std::uint64_t max_pixels = 1ull << 28);

/// The same from bytes in memory; `name` is what messages call it.
PictureRgb decode_radiance_hdr(std::span<const std::uint8_t> bytes, const std::string& name,
                               std::uint64_t max_pixels = 1ull << 28);

}  // namespace skybake::io
