#include "io/image/image.h"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/image/jpeg.h"

namespace skybake::io {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

/// Frees what libpng holds, however the scope is left.
struct PngImage {
    png_image image{};
    PngImage() { image.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&image); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

// libpng's simplified interface keeps its longjmp inside the library, where no destructor of ours can be skipped.
Image8 decode_png(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
    PngImage png;
    const auto fail = [&] {
        throw InputError(fmt::format("{}: broken PNG ({}). Save the picture anew.", name, png.image.message));
    };
    if (png_image_begin_read_from_memory(&png.image, bytes.data(), bytes.size()) == 0) fail();
    check_pixel_count(name, png.image.width, png.image.height, max_pixels);
    png.image.flags |=
        PNG_IMAGE_FLAG_16BIT_sRGB;  // 16 bit without a stated gamma is sRGB here as everywhere else in the city
    const bool has_color = (png.image.format & PNG_FORMAT_FLAG_COLOR) != 0;
    const bool has_alpha = (png.image.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    png.image.format = has_alpha ? PNG_FORMAT_RGBA : has_color ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
    Image8 image;
    image.width = static_cast<int>(png.image.width);
    image.height = static_cast<int>(png.image.height);
    image.channels = has_alpha ? 4 : has_color ? 3 : 1;
    image.pixels.resize(PNG_IMAGE_SIZE(png.image));
    if (png_image_finish_read(&png.image, nullptr, image.pixels.data(), 0, nullptr) == 0) fail();
    return image;
}

}  // namespace

void check_pixel_count(const std::string& name, std::uint64_t width, std::uint64_t height, std::uint64_t max_pixels) {
    if (width == 0 || height == 0) throw InputError(fmt::format("{}: the picture has no pixels.", name));
    if (width > max_pixels / height) {
        throw InputError(fmt::format("{}: {} x {} pixels are more than the {} that are read. Scale the picture down.",
                                     name, width, height, max_pixels));
    }
}

ImageFormat image_format(std::span<const std::uint8_t> bytes) {
    if (bytes.size() >= 8 && std::memcmp(bytes.data(), kPngSignature.data(), 8) == 0) return ImageFormat::png;
    if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return ImageFormat::jpeg;
    return ImageFormat::other;
}

Image8 decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
    switch (image_format(bytes)) {
        case ImageFormat::png:
            return decode_png(bytes, name, max_pixels);
        case ImageFormat::jpeg:
            return decode_jpeg(bytes, name, max_pixels);
        case ImageFormat::other:
            break;
    }
    throw InputError(fmt::format("{}: is neither PNG nor JPEG. Convert the picture to one of them.", name));
}

std::optional<ImageSize> image_size(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::array<std::uint8_t, 24> head{};
    const auto read = [&](std::size_t count) {
        in.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(count));
        return in.gcount() == static_cast<std::streamsize>(count);
    };
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | head[at + i];
        return static_cast<int>(value & 0x7fffffffu);
    };
    if (!read(24)) return std::nullopt;
    const ImageFormat format = image_format(head);
    if (format == ImageFormat::png) return ImageSize{number(16, 4), number(20, 4)};
    if (format != ImageFormat::jpeg) return std::nullopt;
    in.seekg(2);
    while (read(4) && head[0] == 0xff) {  // marker, length
        const int marker = head[1];
        const int length = number(2, 2);
        const bool is_frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;  // SOF0 to SOF15
        if (is_frame) return read(5) ? std::optional(ImageSize{number(3, 2), number(1, 2)}) : std::nullopt;
        if (length < 2) return std::nullopt;
        in.seekg(length - 2, std::ios::cur);
    }
    return std::nullopt;
}

Image8 read_image(const std::filesystem::path& path, std::uint64_t max_pixels) {
    return decode_image(read_file(path), path.string(), max_pixels);
}

Image8 read_image(const Texture& texture, std::uint64_t max_pixels) {
    if (texture.embedded) return decode_image(*texture.embedded, texture.uri, max_pixels);
    return read_image(std::filesystem::path(texture.path), max_pixels);
}

void write_png(const std::filesystem::path& path, const Image8& image) {
    write_file(path, encode_png(image));
}

}  // namespace skybake::io
