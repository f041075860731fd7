// Which object of the city each chart belongs to, and what the city file says about it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "atlas/atlas.h"
#include "scene/scene.h"

namespace skybake::io {

/// Attributes of a city's objects as JSON objects, by id.
using AttributesOf = std::map<std::string, std::string>;

/// Attributes of all objects that state any.
AttributesOf attributes_of(const CityModel& city);

/// The text of `objects.json` (docs/formats.md): every object of the scene, the topmost parents that have no surfaces
/// of their own, their attributes, and one object and surface type a chart. What is no JSON object among the attributes
/// is left out.
std::string objects_json(const Scene& scene, const Atlas& atlas, const AttributesOf& attributes);

}  // namespace skybake::io
