#include "io/study/stepped_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/false_colour.h"

namespace skybake::io {
namespace {

Rgb8 eight_bit(const Rgb& linear) {
    Rgb8 colour{};
    for (int k = 0; k < 3; ++k)
        colour[k] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(srgb_from_linear(linear[k]), 0.0f, 1.0f)));
    return colour;
}

Rgb8 mixed(const Rgb8& a, const Rgb8& b, double share) {
    Rgb8 colour{};
    for (int k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(std::lround(a[k] + share * (b[k] - a[k])));
    return colour;
}

}  // namespace

double round_step(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
        if (factor * power >= least * (1.0 - 1e-9)) return factor * power;
    }
    return 10.0 * power;
}

std::string hex_of(const Rgb8& colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::size_t SteppedScale::class_of(double value) const {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
    return static_cast<std::size_t>(above - edges.begin() - 1);
}

SteppedScale stepped_scale(double least, double greatest, const std::vector<double>& thresholds) {
    if (!(greatest > least)) greatest = least + std::max(1e-3, 0.1 * std::abs(least));
    const double step = round_step((greatest - least) / 9.0);
    SteppedScale scale;
    const auto marked = [&](double edge) {
        return std::any_of(thresholds.begin(), thresholds.end(),
                           [&](double t) { return std::abs(t - edge) < 1e-9 * std::max(1.0, std::abs(t)); });
    };
    const double first = std::floor(least / step + 1e-9) * step, last = std::ceil(greatest / step - 1e-9) * step;
    for (int k = 0; first + k * step <= last + 0.5 * step; ++k) {
        const double edge = first + k * step;
        const bool makes_way = std::any_of(thresholds.begin(), thresholds.end(), [&](double t) {
            return t > first && t < last && std::abs(t - edge) < 0.4 * step;
        });
        if (k == 0 || edge >= last - 0.5 * step || !makes_way) scale.edges.push_back(edge);
    }
    for (const double t : thresholds) {
        if (t > first && t < last && !std::any_of(scale.edges.begin(), scale.edges.end(), [&](double e) {
                return std::abs(e - t) < 1e-9 * std::max(1.0, std::abs(t));
            }))
            scale.edges.push_back(t);
    }
    std::sort(scale.edges.begin(), scale.edges.end());
    const std::size_t classes = scale.edges.size() - 1;
    for (std::size_t c = 0; c < classes; ++c) {
        const double share = classes > 1 ? static_cast<double>(c) / static_cast<double>(classes - 1) : 0.5;
        scale.colours.push_back(eight_bit(colour_of({0.0, 1.0, false}, share)));
    }
    for (const double edge : scale.edges) scale.is_marked.push_back(marked(edge));
    return scale;
}

SteppedScale difference_scale(double most, double least_change) {
    constexpr Rgb8 kLoss{127, 59, 8}, kNone{247, 247, 247}, kGain{5, 48, 97};
    most = std::max(most, 2.0 * least_change);
    const double step = round_step(most / 5.0);
    const int steps = std::max(1, static_cast<int>(std::ceil(most / step - 1e-9)));
    SteppedScale scale;
    for (int k = -steps; k <= steps; ++k) {
        if (k == 0) {
            scale.edges.push_back(-least_change);
            scale.edges.push_back(least_change);
        } else {
            scale.edges.push_back(k * step);
        }
    }
    for (int k = 0; k < steps; ++k) scale.colours.push_back(mixed(kLoss, kNone, 0.9 * k / steps));
    scale.colours.push_back(kNone);
    for (int k = 1; k <= steps; ++k) scale.colours.push_back(mixed(kNone, kGain, 0.1 + 0.9 * k / steps));
    scale.is_marked.assign(scale.edges.size(), 0);
    return scale;
}

}  // namespace skybake::io
