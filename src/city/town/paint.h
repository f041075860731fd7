// The town's pictures, painted by our own hand: no image files are shipped.
#pragma once

#include <vector>

#include "city/town/town.h"

namespace skybake::town {

/// All pictures in the order of Picture (styles.h). sRGB; the mean albedo of plaster is 0.4 to 0.65, of roof tiles 0.15
/// to 0.25, of paving 0.2 to 0.35: believable for clay, lime plaster and stone. All repeat without seams.
std::vector<NamedImage> paint_pictures(std::uint64_t seed);

}  // namespace skybake::town
