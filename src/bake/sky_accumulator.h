// Sums of skylight over directions, for the texels of one tile.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "sky/dome_sampling.h"

namespace skybake {

struct TilePoints;
struct TileLight;

/// What directions add is either a constant for all texels of the tile (planar charts) or a vector whose product with
/// the texel's normal counts (relief charts). For each direction the smaller part of the tile, seeing or not, is taken
/// texel by texel; the rest goes into one sum for all.
class SkyAccumulator {
  public:
    SkyAccumulator(const TilePoints& points, const DomeSamples& dome);

    /// `visible` [row]: the covered texels that see the direction.
    void add(std::size_t direction, std::span<const std::uint64_t> visible);

    /// Takes back `loss` (0…1) of what a texel that sees the direction got from it.
    void dim(std::size_t direction, std::size_t texel, float loss);

    TileLight light() &&;

  private:
    std::size_t channels() const { return 3 * dome_.weights.size() + 1; }
    float weight(std::size_t channel, std::size_t direction) const;

    const TilePoints& points_;
    const DomeSamples& dome_;
    std::size_t stride_;                    // floats a row: whole vectors
    std::vector<std::vector<float>> sums_;  // [3 instant + colour, last the view factor][row × stride + column]
    std::vector<Vec3d> common_;             // [likewise]: of what all texels see
    // Relief: normals [row × stride + column], their mean, and the sine of their largest angle to it.
    std::vector<float> nx_, ny_, nz_;
    Vec3f axis_{0.0f};
    float horizon_sine_ = 0.0f;
    std::vector<float*> sum_of_;  // scratch: the channels that a direction adds to
    std::vector<float> weight_of_;
};

}  // namespace skybake
