// Skylight that crowns of trees take from a tile.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/neighbour_runs.h"
#include "sky/dome_sampling.h"
#include "trace/ray_scene.h"

namespace skybake {

class SkyAccumulator;
struct TilePoints;

/// A dome's directions in cones of neighbours, so that those which meet a crown are found together.
class DirectionCones {
  public:
    explicit DirectionCones(const DomeSamples& dome);

    /// Sets meets[j] for the directions of all cones that a ray from within `radius` of `center` can meet the crown in.
    void mark(const Crown& crown, const Vec3f& center, float radius, std::vector<std::uint8_t>& meets) const;

  private:
    struct Cone {
        Vec3f axis;
        float half_angle;
    };
    NeighbourRuns runs_;
    std::vector<Cone> cones_;
};

/// Asks the crowns from each texel of a tile that sees a direction, in blocks of neighbouring texels and only in
/// directions in which a block can meet a crown.
class CrownShade {
  public:
    CrownShade(const TilePoints& points, const DomeSamples& dome, const DirectionCones& cones,
               const CrownVolume& crowns, DirectionPacket& packet);

    /// Dims the texels that see direction j ([row]: bits) in the sum. Returns the number of rays.
    std::uint64_t dim(std::size_t j, std::span<const std::uint64_t> visible, SkyAccumulator& sum);

  private:
    struct Block {
        int column = 0, row = 0;
        std::vector<std::uint8_t> meets;  // [direction]
    };
    const TilePoints& points_;
    const DomeSamples& dome_;
    DirectionPacket& packet_;
    std::vector<Block> blocks_;
    std::vector<std::uint8_t> meets_;  // [direction]: some block does
};

}  // namespace skybake
