// One geometry of a city object: boundaries, semantics, materials and textures in step.
#pragma once

#include <simdjson.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"
#include "io/assembly/corner_budget.h"
#include "io/assembly/lod.h"
#include "io/cityjson/read_appearance.h"

namespace skybake::io {

/// The geometry-templates of a file; their vertices are local and in metres.
struct CityJsonTemplates {
    std::vector<simdjson::dom::element> templates;
    std::vector<Vec3d> vertices;
    const CityJsonAppearance* appearance = nullptr;
};

/// What a geometry refers to.
struct GeometryContext {
    std::span<const Vec3d> vertices;
    const CityJsonAppearance* appearance = nullptr;
    const CityJsonTemplates* templates = nullptr;
    CornerBudget* budget = nullptr;  // of templates
};

/// Materials and textures of surfaces are numbers in `context.appearance`, or in the templates' appearance when
/// `is_from_template`.
struct ReadGeometry {
    Geometry geometry;
    bool is_from_template = false;
    bool has_semantics = false;
};

/// Reads the geometry `element`; empty with findings when it has no surface that can be used. Surfaces without
/// semantics stay SurfaceType::unknown.
ReadGeometry read_geometry(simdjson::dom::element element, const GeometryContext& context, const std::string& where,
                           FindingLog& findings);

/// The LoD that a geometry states: its text as "2.2" and its value; none when it states none or something else than a
/// number.
std::optional<Lod> read_lod(simdjson::dom::element geometry);

}  // namespace skybake::io
