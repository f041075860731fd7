// All findings by number: what they are called and what the user can do. docs/findings.md tells more.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "base/finding.h"

namespace skybake {

struct FindingCode {
    std::string_view code;
    Severity severity;
    std::string_view title;
    std::string_view remedy;
};

/// SB1xx reading, SB2xx geometry, SB3xx place on Earth, SB4xx appearance, SB5xx ground, SB6xx light, SB7xx
/// weather. A code keeps its meaning for ever.
inline constexpr std::array kFindingCodes{
    FindingCode{"SB101", Severity::error, "part of the file is not built as the format says",
                "Validate the file (cjval, val3dity, an XML schema) and export it again."},
    FindingCode{"SB102", Severity::info, "points and lines have no surface to light",
                "Nothing to do, unless a surface was expected here."},
    FindingCode{"SB103", Severity::error, "vertex index out of range",
                "Export the file again; cjio's `validate` shows all such places."},
    FindingCode{"SB104", Severity::warning, "two objects have the same id", "Give each object an id of its own."},
    FindingCode{"SB105", Severity::info, "object of an extension is read as a generic object",
                "Nothing to do, unless it should be a building or ground: then give it a type of the core."},
    FindingCode{"SB106", Severity::warning, "unknown type of object is read as a generic object",
                "Correct the type, so that albedo and reports fit."},
    FindingCode{"SB107", Severity::warning, "version of the format is newer than this program",
                "Convert to CityJSON 2.0 with cjio, or update skybake."},
    FindingCode{"SB108", Severity::warning, "object has a flat LoD 0 only",
                "Take a dataset with LoD 1 or higher for this object."},
    FindingCode{"SB109", Severity::info, "object lacks the asked LoD; the nearest one is used",
                "Ask with --lod for one that all objects have; `skybake check` lists them."},
    FindingCode{"SB110", Severity::info, "interior object is left out",
                "Nothing to do: no daylight is computed indoors."},
    FindingCode{"SB111", Severity::error, "template of a geometry is missing or unusable",
                "Repair template number, anchor point and transformationMatrix of the GeometryInstance."},
    FindingCode{"SB112", Severity::warning, "semantics do not fit the boundaries; surface types are inferred",
                "Give semantics.values the nesting of the boundaries."},
    FindingCode{"SB113", Severity::warning, "no transform; coordinates are taken as they are",
                "CityJSON 1.1 and later need a transform; export again to be safe."},
    FindingCode{"SB114", Severity::info, "building and its parts show the same body; one of them is used",
                "Nothing to do, unless both should be there."},
    FindingCode{"SB115", Severity::warning, "parent or child is not in the file",
                "Export the whole family of objects together."},
    FindingCode{"SB116", Severity::warning, "metadata is not built as the format says",
                "Metadata is one object; referenceSystem is an EPSG URL, geographicalExtent six numbers."},
    FindingCode{"SB117", Severity::error, "city has no surface to light", "Check that this is the right file."},
    FindingCode{"SB118", Severity::warning, "LoD is missing or no number; taken as 1",
                "State the LoD as \"1\" to \"3.3\"."},
    FindingCode{"SB119", Severity::error, "line of the sequence is unreadable",
                "Repair that line; a last line cut short means an incomplete download."},
    FindingCode{"SB120", Severity::warning, "reference leads nowhere",
                "Export the object together with what it refers to."},
    FindingCode{"SB121", Severity::info, "objects were left out as asked",
                "Nothing to do; widen --bbox or shorten --exclude where one is missed."},
    FindingCode{"SB122", Severity::info, "part of the file is not read",
                "Nothing to do, unless it should give or take light."},
    FindingCode{"SB123", Severity::warning, "footprint has no height; left out",
                "Give it a height or storeys, or name the attribute with --height-field."},
    FindingCode{"SB124", Severity::info, "roof of a footprint is taken as flat",
                "Nothing to do; flat, gabled, hipped and pyramidal roofs on four corners are built."},

    FindingCode{"SB201", Severity::warning, "coordinates carry the offset of the transform twice",
                "Nothing to do: the offset was taken off once. Its writer should store coordinates relative to "
                "transform.translate."},
    FindingCode{"SB202", Severity::info, "same surface twice in one object", "Nothing to do: one of them is used."},
    FindingCode{"SB203", Severity::warning, "ring crosses or touches itself or another ring",
                "Repair the ring, or pass --strict to stop here."},
    FindingCode{"SB204", Severity::warning, "surface without area",
                "Nothing to do: it would get no light. Repair it where a wall or roof is missed."},
    FindingCode{"SB205", Severity::info, "ring has a spike or repeated corners", "Nothing to do: they were taken out."},
    FindingCode{"SB206", Severity::info, "surface is not flat",
                "Nothing to do: it is folded along its triangles. Split it in the source where the fold looks wrong."},
    FindingCode{"SB207", Severity::warning, "surface faces inward",
                "Nothing to do: it was turned about. Outer rings run counter-clockwise seen from outside."},
    FindingCode{"SB208", Severity::warning, "solid is inside out",
                "Nothing to do: all of its surfaces were turned about."},
    FindingCode{"SB209", Severity::warning, "solid is not closed",
                "Light may leak in; close the solid where the picture shows it."},
    FindingCode{"SB210", Severity::info, "vertices up to 1 mm apart were merged", "Nothing to do."},
    FindingCode{"SB211", Severity::error, "coordinate is no place on Earth",
                "Replace the no-data value by the real height or place."},
    FindingCode{"SB212", Severity::error, "polygon cannot be cut into triangles", "Repair the polygon in its source."},
    FindingCode{"SB213", Severity::warning, "more than two surfaces of a solid meet at an edge",
                "Nothing to do for light; repair it where volumes are needed."},
    FindingCode{"SB214", Severity::info, "solids of one building overlap",
                "Nothing to do: hidden surfaces get no light."},
    FindingCode{"SB215", Severity::warning, "stated extent is not that of the coordinates",
                "Let the writer compute geographicalExtent anew; the coordinates are what counts here."},
    FindingCode{"SB216", Severity::error, "object lies far away from the city",
                "Repair its coordinates, or check it alone."},
    FindingCode{"SB217", Severity::warning, "two files show the same object",
                "Nothing to do: the one of the earlier file is used."},

    FindingCode{"SB218", Severity::info, "plant is no closed body",
                "Nothing to do, unless the depth of its shadow matters: then model the crown as a closed solid."},
    FindingCode{"SB301", Severity::info, "geographic coordinates were projected to metres",
                "Nothing to do: results are in metres about the city's centre."},
    FindingCode{"SB302", Severity::info, "coordinates that are no true metres were projected to metres",
                "Nothing to do: results are in metres about the city's centre."},
    FindingCode{"SB303", Severity::warning, "coordinate reference system is unknown",
                "Pass --site LAT,LON, or name the system as EPSG:CODE in the file."},
    FindingCode{"SB304", Severity::warning, "no coordinate reference system is named",
                "Pass --site LAT,LON, or name the system as EPSG:CODE in the file."},
    FindingCode{"SB305", Severity::warning, "coordinates lie outside the area of their reference system",
                "Check the system that the file names, or pass --site LAT,LON."},
    FindingCode{"SB306", Severity::error, "files name different coordinate reference systems",
                "Bring them into one system first, with cjio or GDAL."},
    FindingCode{"SB307", Severity::warning, "coordinates have north before east",
                "Nothing to do: x and y were exchanged. Its writer should store east, north, height."},
    FindingCode{"SB308", Severity::info, "file was brought into the reference system of the first", "Nothing to do."},

    FindingCode{"SB401", Severity::warning, "texture image is missing",
                "Put the image where the file names it; until then the default albedo of the surface is used."},
    FindingCode{"SB402", Severity::error, "texture image outside the file's folder is refused",
                "Put the image below the folder of the city file."},
    FindingCode{"SB403", Severity::warning, "texture of a surface does not fit its rings",
                "Give each ring one image and one texture vertex for each corner."},
    FindingCode{"SB404", Severity::warning, "material of a surface does not exist or does not fit",
                "Give material.values the nesting of the boundaries, with numbers of existing materials."},
    FindingCode{"SB405", Severity::warning, "colour of a material is outside 0 to 1",
                "State colours as three numbers from 0 to 1."},
    FindingCode{"SB406", Severity::info, "transparent material is taken as opaque",
                "Nothing to do: light does not pass through surfaces in this version."},
    FindingCode{"SB407", Severity::info, "several themes; one of them is used",
                "Name the wanted one as default-theme-material or default-theme-texture."},
    FindingCode{"SB408", Severity::warning, "texture image cannot be read", "Save the image again as PNG or JPEG."},

    FindingCode{"SB501", Severity::warning, "city has no ground",
                "Pass --ground plane or --ground draped to add one that receives light and shadow."},
    FindingCode{"SB502", Severity::info, "ground was added", "Nothing to do."},
    FindingCode{"SB503", Severity::info, "raster became a surface of triangles",
                "Nothing to do; --raster-error sets how far it may lie from the raster."},
    FindingCode{"SB504", Severity::warning, "no ground beneath a footprint; it stands at height 0",
                "Add a terrain file that covers it: skybake bake footprints.gpkg dem.tif."},
    FindingCode{"SB505", Severity::info, "ground shows an orthophoto",
                "Nothing to do. Ground beyond the picture has the default albedo."},

    FindingCode{"SB601", Severity::warning, "turbidity is outside the range of the sky model",
                "Take 2 for very clear, 3 for clear, 6 for hazy air."},
    FindingCode{"SB602", Severity::warning, "sun is on or below the horizon",
                "Choose a time between sunrise and sunset."},
    FindingCode{"SB603", Severity::info, "published level of the Preetham sky",
                "Take level=clearsky for numbers that are to be relied on."},
    FindingCode{"SB604", Severity::warning, "there is no light at all", "Give --at, --sun-direction or another --sky."},
    FindingCode{"SB605", Severity::warning, "weather is outside of what the Perez sky knows",
                "Check the irradiances against the hour of the day (W/m²)."},
    FindingCode{"SB606", Severity::warning, "there is no sun in the picture of the sky", "Take sun=keep."},
    FindingCode{"SB607", Severity::warning, "picture of the sky has impossible values",
                "Repair the picture: every channel is finite and not negative."},

    FindingCode{"SB701", Severity::error, "row of the weather file is unreadable",
                "Repair that row; a last row cut short means an incomplete download."},
    FindingCode{"SB702", Severity::error, "irradiance of the weather file is impossible",
                "Correct the row, or write 9999 for what is not known."},
    FindingCode{"SB703", Severity::warning, "hour stands in the weather file twice",
                "Leave one of them out, or state the records an hour in DATA PERIODS."},
    FindingCode{"SB704", Severity::warning, "weather file has gaps", "Take a whole file where sums count."},
    FindingCode{"SB705", Severity::info, "missing radiation follows from the two others", "Nothing to do."},
    FindingCode{"SB706", Severity::warning, "hour of the weather file has no radiation",
                "Choose another hour, or fill the row."},
    FindingCode{"SB707", Severity::warning, "radiation of an hour does not add up",
                "Take another source for such hours where they matter."},
    FindingCode{"SB708", Severity::warning, "columns of radiation are exchanged",
                "Nothing to do: they were exchanged. Its writer should keep to the order global, direct, diffuse."},
    FindingCode{"SB709", Severity::warning, "hours of the weather file are not where the format has them",
                "Nothing to do: the sun stands where the radiation says."},
    FindingCode{"SB710", Severity::info, "middle of the hours cannot be found",
                "Nothing to do, unless shadows of the morning and the evening look exchanged."},
    FindingCode{"SB711", Severity::info, "place is that of the weather file",
                "Pass --site LAT,LON where the city stands elsewhere."},
    FindingCode{"SB712", Severity::warning, "weather is that of a far place",
                "Take the weather file of a nearer place."},
    FindingCode{"SB713", Severity::info, "weather file has no 29 February",
                "Nothing to do: the weather is that of 28 February."},
    FindingCode{"SB714", Severity::warning, "time zone of the weather file does not fit its longitude",
                "Check longitude (east positive) and time zone in the LOCATION line."},
    FindingCode{"SB715", Severity::warning, "header line of the weather file is missing or wrong",
                "Write the line as in: DATA PERIODS,1,1,Data,Sunday,1/1,12/31."},

    FindingCode{"SB801", Severity::warning, "light of the lamp file is no lamp",
                "Give the sun by --at or --sun-direction instead."},
};

constexpr const FindingCode* find_code(std::string_view code) {
    for (const FindingCode& entry : kFindingCodes) {
        if (entry.code == code) return &entry;
    }
    return nullptr;
}

/// A finding with severity and remedy of its code. `what` is the fault and what was done about it, as a clause that
/// ends in a stop.
inline Finding make_finding(std::string_view code, std::string where, std::string what) {
    const FindingCode* entry = find_code(code);
    return {std::string(code), entry ? entry->severity : Severity::error, std::move(where), std::move(what),
            entry ? std::string(entry->remedy) : std::string()};
}

}  // namespace skybake
