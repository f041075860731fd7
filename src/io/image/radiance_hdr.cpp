#include "io/image/radiance_hdr.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/image/jpeg.h"

namespace skybake::io {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class Decoder {
  public:
    Decoder(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    PictureRgb decode(std::uint64_t max_pixels) {
        const std::string_view first = line();
        if (first != "#?RADIANCE" && first != "#?RGBE") fail("it does not begin with #?RADIANCE");
        double exposure = 1.0;
        for (std::string_view text = line(); !text.empty(); text = line()) {
            if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe")
                fail(fmt::format("its {} is not 32-bit_rle_rgbe", text));
            if (text.starts_with("EXPOSURE=")) exposure *= number(text.substr(9));
        }
        PictureRgb picture;
        const std::string size(line());
        if (std::sscanf(size.c_str(), "-Y %d +X %d", &picture.height, &picture.width) != 2 || picture.width <= 0 ||
            picture.height <= 0)
            fail(fmt::format("its size '{}' is not '-Y HEIGHT +X WIDTH'", size.substr(0, 40)));
        check_pixel_count(name_, static_cast<std::uint64_t>(picture.width), static_cast<std::uint64_t>(picture.height),
                          max_pixels);
        picture.pixels.reserve(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
        std::vector<Rgbe> row(static_cast<std::size_t>(picture.width));
        for (row_ = 0; row_ < picture.height; ++row_) {
            read_row(row);
            for (const Rgbe& pixel : row) {
                // The mantissa stands for the middle of its step.
                const double unit = pixel[3] == 0 ? 0.0 : std::ldexp(1.0 / exposure, pixel[3] - (128 + 8));
                picture.pixels.emplace_back(static_cast<float>((pixel[0] + 0.5) * unit),
                                            static_cast<float>((pixel[1] + 0.5) * unit),
                                            static_cast<float>((pixel[2] + 0.5) * unit));
            }
        }
        return picture;
    }

  private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(
            fmt::format("{}: broken Radiance picture, or none: {}. Save the picture anew.", name_, reason));
    }

    std::string_view line() {
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
        if (at_ == bytes_.size()) fail("its header does not end");
        std::string_view text(reinterpret_cast<const char*>(bytes_.data()) + begin, at_ - begin);
        ++at_;
        if (text.ends_with('\r')) text.remove_suffix(1);
        return text;
    }

    double number(std::string_view text) const {
        while (text.starts_with(' ')) text.remove_prefix(1);
        double value = 0.0;
        const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
        if (result.ec != std::errc{} || !(value > 0.0) || !std::isfinite(value))
            fail(fmt::format("its EXPOSURE '{}' is not a positive number", text.substr(0, 40)));
        return value;
    }

    std::uint8_t byte() {
        if (at_ == bytes_.size()) fail(fmt::format("it ends in row {}", row_));
        return bytes_[at_++];
    }

    void read_row(std::vector<Rgbe>& row) {
        const Rgbe first = {byte(), byte(), byte(), byte()};
        const std::size_t width = row.size();
        const bool is_encoded = width >= 8 && width < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!is_encoded) return read_old_row(first, row);
        if (static_cast<std::size_t>(first[2] * 256 + first[3]) != width)
            fail(fmt::format("row {} says it is {} pixels wide", row_, first[2] * 256 + first[3]));
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (std::size_t i = 0; i < width;) {
                const std::size_t code = byte();
                const std::size_t count = code > 128 ? code - 128 : code;
                if (count == 0 || count > width - i) fail(fmt::format("row {} runs over its end", row_));
                const std::uint8_t repeated = code > 128 ? byte() : std::uint8_t{0};
                for (std::size_t k = 0; k < count; ++k) row[i++][channel] = code > 128 ? repeated : byte();
            }
        }
    }

    /// Flat, or the older encoding: (1, 1, 1, n) repeats the pixel before n times, further such ones 256 n times.
    void read_old_row(Rgbe pixel, std::vector<Rgbe>& row) {
        std::size_t shift = 0;
        for (std::size_t i = 0;;) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
                if (i == 0 || count > row.size() - i) fail(fmt::format("row {} runs over its end", row_));
                for (std::size_t k = 0; k < count; ++k, ++i) row[i] = row[i - 1];
                shift = std::min<std::size_t>(shift + 8, 24);
            } else {
                row[i++] = pixel;
                shift = 0;
            }
            if (i == row.size()) return;
            pixel = {byte(), byte(), byte(), byte()};
        }
    }

    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
    int row_ = 0;
};

}  // namespace

PictureRgb decode_radiance_hdr(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
    return Decoder(bytes, name).decode(max_pixels);
}

PictureRgb read_radiance_hdr(const std::filesystem::path& path, std::uint64_t max_pixels) {
    return decode_radiance_hdr(read_file(path), path.string(), max_pixels);
}

}  // namespace skybake::io
