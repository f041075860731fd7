#include "render/mip_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace skybake {
namespace {

AlbedoImage halved(const AlbedoImage& image) {
    AlbedoImage half{std::max(1, image.width / 2), std::max(1, image.height / 2), {}};
    half.pixels.reserve(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height));
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x) {
            Rgb sum(0.0f);
            for (int k = 0; k < 4; ++k) {
                const int column = std::min(2 * x + k % 2, image.width - 1);
                const int row = std::min(2 * y + k / 2, image.height - 1);
                const auto& pixel = image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                                 static_cast<std::size_t>(column)];
                for (int c = 0; c < 3; ++c)
                    sum[c] += linear_from_srgb(static_cast<float>(pixel[static_cast<std::size_t>(c)]) / 255.0f);
            }
            std::array<std::uint8_t, 3> mean{};
            for (int c = 0; c < 3; ++c)
                mean[static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(0.25f * sum[c])));
            half.pixels.push_back(mean);
        }
    }
    return half;
}

}  // namespace

MipTexture::MipTexture(AlbedoImage image) {
    SKYBAKE_CHECK_LT(0u, image.pixels.size());
    levels_.push_back(std::move(image));
    while (levels_.back().pixels.size() > 1) levels_.push_back(halved(levels_.back()));
}

Rgb MipTexture::at(const Vec2f& uv, const Vec2f& footprint, TextureWrap wrap) const {
    const AlbedoImage& finest = levels_.front();
    const float pixels =
        std::max(footprint.x * static_cast<float>(finest.width), footprint.y * static_cast<float>(finest.height));
    const float coarsest = static_cast<float>(levels_.size() - 1);
    const float level = pixels > 1.0f ? std::min(std::log2(pixels), coarsest) : 0.0f;
    const std::size_t fine = static_cast<std::size_t>(level);
    const float between = level - static_cast<float>(fine);
    const Rgb value = albedo_at(levels_[fine], uv, wrap, Rgb(0.0f));
    if (between == 0.0f) return value;
    return (1.0f - between) * value + between * albedo_at(levels_[fine + 1], uv, wrap, Rgb(0.0f));
}

}  // namespace skybake
