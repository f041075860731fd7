#include "bake/indirect_report.h"

#include <cmath>

namespace skybake {

namespace {

/// Calls body(instant, page, texel) for each texel of a chart where somebody could stand, in the order of the files.
template <typename Body>
void for_texels(const Lightmaps& lightmaps, const Body& body) {
    for (std::size_t i = 0; i < lightmaps.instants.size(); ++i) {
        for (std::size_t p = 0; p < lightmaps.pages.size(); ++p) {
            const LightmapPage& page = lightmaps.pages[p];
            for (std::size_t t = 0; t < page.state.size(); ++t) {
                if (page.state[t] == TexelState::chart) body(i, p, t);
            }
        }
    }
}

}  // namespace

IndirectNoise indirect_noise(const Lightmaps& lightmaps) {
    double texels = 0.0, light = 0.0, squares = 0.0;
    for_texels(lightmaps, [&](std::size_t instant, std::size_t page, std::size_t texel) {
        const LightmapLayer& layer = lightmaps.instants[instant].pages[page];
        texels += 1.0;
        light += static_cast<double>(luminance(layer.indirect[texel]));
        if (!layer.indirect_error.empty()) squares += std::pow(static_cast<double>(layer.indirect_error[texel]), 2);
    });
    if (texels == 0.0) return {};
    return {light / texels, std::sqrt(squares / texels)};
}

LeakReport find_leaks(const Atlas& atlas, const Lightmaps& lightmaps, int nearest, float tolerance) {
    const float deviations = 3.0f / std::sqrt(static_cast<float>(nearest));
    LeakReport report;
    double texels = 0.0, light = 0.0;
    for_texels(lightmaps, [&](std::size_t i, std::size_t p, std::size_t t) {
        const LightmapLayer& layer = lightmaps.instants[i].pages[p];
        const float total = luminance(total_irradiance(lightmaps, i, p, t)), leak = layer.leak[t];
        texels += 1.0;
        light += static_cast<double>(total);
        const float plain = luminance(layer.indirect[t]) + leak;
        if (!(leak > deviations * plain) || !(leak > tolerance * total)) return;
        const Chart& chart = atlas.charts[lightmaps.pages[p].chart[t].index()];
        const double area = static_cast<double>(glm::length(chart.u)) * static_cast<double>(glm::length(chart.v));
        ++report.texels;
        report.area_m2 += area;
        report.lumen += area * static_cast<double>(leak);
        if (static_cast<double>(leak) <= report.worst.leak_lx) return;
        const std::size_t width = static_cast<std::size_t>(lightmaps.pages[p].width);
        report.worst = {i, p, t % width, t / width, static_cast<double>(leak), static_cast<double>(total)};
    });
    if (texels > 0.0) report.picture_range_lx = 0.1 * light / texels;
    return report;
}

}  // namespace skybake
