#include "io/manifest/web_pages.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace skybake::io {
namespace {

/// Clamped; a value that is no number becomes 0, where std::clamp would pass it on.
float to_unit_range(float value) {
    return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

/// sRGB encoding of linear [0, 1] in 8 bit, rounded to nearest, by the linear values where the code changes: exact, and
/// ten times as fast as a power for each texel.
class SrgbEncoder {
  public:
    SrgbEncoder() {
        for (std::size_t code = 0; code < 255; ++code)
            threshold_[code] = linear_from_srgb((static_cast<float>(code) + 0.5f) / 255.0f);
        // The first code that a coarse linear value may have: the search goes on from there.
        std::uint8_t code = 0;
        for (std::size_t i = 0; i < start_.size(); ++i) {
            while (code < 255 && threshold_[code] <= static_cast<float>(i) / kBuckets) ++code;
            start_[i] = code;
        }
    }
    std::uint8_t operator()(float linear) const {
        const float v = to_unit_range(linear);
        std::uint8_t code = start_[static_cast<std::size_t>(v * kBuckets)];
        while (code < 255 && threshold_[code] <= v) ++code;
        return code;
    }

  private:
    static constexpr float kBuckets = 1024.0f;
    std::array<float, 255> threshold_{};
    std::array<std::uint8_t, 1025> start_{};
};

std::uint8_t eight_bit(float linear) {
    return static_cast<std::uint8_t>(std::lround(255.0f * to_unit_range(linear)));
}

float inverse_or_zero(float scale) {
    return scale > 0.0f ? 1.0f / scale : 0.0f;
}

Image8 empty_picture(const LightmapPage& page, int channels) {
    return {page.width, page.height, channels,
            std::vector<std::uint8_t>(page.state.size() * static_cast<std::size_t>(channels))};
}

/// Light over the chart's scale, which `scale_klx` tells for a chart's number.
template <typename Scale>
Image8 light_picture(const LightmapPage& page, const std::vector<Rgb>& light, const Scale& scale_klx) {
    static const SrgbEncoder encode;
    Image8 image = empty_picture(page, 3);
    for (std::size_t t = 0; t < light.size(); ++t) {
        if (page.state[t] == TexelState::empty) continue;
        const float factor = 1e-3f * inverse_or_zero(scale_klx(page.chart[t].index()));
        for (int c = 0; c < 3; ++c) image.pixels[3 * t + static_cast<std::size_t>(c)] = encode(factor * light[t][c]);
    }
    return image;
}

/// Makes the scale of each chart of the page at least its largest channel, klx.
void extend_scales(const LightmapPage& page, const std::vector<Rgb>& light, std::vector<float>& scales_klx) {
    for (std::size_t t = 0; t < page.state.size(); ++t) {
        if (page.state[t] == TexelState::empty) continue;
        float& scale = scales_klx[page.chart[t].index()];
        scale = std::max(scale, 1e-3f * std::max({light[t].x, light[t].y, light[t].z}));
    }
}

}  // namespace

std::vector<ChartScale> chart_scales(const Lightmaps& light, std::size_t instant, std::size_t chart_count) {
    std::vector<ChartScale> scales(chart_count);
    for (std::size_t p = 0; p < light.pages.size(); ++p) {
        const LightmapPage& page = light.pages[p];
        const LightmapLayer& layer = light.instants[instant].pages[p];
        for (std::size_t t = 0; t < page.state.size(); ++t) {
            if (page.state[t] == TexelState::empty) continue;
            ChartScale& scale = scales[page.chart[t].index()];
            const Rgb& sky = layer.sky[t];
            scale.sky_klx = std::max(scale.sky_klx, 1e-3f * std::max({sky.x, sky.y, sky.z}));
            scale.sun_cosine = std::max(scale.sun_cosine, layer.sun_cosine[t]);
        }
    }
    return scales;
}

std::vector<float> indirect_scales_klx(const Lightmaps& light, std::size_t instant, std::size_t chart_count) {
    std::vector<float> scales(chart_count, 0.0f);
    for (std::size_t p = 0; p < light.pages.size(); ++p)
        extend_scales(light.pages[p], light.instants[instant].pages[p].indirect, scales);
    return scales;
}

std::vector<float> lamp_scales_klx(const Lightmaps& light, std::size_t chart_count) {
    std::vector<float> scales(chart_count, 0.0f);
    for (const LightmapPage& page : light.pages) extend_scales(page, page.lamps, scales);
    return scales;
}

Image8 sky_picture(const Lightmaps& light, std::size_t instant, std::size_t page,
                   const std::vector<ChartScale>& scales) {
    return light_picture(light.pages[page], light.instants[instant].pages[page].sky,
                         [&](std::size_t chart) { return scales[chart].sky_klx; });
}

Image8 indirect_picture(const Lightmaps& light, std::size_t instant, std::size_t page,
                        const std::vector<float>& scales_klx) {
    return light_picture(light.pages[page], light.instants[instant].pages[page].indirect,
                         [&](std::size_t chart) { return scales_klx[chart]; });
}

Image8 lamps_picture(const LightmapPage& page, const std::vector<float>& scales_klx) {
    return light_picture(page, page.lamps, [&](std::size_t chart) { return scales_klx[chart]; });
}

Image8 sun_picture(const Lightmaps& light, std::size_t instant, std::size_t page,
                   const std::vector<ChartScale>& scales) {
    const LightmapPage& base = light.pages[page];
    const std::vector<float>& sun = light.instants[instant].pages[page].sun_cosine;
    Image8 image = empty_picture(base, 1);
    for (std::size_t t = 0; t < sun.size(); ++t) {
        if (base.state[t] == TexelState::empty) continue;
        image.pixels[t] = eight_bit(sun[t] * inverse_or_zero(scales[base.chart[t].index()].sun_cosine));
    }
    return image;
}

Image8 sky_view_picture(const LightmapPage& page) {
    Image8 image = empty_picture(page, 1);
    for (std::size_t t = 0; t < page.state.size(); ++t) {
        image.pixels[t] = page.state[t] == TexelState::empty ? 255 : eight_bit(page.sky_view_factor[t]);
    }
    return image;
}

double exposure_hint(const Lightmaps& light, std::size_t instant) {
    double sum_lx = 0.0, lamps_sum = 0.0, lamps_squares = 0.0;
    std::uint64_t count = 0;
    for (std::size_t p = 0; p < light.pages.size(); ++p) {
        for (std::size_t t = 0; t < light.pages[p].state.size(); ++t) {
            if (light.pages[p].state[t] != TexelState::chart) continue;
            sum_lx += static_cast<double>(luminance(total_irradiance(light, instant, p, t)));
            ++count;
            if (light.pages[p].lamps.empty()) continue;
            const double lamps_lx = static_cast<double>(luminance(light.pages[p].lamps[t]));
            lamps_sum += lamps_lx;
            lamps_squares += lamps_lx * lamps_lx;
        }
    }
    if (count == 0 || !(sum_lx > 0.0)) return 1.0;
    const double mean_lx = sum_lx / static_cast<double>(count);
    const double under_lamps_lx = lamps_sum > 0.0 ? lamps_squares / lamps_sum : 0.0;
    return 0.5 / ((mean_lx + under_lamps_lx) / 1000.0 / kPi);
}

std::uint16_t half_from_float(float value) {
    if (std::isnan(value)) return 0;
    return Imath::half(std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX))).bits();
}

}  // namespace skybake::io
