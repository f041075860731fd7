// The words of CityGML's conceptual model, which CityJSON shares: types of objects and of their surfaces.
#pragma once

#include <optional>
#include <string_view>

#include "city/city_model.h"

namespace skybake::io {

struct ObjectTerm {
    std::string_view name;
    ObjectType type;
    bool is_interior = false;
};

/// The term "Building", "TINRelief" …; none for an unknown one.
std::optional<ObjectTerm> object_term(std::string_view name);

/// The type of "RoofSurface", "Window" …; SurfaceType::unknown for an unknown one.
SurfaceType surface_type_from(std::string_view name);

}  // namespace skybake::io
