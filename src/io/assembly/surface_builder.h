// Polygons on their way into a geometry, ring by ring: the same for every format.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::io {

/// Appends surfaces to a geometry. A surface is begun, gets its rings, corner by corner, and is ended or dropped; a
/// dropped one leaves no trace. Vertices are the caller's: `geometry.vertices` is filled by whom numbers them.
class SurfaceBuilder {
  public:
    Geometry geometry;

    void begin_shell(Shell::Kind kind);
    /// A shell that got no surface goes.
    void end_shell();

    void begin_surface();
    void add_corner(std::uint32_t vertex) { geometry.corners.push_back(vertex); }
    /// Ends the ring that the corners since the last one make, without last corners that repeat the first. Returns how
    /// many it has; with fewer than three it is taken off again.
    std::size_t close_ring();
    /// Rings of the surface so far.
    std::size_t ring_count() const { return geometry.ring_first.size() - first_ring_; }
    /// Corners of the surface so far, with those of a ring that is not closed.
    std::size_t corner_count() const { return geometry.corners.size() - first_corner_; }
    void drop_surface();
    /// The finished surface, for its type and material; valid until the next one.
    Surface& end_surface(std::uint32_t source_index);
    /// Gives the surface ended last an image, and a texture vertex for each of its corners.
    void set_texture(TextureId texture, std::span<const Vec2f> uvs);
    /// Lets the surface ended last face the other way.
    void reverse_surface();

    /// The geometry; the builder is empty then.
    Geometry finish();

  private:
    std::size_t first_ring_ = 1;  // of the surface, in Geometry::ring_first
    std::size_t first_corner_ = 0;
    std::vector<Vec2f> uvs_;  // of the corners up to the last textured surface
};

/// SB204: a ring of fewer than three corners, which is left out; without its outer ring so is the surface.
Finding short_ring(std::string where, bool is_outer, std::size_t corners);

}  // namespace skybake::io
