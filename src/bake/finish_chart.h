// From the light of a chart's own texels to a page that can be looked at: nothing dark where nobody can stand, nothing
// foreign beside it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/chart_samples.h"
#include "bake/lightmap.h"
#include "light/path_reference.h"
#include "sky/dome_sampling.h"
#include "trace/ray_scene.h"

namespace skybake {

/// The light of one chart on its own grid, size.x × size.y.
struct ChartLight {
    std::vector<std::vector<Rgb>> sky;           // [instant][texel]
    std::vector<std::vector<float>> sun_cosine;  // [instant][texel]
    std::vector<float> sky_view_factor;
    std::vector<Rgb> lamps;  // [texel]; empty without lamps
};

/// Which covered texels lie inside or behind another solid: they see next to no sky, and most of what they see are back
/// faces. Only texels within a few texels of lit ones or of the chart's border are asked, since only those can show.
/// Adds the number of rays to `ray_count`.
std::vector<std::uint8_t> find_buried(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                      const ChartLight& light, const DomeSamples& dome, const RayScene& rays,
                                      std::uint64_t& ray_count);

/// Writes the chart into its page, buried texels and gutter filled from their neighbours.
void write_chart(ChartId id, const Chart& chart, const ChartSamples& samples, std::span<const std::uint8_t> buried,
                 const ChartLight& light, LightmapPage& page, std::span<LightmapLayer* const> layers);

/// Writes the chart's reflected light into its page, on which write_chart has been: buried texels and gutter are filled
/// from their neighbours. Of `layer.indirect_error` and `layer.leak` what is not empty is written, at the chart's own
/// texels.
void write_indirect(const Chart& chart, std::span<const IndirectLight> light, const LightmapPage& page,
                    LightmapLayer& layer);

/// Where charts of nearly one plane meet, each one's gutter takes the other's light, so that both show the same along
/// their edge.
void join_seams(const Atlas& atlas, Lightmaps& lightmaps);

/// Along the edge of a wall that nobody sees (between two houses, say) the light of the visible wall beside it is put:
/// through the cracks that rasterisers leave between abutting houses it would show as a dark line.
void light_hidden_edges(const Atlas& atlas, Lightmaps& lightmaps);

}  // namespace skybake
