// The inner loop of the search for photons, on vectors. Compiled once for each instruction set; the best that the
// processor has is taken at run time. All do the same operations in the same order: the same bits everywhere.
#pragma once

#include <span>
#include <vector>

#include "light/photon_search.h"

namespace skybake {

/// Photons as arrays: positions (local metres), normals, indices in the map. Those of floats are readable up to a
/// multiple of kPadding entries.
struct PatchArrays {
    static constexpr std::size_t kPadding = 16;
    std::span<const float> x, y, z, normal_x, normal_y, normal_z;
    std::span<const std::uint32_t> photon;
};

/// Replaces `found` with the photons of the query's surface nearer than `radius` and within its limits, in the order of
/// the arrays. `axes` are those of the query's normal.
void find_photons_within(const PatchArrays& patch, const PhotonQuery& query, const SurfaceAxes& axes, float radius,
                         std::vector<NearPhoton>& found);

}  // namespace skybake
