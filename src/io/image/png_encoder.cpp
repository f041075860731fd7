// PNG by libdeflate: on lightmap pages three times as fast as libpng with zlib, and as small (docs/formats.md).
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <string_view>

#include "base/check.h"
#include "io/image/image.h"

namespace skybake::io {
namespace {

// Between speed and size: measured on lightmap pages (docs/formats.md).
constexpr int kDeflateLevel = 6;

void append_big_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(std::vector<std::uint8_t>& png, std::string_view type, std::span<const std::uint8_t> data) {
    append_big_endian(png, static_cast<std::uint32_t>(data.size()));
    const std::size_t checked_from = png.size();
    png.insert(png.end(), type.begin(), type.end());
    png.insert(png.end(), data.begin(), data.end());
    append_big_endian(png, libdeflate_crc32(0, png.data() + checked_from, png.size() - checked_from));
}

std::uint8_t paeth(int left, int up, int corner) {
    const int p = left + up - corner;
    const int dl = std::abs(p - left);
    const int du = std::abs(p - up);
    const int dc = std::abs(p - corner);
    return static_cast<std::uint8_t>(dl <= du && dl <= dc ? left : du <= dc ? up : corner);
}

/// The row less what the filter predicts, behind the filter's number (PNG specification, section 9).
void filter_row(int filter, const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t step,
                std::uint8_t* out) {
    out[0] = static_cast<std::uint8_t>(filter);
    ++out;
    const auto subtract = [&](auto predict) {
        for (std::size_t i = 0; i < step; ++i) out[i] = static_cast<std::uint8_t>(row[i] - predict(0, above[i], 0));
        for (std::size_t i = step; i < size; ++i) {
            out[i] = static_cast<std::uint8_t>(row[i] - predict(row[i - step], above[i], above[i - step]));
        }
    };
    switch (filter) {
        case 0:
            subtract([](int, int, int) { return 0; });
            break;
        case 1:
            subtract([](int left, int, int) { return left; });
            break;
        case 2:
            subtract([](int, int up, int) { return up; });
            break;
        default:
            subtract([](int left, int up, int corner) { return paeth(left, up, corner); });
            break;
    }
}

/// How well a filtered row will compress: the sum of its bytes' distances from zero.
std::uint64_t filtered_cost(const std::uint8_t* filtered, std::size_t size) {
    std::uint64_t cost = 0;
    for (std::size_t i = 1; i <= size; ++i)
        cost += static_cast<std::uint64_t>(std::abs(static_cast<std::int8_t>(filtered[i])));
    return cost;
}

std::vector<std::uint8_t> filtered_rows(const Image8& image) {
    const std::size_t step = static_cast<std::size_t>(image.channels);
    const std::size_t size = static_cast<std::size_t>(image.width) * step;
    const std::size_t height = static_cast<std::size_t>(image.height);
    std::vector<std::uint8_t> rows(height * (size + 1));
    std::vector<std::uint8_t> candidate(size + 1);
    const std::vector<std::uint8_t> zeros(size);
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t* row = image.pixels.data() + y * size;
        const std::uint8_t* above = y > 0 ? row - size : zeros.data();
        std::uint8_t* best = rows.data() + y * (size + 1);
        filter_row(0, row, above, size, step, best);
        std::uint64_t best_cost = filtered_cost(best, size);
        for (const int filter : {1, 2, 4}) {
            if (best_cost == 0) break;
            filter_row(filter, row, above, size, step, candidate.data());
            const std::uint64_t cost = filtered_cost(candidate.data(), size);
            if (cost < best_cost) {
                best_cost = cost;
                std::copy(candidate.begin(), candidate.end(), best);
            }
        }
    }
    return rows;
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kDeflateLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::vector<std::uint8_t> out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
    out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
    SKYBAKE_CHECK(!out.empty());
    return out;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image8& image) {
    SKYBAKE_CHECK(image.width > 0 && image.height > 0);
    SKYBAKE_CHECK(image.channels == 1 || image.channels == 3 || image.channels == 4);
    SKYBAKE_CHECK_EQ(image.pixels.size(), static_cast<std::size_t>(image.width) *
                                              static_cast<std::size_t>(image.height) *
                                              static_cast<std::size_t>(image.channels));
    std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    std::vector<std::uint8_t> header;
    append_big_endian(header, static_cast<std::uint32_t>(image.width));
    append_big_endian(header, static_cast<std::uint32_t>(image.height));
    const std::uint8_t color_type = image.channels == 1 ? 0 : image.channels == 3 ? 2 : 6;
    header.insert(header.end(),
                  {8, color_type, 0, 0, 0});  // bit depth, colour type, deflate, adaptive filters, not interlaced
    append_chunk(png, "IHDR", header);
    const std::vector<std::uint8_t> data = deflated(filtered_rows(image));
    // A chunk's length must stay below 2^31.
    constexpr std::size_t kLongestChunk = std::size_t{1} << 30;
    for (std::size_t begin = 0; begin < data.size(); begin += kLongestChunk) {
        append_chunk(png, "IDAT", std::span(data).subspan(begin, std::min(kLongestChunk, data.size() - begin)));
    }
    append_chunk(png, "IEND", {});
    return png;
}

}  // namespace skybake::io
