// One city object: its type, the geometry at the wanted LoD, its attributes.
#pragma once

#include <simdjson.h>

#include <string>
#include <string_view>

#include "base/finding.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"
#include "io/assembly/lod.h"
#include "io/cityjson/read_geometry.h"

namespace skybake::io {

/// Reads the object `id`; interior objects come without geometry. `where` names file and place.
ReadObject read_object(std::string_view id, simdjson::dom::element element, const GeometryContext& context,
                       const LodChoice& choice, const std::string& where, FindingLog& findings);

}  // namespace skybake::io
