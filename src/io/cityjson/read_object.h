// One city object: its type, the geometry at the wanted LoD, its attributes.
#pragma once

#include <simdjson.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"
#include "io/cityjson/read_geometry.h"

namespace skybake::io {

struct ReadObject {
    CityObject object;
    std::vector<std::string> children;
    std::vector<std::string> lods;  // that the file offers for it
    bool has_only_flat = false;     // nothing above LoD 0, and no ground
    bool is_appearance_of_templates = false;
};

/// Which LoD to read: the highest, or the nearest to the asked one.
struct LodChoice {
    std::optional<Lod> asked;
};

/// Reads the object `id`; interior objects come without geometry. `where` names file and place.
ReadObject read_object(std::string_view id, simdjson::dom::element element, const GeometryContext& context,
                       const LodChoice& choice, const std::string& where, FindingLog& findings);

}  // namespace skybake::io
