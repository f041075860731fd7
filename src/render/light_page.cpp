#include "render/light_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace skybake {
namespace {

/// Shares of the four texels about a place that is `t` (0…1) beyond the second.
std::array<float, 4> cubic_weights(float t) {
    const float s = 1.0f - t;
    return {s * s * s / 6.0f, 2.0f / 3.0f - 0.5f * t * t * (2.0f - t), 2.0f / 3.0f - 0.5f * s * s * (2.0f - s),
            t * t * t / 6.0f};
}

}  // namespace

LightPage::LightPage(int width, int height, std::vector<Rgb> texels) : fine_{width, height, std::move(texels)} {
    SKYBAKE_CHECK_EQ(fine_.texels.size(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    SKYBAKE_CHECK_LT(0u, fine_.texels.size());
    coarse_ = {std::max(1, width / 2), std::max(1, height / 2), {}};
    coarse_.texels.reserve(static_cast<std::size_t>(coarse_.width) * static_cast<std::size_t>(coarse_.height));
    for (int y = 0; y < coarse_.height; ++y) {
        for (int x = 0; x < coarse_.width; ++x) {
            Rgb sum(0.0f);
            for (int k = 0; k < 4; ++k) {
                const int column = std::min(2 * x + k % 2, width - 1);
                const int row = std::min(2 * y + k / 2, height - 1);
                sum += fine_.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(column)];
            }
            coarse_.texels.push_back(0.25f * sum);
        }
    }
}

Rgb LightPage::Level::at(const Vec2f& place) const {
    const float x = std::clamp(place.x - 0.5f, 0.0f, static_cast<float>(width - 1));
    const float y = std::clamp(place.y - 0.5f, 0.0f, static_cast<float>(height - 1));
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    const float across = x - static_cast<float>(left);
    const float down = y - static_cast<float>(top);
    const auto texel = [&](int column, int row) -> const Rgb& {
        return texels[static_cast<std::size_t>(std::min(row, height - 1)) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(std::min(column, width - 1))];
    };
    const Rgb upper = (1.0f - across) * texel(left, top) + across * texel(left + 1, top);
    const Rgb lower = (1.0f - across) * texel(left, top + 1) + across * texel(left + 1, top + 1);
    return (1.0f - down) * upper + down * lower;
}

Rgb LightPage::Level::cubic(const Vec2f& place) const {
    // Beyond the border stands the border.
    const float x = std::clamp(place.x - 0.5f, -3.0f, static_cast<float>(width) + 2.0f);
    const float y = std::clamp(place.y - 0.5f, -3.0f, static_cast<float>(height) + 2.0f);
    const std::array<float, 4> across = cubic_weights(x - std::floor(x));
    const std::array<float, 4> down = cubic_weights(y - std::floor(y));
    const int left = static_cast<int>(std::floor(x)) - 1;
    const int top = static_cast<int>(std::floor(y)) - 1;
    Rgb sum(0.0f);
    for (int j = 0; j < 4; ++j) {
        const std::size_t row =
            static_cast<std::size_t>(std::clamp(top + j, 0, height - 1)) * static_cast<std::size_t>(width);
        Rgb line(0.0f);
        for (int i = 0; i < 4; ++i) {
            line += across[static_cast<std::size_t>(i)] *
                    texels[row + static_cast<std::size_t>(std::clamp(left + i, 0, width - 1))];
        }
        sum += down[static_cast<std::size_t>(j)] * line;
    }
    return sum;
}

Rgb LightPage::at(const Vec2f& place, float footprint) const {
    const float level = std::clamp(std::log2(std::max(footprint, 1e-4f)), 0.0f, 1.0f);
    if (level == 1.0f) return coarse_.at(0.5f * place);
    const Rgb fine = fine_.cubic(place);
    return level == 0.0f ? fine : (1.0f - level) * fine + level * coarse_.at(0.5f * place);
}

}  // namespace skybake
