// City objects of CityGML 1.0, 2.0 and 3.0: their type, the geometry at the wanted LoD, their attributes.
#pragma once

#include <string>
#include <vector>

#include "base/finding.h"
#include "io/assembly/city_assembly.h"
#include "io/assembly/lod.h"
#include "io/citygml/gml_geometry.h"
#include "io/xml/xml_tree.h"

namespace skybake::io {

/// Appends the object `feature` and all objects in it (parts, installations, terrain of a relief). `nameless` is the id
/// of an object that has none of its own. Interior objects are left out with a finding.
void read_gml_object(XmlElement feature, const GmlContext& context, const LodChoice& choice,
                     const std::string& nameless, std::vector<ReadObject>& into, FindingLog& findings);

}  // namespace skybake::io
