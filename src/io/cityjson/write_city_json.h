// CityJSON 2.0 and CityJSONSeq out of any CityModel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>

#include "city/city_model.h"

namespace skybake::io {

/// What is said of a polygon beside its type.
struct SurfaceNote {
    SurfaceType type = SurfaceType::unknown;  // where the polygon has none
    std::string members_json;                 // of its semantic object: "\"name\":value,…"; not empty
};
/// By object id and Surface::source_index.
using SurfaceNotes = std::unordered_map<std::string, std::unordered_map<std::uint32_t, SurfaceNote>>;

/// Writes the city as CityJSON 2.0, or as CityJSONSeq (one feature a line, a top-level object with all below it) when
/// the name ends in
/// ".jsonl". Coordinates are stored in whole millimetres above the city's lowest corner, each vertex once a file (once
/// a feature in a sequence). Shells of a solid become a Solid (a MultiSolid when there are several), loose surfaces a
/// MultiSurface, those of a terrain a CompositeSurface; semantics are written where CityJSON 2.0 knows them for the
/// kind of object, with the notes as attributes. Pictures are named, not copied. Text goes out as it is made, so memory
/// stays below 100 bytes a vertex; the file takes its name when it is whole. Throws InputError when the place cannot be
/// written, or when an object's attributes_json is no JSON object.
void write_city_json(const CityModel& city, const std::filesystem::path& path, const SurfaceNotes& notes = {});

}  // namespace skybake::io
