#include "render/false_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"

namespace skybake {
namespace {

/// Nine even steps of the map, as sRGB codes; between them colours are mixed as codes.
constexpr std::array<std::array<int, 3>, 9> kViridis = {{{68, 1, 84},
                                                         {71, 45, 123},
                                                         {59, 82, 139},
                                                         {44, 114, 142},
                                                         {33, 145, 140},
                                                         {40, 174, 128},
                                                         {94, 201, 98},
                                                         {173, 220, 48},
                                                         {253, 231, 37}}};
/// Where no surface is: light grey, which the map does not hold.
const Rgb kPaper(0.8f);

double place_of(const FalseColour& scale, double value) {
    if (!scale.is_logarithmic) return (value - scale.low) / (scale.high - scale.low);
    return value > 0.0 ? std::log(value / scale.low) / std::log(scale.high / scale.low) : 0.0;
}

/// The step of 1, 2 or 5 times a power of ten that cuts `range` into about five.
double round_step(double range) {
    const double rough = range / 5.0;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double lead = rough / power;
    return (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0) * power;
}

/// With thin spaces between thousands, which no country misreads.
std::string number_text(double value) {
    const std::string plain = fmt::format("{:g}", std::abs(value) < 1e6 ? std::round(value * 1e6) / 1e6 : value);
    const std::size_t whole = plain.find_first_not_of("0123456789");
    const std::size_t digits = whole == std::string::npos ? plain.size() : whole;
    std::string text;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        if (i > 0 && i < digits && digits > 4 && (digits - i) % 3 == 0) text += "\u2009";
        text += plain[i];
    }
    return text;
}

}  // namespace

Rgb colour_of(const FalseColour& scale, double value) {
    const double place = std::clamp(place_of(scale, value), 0.0, 1.0) * (kViridis.size() - 1);
    const std::size_t step = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
    const double between = place - static_cast<double>(step);
    Rgb colour(0.0f);
    for (std::size_t c = 0; c < 3; ++c) {
        const double code = (1.0 - between) * kViridis[step][c] + between * kViridis[step + 1][c];
        colour[static_cast<int>(c)] = linear_from_srgb(static_cast<float>(code / 255.0));
    }
    return colour;
}

std::vector<ScaleTick> ticks_of(const FalseColour& scale) {
    SKYBAKE_CHECK_LT(scale.low, scale.high);
    std::vector<ScaleTick> ticks;
    const auto add = [&](double value) { ticks.push_back({value, place_of(scale, value), number_text(value)}); };
    if (!scale.is_logarithmic) {
        const double step = round_step(scale.high - scale.low);
        for (double i = std::ceil(scale.low / step - 1e-9) + 0.0; i * step <= scale.high + 1e-9 * step; ++i)
            add(i * step);
        return ticks;
    }
    const double decades = std::log10(scale.high / scale.low);
    for (double power = std::floor(std::log10(scale.low)); power <= std::log10(scale.high); ++power) {
        for (const double lead : {1.0, 2.0, 5.0}) {
            if (lead != 1.0 && decades > 2.5) continue;
            const double value = lead * std::pow(10.0, power);
            if (value >= scale.low * (1.0 - 1e-9) && value <= scale.high * (1.0 + 1e-9)) add(value);
        }
    }
    return ticks;
}

FalseColour range_of(const Picture& measure) {
    std::vector<float> values;
    for (std::size_t i = 0; i < measure.pixels.size(); ++i)
        if (measure.coverage[i] > 0.0f) values.push_back(luminance(measure.pixels[i]));
    FalseColour scale;
    if (values.empty()) return scale;
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), rank, values.end());
    if (!(*rank > 0.0f)) return scale;
    const double step = round_step(*rank);
    scale.high = step * std::ceil(*rank / step);
    return scale;
}

Picture in_false_colours(const Picture& measure, const FalseColour& scale) {
    Picture picture = measure;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const float share = measure.coverage[i];
        const Rgb colour = share > 0.0f ? colour_of(scale, luminance(measure.pixels[i])) : kPaper;
        picture.pixels[i] = share * colour + (1.0f - share) * kPaper;
    }
    return picture;
}

}  // namespace skybake
