// Compiled once for each instruction set, like shadow_projection.cpp.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/sky_accumulator.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/sky_accumulator.h"
#include "bake/sky_tile.h"

HWY_BEFORE_NAMESPACE();
namespace skybake {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// hidden[row] = covered[row] without visible[row]. Returns how many bits are visible, and hidden.
std::pair<int, int> Split(std::span<const std::uint64_t> covered, std::span<const std::uint64_t> visible,
                          std::uint64_t* hidden) {
    int visible_count = 0, hidden_count = 0;
    for (std::size_t row = 0; row < visible.size(); ++row) {
        hidden[row] = covered[row] & ~visible[row];
        visible_count += __builtin_popcountll(visible[row]);
        hidden_count += __builtin_popcountll(hidden[row]);
    }
    return {visible_count, hidden_count};
}

/// sum[k][i] += weight[k] × cosine(i) for the set bits i of the rows, where cosine(i) = max(0, n · d); without normals
/// it is 1.
void AddWhereSet(std::span<const std::uint64_t> rows, std::size_t stride, std::span<float* const> sum,
                 const float* weight, const float* const* normal, const Vec3f& d) {
    const hn::CappedTag<float, 16> tag;
    const std::size_t step = hn::Lanes(tag);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (std::size_t column = 0; column < stride; column += step) {
            const std::uint64_t bits = rows[row] >> column & ((1ull << step) - 1);
            if (!bits) continue;
            std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
            const auto mask = hn::LoadMaskBits(tag, bytes);
            const std::size_t at = row * stride + column;
            auto cosine = hn::IfThenElseZero(mask, hn::Set(tag, 1.0f));
            if (normal) {
                const auto n_d = hn::Add(hn::Add(hn::Mul(hn::LoadU(tag, normal[0] + at), hn::Set(tag, d.x)),
                                                 hn::Mul(hn::LoadU(tag, normal[1] + at), hn::Set(tag, d.y))),
                                         hn::Mul(hn::LoadU(tag, normal[2] + at), hn::Set(tag, d.z)));
                cosine = hn::IfThenElseZero(mask, hn::Max(n_d, hn::Zero(tag)));
            }
            for (std::size_t k = 0; k < sum.size(); ++k) {
                const auto added = hn::Mul(hn::Set(tag, weight[k]), cosine);
                hn::StoreU(hn::Add(hn::LoadU(tag, sum[k] + at), added), tag, sum[k] + at);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace skybake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skybake {

namespace {

HWY_EXPORT(Split);
HWY_EXPORT(AddWhereSet);

constexpr int kVector = 16;

}  // namespace

SkyAccumulator::SkyAccumulator(const TilePoints& points, const DomeSamples& dome)
    : points_(points),
      dome_(dome),
      stride_(static_cast<std::size_t>((points.width + kVector - 1) / kVector * kVector)),
      sums_(channels(), std::vector<float>(stride_ * static_cast<std::size_t>(points.height), 0.0f)),
      common_(channels(), Vec3d(0.0)) {
    if (points.normal.empty()) return;
    for (std::vector<float>* array : {&nx_, &ny_, &nz_}) array->assign(sums_[0].size(), 0.0f);
    for (int row = 0; row < points.height; ++row) {
        for (int column = 0; column < points.width; ++column) {
            const Vec3f& n = points.normal[static_cast<std::size_t>(points.texel(column, row))];
            const std::size_t at = static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
            nx_[at] = n.x;
            ny_[at] = n.y;
            nz_[at] = n.z;
            axis_ += n;
        }
    }
    axis_ = glm::normalize(axis_);
    float min_cosine = 1.0f;
    for (const Vec3f& n : points.normal) min_cosine = std::min(min_cosine, glm::dot(n, axis_));
    horizon_sine_ = std::sqrt(std::max(0.0f, 1.0f - min_cosine * min_cosine));
}

float SkyAccumulator::weight(std::size_t channel, std::size_t direction) const {
    return channel + 1 == channels() ? dome_.view_factor_weight[direction]
                                     : dome_.weights[channel / 3][direction][static_cast<int>(channel % 3)];
}

void SkyAccumulator::add(std::size_t direction, std::span<const std::uint64_t> visible) {
    std::array<std::uint64_t, TilePoints::kMaxSize> hidden;
    const auto [visible_count, hidden_count] = HWY_DYNAMIC_DISPATCH(Split)(points_.covered, visible, hidden.data());
    if (visible_count == 0) return;
    const Vec3f& d = dome_.directions[direction];
    const bool is_relief = !nx_.empty();
    // A direction below some texel's own horizon adds nothing there, which one vector for all cannot say.
    const bool is_common = visible_count >= hidden_count && (!is_relief || glm::dot(d, axis_) > horizon_sine_);
    if (is_common) {
        const Vec3d v = is_relief ? Vec3d(d) : Vec3d(1.0, 0.0, 0.0);
        for (std::size_t k = 0; k < channels(); ++k) common_[k] += static_cast<double>(weight(k, direction)) * v;
        if (hidden_count == 0) return;
    }
    sum_of_.clear();
    weight_of_.clear();
    for (std::size_t k = 0; k < channels(); ++k) {
        const float w = weight(k, direction);
        if (w == 0.0f) continue;
        sum_of_.push_back(sums_[k].data());
        weight_of_.push_back(is_common ? -w : w);
    }
    const float* const normal[3] = {nx_.data(), ny_.data(), nz_.data()};
    HWY_DYNAMIC_DISPATCH(AddWhereSet)
    (is_common ? std::span<const std::uint64_t>(hidden).first(visible.size()) : visible, stride_, sum_of_,
     weight_of_.data(), is_relief ? normal : nullptr, d);
}

void SkyAccumulator::dim(std::size_t direction, std::size_t texel, float loss) {
    const std::size_t width = static_cast<std::size_t>(points_.width);
    const std::size_t at = texel / width * stride_ + texel % width;
    const float cosine =
        nx_.empty() ? 1.0f : std::max(0.0f, glm::dot(points_.normal[texel], dome_.directions[direction]));
    for (std::size_t k = 0; k < channels(); ++k) sums_[k][at] -= weight(k, direction) * cosine * loss;
}

TileLight SkyAccumulator::light() && {
    TileLight light;
    const std::size_t count = static_cast<std::size_t>(points_.width) * static_cast<std::size_t>(points_.height);
    light.sky.assign(dome_.weights.size(), std::vector<Rgb>(count));
    light.sky_view_factor.resize(count);
    for (int row = 0; row < points_.height; ++row) {
        for (int column = 0; column < points_.width; ++column) {
            const std::size_t at = static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
            const std::size_t texel = static_cast<std::size_t>(points_.texel(column, row));
            const Vec3d n = nx_.empty() ? Vec3d(1.0, 0.0, 0.0) : Vec3d(nx_[at], ny_[at], nz_[at]);
            const auto total = [&](std::size_t channel) {
                // Not below 0: what was added for all and taken away again may leave a rounding error.
                return std::max(
                    0.0f, static_cast<float>(static_cast<double>(sums_[channel][at]) + glm::dot(n, common_[channel])));
            };
            for (std::size_t k = 0; k < light.sky.size(); ++k) {
                for (int c = 0; c < 3; ++c) light.sky[k][texel][c] = total(3 * k + static_cast<std::size_t>(c));
            }
            light.sky_view_factor[texel] = total(channels() - 1);
        }
    }
    return light;
}

}  // namespace skybake
#endif
