// What the reflected light of a finished bake says of itself: its noise, and where it would leak through walls.
#pragma once

#include "atlas/atlas.h"
#include "bake/bake_report.h"
#include "bake/lightmap.h"

namespace skybake {

/// Over all texels that are charts' own, all instants together: the mean of the reflected light, and of its standard
/// error the root mean square (0 without the reference). Luminance-weighted, lx.
IndirectNoise indirect_noise(const Lightmaps& lightmaps);

/// Texels that photons from behind walls would light if no feelers kept them out: where LightmapLayer::leak exceeds
/// three standard deviations of the `nearest` photons that make the estimate, and `tolerance` of all light there. Needs
/// LightmapLayer::leak.
LeakReport find_leaks(const Atlas& atlas, const Lightmaps& lightmaps, int nearest, float tolerance);

}  // namespace skybake
