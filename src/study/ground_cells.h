// Cells on the ground. Private to the folder.
#pragma once

#include "study/receivers.h"

namespace skybake {

/// Appends the receiver "ground" with a sample on each lattice cell that has ground.
void add_ground_cells(ReceiverSet& set, const Scene& scene, const ReceiverOptions& options);

/// Appends one receiver for each polygon, with a sample on each lattice cell whose centre lies in it and has ground;
/// one without such a cell stays empty.
void add_polygon_cells(ReceiverSet& set, const Scene& scene, const ReceiverOptions& options);

}  // namespace skybake
