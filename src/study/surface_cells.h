// Cells of façades, roofs and windows. Private to the folder.
#pragma once

#include "study/receivers.h"

namespace skybake {

/// Appends the receivers and samples of one kind (roof, facade or window) for all buildings of the scene.
void add_surface_cells(ReceiverSet& set, const Scene& scene, ReceiverKind kind, const ReceiverOptions& options);

}  // namespace skybake
