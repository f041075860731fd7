// Skylight of one tile of a chart: which texels see which directions, found hierarchically (paper §4.2;
// docs/architecture.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/crown_shade.h"
#include "bake/neighbour_runs.h"
#include "bake/sky_sampling.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "sky/dome_sampling.h"
#include "trace/occluder_tree.h"
#include "trace/ray_scene.h"

namespace skybake {

/// A tile's place: texel (0, 0) has its centre at origin + u / 2 + v / 2. See Chart.
struct TileFrame {
    Vec3f origin{0.0f}, u{1.0f, 0.0f, 0.0f}, v{0.0f, 1.0f, 0.0f}, normal{0.0f, 0.0f, 1.0f};
};

/// Points of up to 49 × 49 texels: three cells of 16 a side, and their far corners. Arrays have width × height entries,
/// row 0 on top.
struct TilePoints {
    static constexpr int kCell = 16;
    static constexpr int kMaxTexels = 3 * kCell + 1;
    static constexpr int kMaxSize = 64;  // a row of visibility is one machine word

    int width = 0;   // a multiple of kCell, plus 1
    int height = 0;  // likewise
    std::vector<float> x, y,
        z;  // lifted off the surface, local metres; texels that are not covered repeat the nearest covered one
    std::vector<std::uint64_t> covered;     // [row]: bit c set where texel c belongs to the surface
    std::vector<std::uint64_t> is_feature;  // [row]: texels near a place where other geometry touches the chart
    std::vector<Vec3f> normal;              // relief charts only, one a texel; else empty
    std::vector<std::uint32_t> triangle;    // what the texel lies on
    TileFrame frame;

    int texel(int column, int row) const { return row * width + column; }

    /// Gives the texels that are not covered the point of a covered one nearby. At least one must be covered.
    void extend();
    /// (uncovered texel, covered texel whose point it repeats), filled by `extend`.
    std::vector<std::pair<std::uint16_t, std::uint16_t>> copies;
};

/// What a tile's skylight is. Arrays have width × height entries.
struct TileLight {
    std::vector<std::vector<Rgb>> sky;   // [instant][texel], lx per channel
    std::vector<float> sky_view_factor;  // [texel]
};

struct SkyTileOptions {
    SkySampling sampling = SkySampling::projected;
    /// Root-mean-square error, relative to the tile's light, that the hierarchy may add to the same directions traced
    /// in full.
    float tolerance = 0.01f;
};

/// What all tiles of charts of one normal share.
struct SkyDirections {
    DomeSamples dome;
    NeighbourRuns bundles;                   // of those that can be projected: for SkySampling::projected, else empty
    std::vector<std::uint32_t> not_bundled;  // the others
    std::optional<DirectionCones> cones;     // where the scene has crowns
};

/// Sums over tiles; adding is exact, so the order does not matter.
struct SkyTileStatistics {
    std::uint64_t rays = 0;
    std::uint64_t crown_rays = 0;  // through crowns alone
    std::uint64_t pairs = 0;       // (texel, direction): what full sampling would trace
    /// Predicted squared error of the sky view factor against full sampling, and the factor itself, summed over texels
    /// in units of 2⁻³².
    std::uint64_t squared_error_sum = 0;
    std::uint64_t view_factor_sum = 0;
    std::uint64_t texels = 0;

    void add(const SkyTileStatistics& other);
};

/// The irradiance of every covered texel from the directions.
///
/// Full sampling traces each direction from every covered texel. Projection finds the same visibility without rays but
/// for the few directions that it cannot do (ShadowProjector). The hierarchy traces, for each direction, the nodes of
/// a lattice and the features, and halves those cells whose traced texels do not agree: visibility is 0 or 1, so a
/// shadow's edge costs its length and the area beside it nothing. A few pilot directions are traced in full first. They
/// tell (i) which of several lattices keeps the tolerance in this tile with the fewest packets, and (ii) at which
/// texels the error does not average out over the directions: these are traced always.
///
/// `occluders` is read by projection alone. `crowns` (may be null) dim what the texels see, however that was found.
TileLight light_tile(const TilePoints& points, const SkyDirections& directions, const OccluderTree* occluders,
                     const CrownVolume* crowns, DirectionPacket& packet, const SkyTileOptions& options,
                     SkyTileStatistics& statistics);

}  // namespace skybake
