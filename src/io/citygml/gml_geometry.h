// GML surfaces and solids of a city object into a Geometry.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"
#include "io/assembly/corner_budget.h"
#include "io/citygml/gml_appearance.h"
#include "io/xml/xml_tree.h"

namespace skybake::io {

/// Elements by id that other objects refer to; their trees outlive it.
using GmlLibrary = std::unordered_map<std::string, XmlElement>;

/// What geometries of one object refer to, and where its findings say they are.
struct GmlContext {
    const GmlAppearance* appearance = nullptr;
    const GmlLibrary* library = nullptr;
    CornerBudget* budget = nullptr;
    std::string file;                                      // for places
    bool is_geographic = false;                            // coordinates are degrees
    std::unordered_map<std::string_view, XmlElement> ids;  // of the object's own tree

    /// The element that "#id" names; none, with finding SB120, when there is none.
    XmlElement resolve(std::string_view reference, XmlElement from, FindingLog& findings) const;
    /// The element that a property holds or refers to.
    XmlElement value_of(XmlElement property, FindingLog& findings) const;
    std::string place(XmlElement e) const;
};

/// True when a property with that name holds, or may refer to, a geometry or a part of one.
bool is_geometry_property(std::string_view name);

/// True for elements that are or hold solids.
bool holds_solids(XmlElement geometry);

/// A geometry of an object at the LoD that is read, and what its surfaces are.
struct GmlPart {
    XmlElement geometry;  // or an ImplicitGeometry
    SurfaceType type = SurfaceType::unknown;
};

/// The surfaces of all parts, each once: a solid's surfaces that thematic surfaces name too take their types from them.
Geometry read_gml_geometry(const std::vector<GmlPart>& parts, const GmlContext& context, const std::string& where,
                           FindingLog& findings);

}  // namespace skybake::io
