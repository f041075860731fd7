// The steps of repair, each for one object. Private to the folder.
#pragma once

#include <cstdint>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::repair_steps {

/// False for what is no place in metres or degrees: not finite, or beyond 10⁹ m. Files use such numbers for "no data"
/// (10³⁸).
bool is_place(const Vec3d& p);

/// SB211: surfaces with a corner that is no place, or lies further from the median of the object's vertices than any
/// object reaches
/// (-2147483.648, the least 32-bit integer in millimetres, stands for "no height" in real files). Their vertices go,
/// too.
void drop_bad_coordinates(CityObject& object, FindingLog& findings);
/// Vertices: SB210; then rings: SB205, SB204; then surfaces twice there: SB202.
void merge_vertices(CityObject& object, FindingLog& findings);
void clean_rings(CityObject& object, FindingLog& findings);
void drop_repeated_surfaces(CityObject& object, FindingLog& findings);

/// SB203 and SB206; returns the number of triangles of all surfaces that stay.
std::uint64_t split_crossing_rings(CityObject& object, FindingLog& findings);

struct ShellCounts {
    std::uint64_t closed = 0;
    std::uint64_t open = 0;
};
/// SB207, SB208, SB209, SB213.
ShellCounts orient(CityObject& object, FindingLog& findings);

/// Turns a surface about: each of its rings runs the other way.
void turn(Geometry& geometry, const Surface& surface);

/// Gives surfaces of unknown type one by their object and their normal.
void infer_types(CityObject& object);

/// SB214: closed outer shells of the objects (one family) that overlap.
void note_overlaps(const std::vector<const CityObject*>& family, FindingLog& findings);

}  // namespace skybake::repair_steps
