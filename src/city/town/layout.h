// The plan of the town: cells of land, what each is for, and the lots of its houses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "city/town/plane_geometry.h"
#include "city/town/relief.h"

namespace skybake::town {

enum class CellUse : std::uint8_t { block, square, church, park, tower_site, hill, field };

/// What lies beyond an edge of a cell, instead of the number of a cell.
inline constexpr int kRiverbank = -1;
/// An edge of a block that was cut off at a sharp corner.
inline constexpr int kCutCorner = -2;

/// A place for one house. A row house stands on corners {0, 1, 2, 3} of a rectangle whose first side is its front. A
/// corner house stands on {A, P, B, B', Q, A'}: P is the block's corner, A-P and P-B its two fronts, Q the re-entrant
/// corner in the court, A-A' and B-B' its party walls.
struct Lot {
    std::vector<Vec2d> ring;
    int number = 0;  // within its cell
    bool is_corner() const { return ring.size() == 6; }
};

/// A piece of land up to the middle of the streets around it, convex. The labels of `land` are indices of the
/// neighbouring cells or kRiverbank.
struct Cell {
    std::string name;       // part of the ids of everything on it
    std::uint64_t key = 0;  // stable hash for draws
    Vec2d site{0.0};
    CellUse use = CellUse::field;
    bool is_beside_river = false;
    ConvexPolygon land;
    std::vector<double> half_street;  // one an edge of `land`: from the edge to the houses' fronts
    ConvexPolygon block;              // what the streets leave; labels are edges of `land`, or kCutCorner
    double house_depth = 0.0;
    std::vector<Lot> lots;  // of a block: all; see Layout::houses_in
};

struct Layout {
    River river;
    std::vector<Cell> cells;               // sorted by distance of the site from the main square, which is the first
    std::vector<std::uint32_t> houses_in;  // how many of its lots are built, one a cell
    double reach = 0.0;                    // cells with their site nearer than this are drawn
    int first_segment = 0;                 // river segments [first, last) are drawn
    int last_segment = 0;
};

/// Lays out a town with room for `houses` houses, churches beyond the first one counted as a house each.
Layout lay_out(std::uint64_t seed, std::uint32_t houses);

/// "e3" or "w3" for +3 and -3 with the letters e and w.
std::string signed_name(char positive, char negative, std::int64_t value);

/// Lots along the edges of `cell.block`; sets `house_depth`. Leaves none when the block is too small.
void divide_into_lots(std::uint64_t seed, Cell& cell);

}  // namespace skybake::town
