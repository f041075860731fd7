// The JPEG decoder behind read_image.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/image/image.h"

namespace skybake::io {

/// Grey or RGB, 8 bit; CMYK and YCCK (with Adobe's inverted inks) become RGB. Throws InputError when broken or cut off.
Image8 decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

/// Throws InputError for an empty picture, or one with more than `max_pixels`.
void check_pixel_count(const std::string& name, std::uint64_t width, std::uint64_t height, std::uint64_t max_pixels);

}  // namespace skybake::io
