// The light of an instant as the browser gets it: eight bits a channel with two scales a chart, so that a texture unit
// can filter it.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/lightmap.h"
#include "io/image/image.h"

namespace skybake::io {

/// Of one chart at one instant. A scale is the largest value on the chart's texels and gutters, or 0 for a dark chart
/// (whose texels are 0).
struct ChartScale {
    float sky_klx = 0.0f;     // illuminance per channel where the sky picture is 1
    float sun_cosine = 0.0f;  // where the sun picture is 1
};

/// One a chart. Rounding: sRGB in 8 bit is off by at most 0.5 % of the scale near the scale, and by less in the dark.
std::vector<ChartScale> chart_scales(const Lightmaps& light, std::size_t instant, std::size_t chart_count);

/// Skylight over the chart's scale, sRGB-encoded RGB; black where no chart is.
Image8 sky_picture(const Lightmaps& light, std::size_t instant, std::size_t page,
                   const std::vector<ChartScale>& scales);

/// One a chart: the illuminance per channel where the indirect picture is 1, klx. Of bakes with reflected light.
std::vector<float> indirect_scales_klx(const Lightmaps& light, std::size_t instant, std::size_t chart_count);

/// Reflected light over the chart's scale, sRGB-encoded RGB; black where no chart is.
Image8 indirect_picture(const Lightmaps& light, std::size_t instant, std::size_t page,
                        const std::vector<float>& scales_klx);

/// The same of the lamps' direct light, which all instants share. Of bakes with lamps.
std::vector<float> lamp_scales_klx(const Lightmaps& light, std::size_t chart_count);
Image8 lamps_picture(const LightmapPage& page, const std::vector<float>& scales_klx);

/// Sun cosine over the chart's scale, linear grey.
Image8 sun_picture(const Lightmaps& light, std::size_t instant, std::size_t page,
                   const std::vector<ChartScale>& scales);

/// The sky view factor, linear grey, 255 for 1. White where no chart is, so that mipmaps of simple viewers darken no
/// border.
Image8 sky_view_picture(const LightmapPage& page);

/// 0.5 over the mean luminance (kcd m⁻²) that a white diffuse surface would have on all texels of charts; 1 when all is
/// dark. With lamps, which leave most of a city dark, the mean of their light weighed by itself is added: what it is
/// where it is. By day that is nothing; at night streets are not burnt out for the sake of roofs.
double exposure_hint(const Lightmaps& light, std::size_t instant);

/// IEEE 754 half of a float, rounded to nearest even; beyond its range the largest finite half, and 0 for NaN.
std::uint16_t half_from_float(float value);

}  // namespace skybake::io
