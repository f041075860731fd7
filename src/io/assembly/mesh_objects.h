// Meshes without semantics on their way into the city: the same for OBJ, glTF and 3D Tiles.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "io/assembly/city_assembly.h"
#include "io/assembly/city_terms.h"
#include "io/assembly/surface_builder.h"

namespace skybake::io {

/// An object while it grows: faces go into `surfaces`, everything else is set.
struct MeshObject {
    ReadObject read;
    SurfaceBuilder surfaces;
    std::map<std::size_t, std::uint32_t>
        vertices;  // from the file's numbers to the object's, where the reader needs it
};

/// What a material's name says of its object: CityGML's terms and 3dfier's ("ForestWall" is the wall below a forest).
std::optional<ObjectTerm> term_of_material(std::string_view name);

/// The objects of one file: one for each name and type.
class MeshObjects {
  public:
    /// Nameless objects are called `default_id`.
    MeshObjects(CityAssembly& assembly, std::string default_id)
        : assembly_(assembly), default_id_(std::move(default_id)) {}

    /// The object for faces of that name and term; `place` ("line 7") is where it begins. The reference stays valid.
    MeshObject& at(const std::string& name, const std::optional<ObjectTerm>& term, const std::string& place);

    /// Hands all objects to the assembly. Those that no material names are terrain when they face up nearly everywhere,
    /// else generic, so that their surfaces become roofs, walls and undersides by slope (city/repair).
    void finish(const AppearanceMap& map);

  private:
    CityAssembly& assembly_;
    std::string default_id_;
    std::map<std::pair<std::string, ObjectType>, MeshObject> objects_;
    std::set<std::string> ids_;
};

}  // namespace skybake::io
