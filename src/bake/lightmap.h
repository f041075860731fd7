// The finished light of a bake, as values: what the writers store and the walkthrough shows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/atlas.h"
#include "base/rgb.h"
#include "sky/daylight.h"

namespace skybake {

enum class TexelState : std::uint8_t {
    empty,   // belongs to nothing
    chart,   // a texel of a chart, with light of its own
    buried,  // a texel of a chart inside or behind another solid, where nobody can stand: filled from its neighbours
    gutter   // beside a chart: filled from it, so that bilinear lookup finds no foreign light
};

/// What all instants of a page share. Arrays have width × height entries, row 0 on top.
struct LightmapPage {
    int width = 0;
    int height = 0;
    std::vector<TexelState> state;
    std::vector<ChartId> chart;          // whose texel or gutter it is; undefined where empty
    std::vector<float> sky_view_factor;  // cosine-weighted visible share of the sky, 0…1: E/(πL) under a uniform sky
    std::vector<Rgb> lamps = {};         // direct light of lamps, lx per channel; empty when there are none
};

/// Light of one instant on one page. Irradiance in lx per channel, linear Rec. 709.
struct LightmapLayer {
    std::vector<Rgb> sky;           // skylight
    std::vector<float> sun_cosine;  // sunlit share of the texel × cosine of incidence; × SunBeam::normal_illuminance is
                                    // the sun's light in lx
    std::vector<Rgb> indirect;          // reflected light; empty when it was not asked for
    std::vector<float> indirect_error;  // its standard error, lx; empty without the reference
    std::vector<float> leak;  // what photons beyond the feelers would add, lx; empty when it was not asked for
};

struct BakedInstant {
    Daylight daylight;
    std::vector<LightmapLayer> pages;  // one a page
};

struct Lightmaps {
    std::vector<LightmapPage> pages;
    std::vector<BakedInstant> instants;
};

/// Sun, sky, lamps and reflected light together, lx per channel.
inline Rgb total_irradiance(const Lightmaps& light, std::size_t instant, std::size_t page, std::size_t texel) {
    const BakedInstant& baked = light.instants[instant];
    const LightmapLayer& layer = baked.pages[page];
    Rgb total = layer.sky[texel] + layer.sun_cosine[texel] * baked.daylight.sun.normal_illuminance;
    if (!layer.indirect.empty()) total += layer.indirect[texel];
    if (!light.pages[page].lamps.empty()) total += light.pages[page].lamps[texel];
    return total;
}

}  // namespace skybake
