#include "render/light_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace skybake {

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

Rgb LightPage::at(const Vec2f& place, float footprint) const {
    const float level = std::clamp(std::log2(std::max(footprint, 1e-4f)), 0.0f, 1.0f);
    if (level == 0.0f) return fine_.at(place);
    return (1.0f - level) * fine_.at(place) + level * coarse_.at(0.5f * place);
}

}  // namespace skybake
