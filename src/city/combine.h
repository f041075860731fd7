// Several geometries of one object into one, without showing the same surface twice.
#pragma once

#include <cstdint>

#include "city/city_model.h"

namespace skybake {

/// Appends the surfaces of `other` to `geometry`. A surface that covers the same vertices as one already there is not
/// appended; what only one of the two knows (type, material, texture) goes to the one that stays. Returns how many
/// surfaces were twice there. Vertices count as the same when their coordinates are equal, bit for bit. n log n in the
/// number of corners.
std::uint32_t combine(Geometry& geometry, const Geometry& other);

/// Keeps the surfaces whose entry in `keep` is not zero (one entry a surface), with their shells and corners; vertices
/// stay.
void keep_surfaces(Geometry& geometry, const std::vector<char>& keep);

/// Removes vertices that no corner uses; the order of the others stays.
void drop_unused_vertices(Geometry& geometry);

/// A number that two surfaces share exactly when they have the same set of vertex positions (up to hash collisions of
/// 64 bits), whichever corner is first and whichever way they run.
std::uint64_t surface_key(const Geometry& geometry, const Surface& surface);

}  // namespace skybake
