// The inner loops of projected shadows, on vectors of up to 16 quads. Compiled once for each instruction set; the best
// that the processor has is taken at run time. All do the same operations in the same order, without fused
// multiply-add: the same bits everywhere.
#pragma once

#include "bake/projection_tile.h"
#include "base/box.h"
#include "base/vec.h"
#include "trace/occluder_tree.h"

namespace skybake {

/// Fills tile.candidates with the quads that may shade the tile along a direction whose slopes (texels per metre) lie
/// in the box: all of those, and some others.
void find_candidates(const OccluderTree& tree, const Box2f& slopes, ProjectionTile& tile);

/// Takes the quads' shadows along the direction of the given slopes from what is open of the tile, and notes in
/// tile.hits which quads shade how much of it. True when nothing is left open.
bool cast_shadows_of(const ProjectionTile::Quads& quads, const Vec2f& slope, ProjectionTile& tile);

}  // namespace skybake
