#include "scene/albedo_image.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace skybake {

namespace {

const std::array<float, 256>& linear_of_code() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t code = 0; code < 256; ++code)
            values[code] = linear_from_srgb(static_cast<float>(code) / 255.0f);
        return values;
    }();
    return table;
}

/// The pixel that stands at place `i` of a row or column of `size`; none on the border.
std::optional<int> wrapped(std::int64_t i, int size, TextureWrap wrap) {
    if (i >= 0 && i < size) return static_cast<int>(i);
    switch (wrap) {
        case TextureWrap::repeat:
            return static_cast<int>(((i % size) + size) % size);
        case TextureWrap::mirror: {
            const std::int64_t period = 2 * static_cast<std::int64_t>(size);
            const std::int64_t there = ((i % period) + period) % period;
            return static_cast<int>(there < size ? there : period - 1 - there);
        }
        case TextureWrap::border:
            return std::nullopt;
        case TextureWrap::none:
        case TextureWrap::clamp:
            break;
    }
    return i < 0 ? 0 : size - 1;
}

}  // namespace

Rgb albedo_at(const AlbedoImage& image, const Vec2f& uv, TextureWrap wrap, const Rgb& border) {
    if (image.is_empty()) return Rgb(kAlbedoWithoutTexture);
    // Beyond a million repetitions float coordinates have lost the pixel anyway.
    const auto tame = [](float value) { return std::isfinite(value) && std::abs(value) < 1e6f ? value : 0.0f; };
    const double x = static_cast<double>(tame(uv.x)) * image.width - 0.5;
    const double y = (1.0 - static_cast<double>(tame(uv.y))) * image.height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const std::array<float, 256>& linear = linear_of_code();
    Rgb albedo(0.0f);
    for (int k = 0; k < 4; ++k) {
        const std::optional<int> column = wrapped(static_cast<std::int64_t>(x0) + (k & 1), image.width, wrap);
        const std::optional<int> row = wrapped(static_cast<std::int64_t>(y0) + (k >> 1), image.height, wrap);
        Rgb value = border;
        if (column && row) {
            const auto& p = image.pixels[static_cast<std::size_t>(*row) * static_cast<std::size_t>(image.width) +
                                         static_cast<std::size_t>(*column)];
            value = {linear[p[0]], linear[p[1]], linear[p[2]]};
        }
        albedo += (k & 1 ? fx : 1.0f - fx) * (k >> 1 ? fy : 1.0f - fy) * value;
    }
    return albedo;
}

}  // namespace skybake
