// The lie of the land: the river's course, the gentle valley floor, and the castle hill.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace skybake::town {

/// The river's centre line: corners at equal steps, running north. Offsets of its segments meet on the bisector at each
/// corner, so blocks whose centres lie beside the middles of the segments have the banks as exact sides.
class River {
  public:
    static constexpr double kStep = 60.0;         // length of a segment
    static constexpr double kBankOffset = 17.0;   // top of the bank from the centre line
    static constexpr double kBedOffset = 10.0;    // foot of the bank
    static constexpr double kWaterOffset = 14.5;  // the water's sheet ends inside the bank
    static constexpr double kBlockOffset = 43.0;  // centres of the blocks along the quays
    static constexpr double kClearance = 90.0;    // no other block has its centre nearer

    static constexpr Vec2d kStart{-122.0, -20.0};  // middle of segment number 0

    River(std::uint64_t seed, double reach);

    int segment_count() const { return static_cast<int>(corners_.size()) - 1; }
    /// Number of segment i counted from the one nearest the town's middle: stable for any reach.
    int number_of(int i) const { return i - middle_; }
    Vec2d corner(int i) const { return corners_[static_cast<std::size_t>(i)]; }
    /// Unit direction of segment i, upstream (north).
    Vec2d along(int i) const;
    /// Corner i moved by `offset` to the right (east for a river from south to north), on the bisector.
    Vec2d corner_beside(int i, double offset) const;
    double distance_to(Vec2d p) const;

  private:
    std::vector<Vec2d> corners_;
    int middle_ = 0;
};

/// Heights above sea level in metres, without the river's bed.
class Relief {
  public:
    explicit Relief(std::uint64_t seed) : seed_(seed) {}
    double ground(Vec2d p) const;
    /// The water's surface.
    double water(Vec2d p) const;

    static constexpr Vec2d kHillMiddle{48.0, 196.0};
    static constexpr double kHillReach = 124.0;  // beyond this distance from its middle the hill is not felt
    static constexpr double kHillHeight = 47.0;
    /// Distance from the hill's middle to its foot in direction p, and to the edge of its plateau as a share of that.
    static double hill_foot(Vec2d p);
    static constexpr double kPlateau = 0.40;

  private:
    std::uint64_t seed_;
};

}  // namespace skybake::town
