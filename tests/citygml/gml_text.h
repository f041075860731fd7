// CityGML of a few lines for tests.
#pragma once

#include <string>

#include "cityjson/temporary_city.h"

namespace skybake {

inline const std::string kSpaces2 =
    R"( xmlns="http://www.opengis.net/citygml/2.0" xmlns:gml="http://www.opengis.net/gml")"
    R"( xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:app="http://www.opengis.net/citygml/appearance/2.0")"
    R"( xmlns:dem="http://www.opengis.net/citygml/relief/2.0" xmlns:tran="http://www.opengis.net/citygml/transportation/2.0")"
    R"( xmlns:veg="http://www.opengis.net/citygml/vegetation/2.0" xmlns:frn="http://www.opengis.net/citygml/cityfurniture/2.0")"
    R"( xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:ext="https://example.org/extension")"
    R"( xmlns:grp="http://www.opengis.net/citygml/cityobjectgroup/2.0" xmlns:xlink="http://www.w3.org/1999/xlink")";

/// A document with these members, one a line.
inline std::string gml_document(const std::string& members, const std::string& head = "") {
    return "<?xml version=\"1.0\"?>\n" + head + "<CityModel" + kSpaces2 + ">\n" + members + "\n</CityModel>\n";
}
inline std::string member(const std::string& object) {
    return "<cityObjectMember>" + object + "</cityObjectMember>\n";
}
inline std::string gml_building(const std::string& properties, const std::string& id = "b") {
    return member("<bldg:Building gml:id=\"" + id + "\">" + properties + "</bldg:Building>");
}
inline std::string ring(const std::string& positions, const std::string& id = "") {
    return "<gml:LinearRing" + (id.empty() ? "" : " gml:id=\"" + id + "\"") + "><gml:posList>" + positions +
           "</gml:posList></gml:LinearRing>";
}
inline std::string polygon(const std::string& positions, const std::string& id = "", const std::string& inside = "") {
    return "<gml:Polygon" + (id.empty() ? "" : " gml:id=\"" + id + "\"") + "><gml:exterior>" +
           ring(positions, id.empty() ? "" : "r-" + id) + "</gml:exterior>" + inside + "</gml:Polygon>";
}
inline std::string surface_member(const std::string& surface) {
    return "<gml:surfaceMember>" + surface + "</gml:surfaceMember>";
}
inline std::string refer(const std::string& property, const std::string& id) {
    return "<gml:" + property + " xlink:href=\"#" + id + "\"/>";
}

/// The unit cube's outward faces: bottom, top, south, east, north, west.
inline const std::string kFaces[6] = {"0 0 0 0 1 0 1 1 0 1 0 0 0 0 0", "0 0 1 1 0 1 1 1 1 0 1 1 0 0 1",
                                      "0 0 0 1 0 0 1 0 1 0 0 1 0 0 0", "1 0 0 1 1 0 1 1 1 1 0 1 1 0 0",
                                      "1 1 0 0 1 0 0 1 1 1 1 1 1 1 0", "0 1 0 0 0 0 0 0 1 0 1 1 0 1 0"};
inline std::string cube_members(const std::string& id = "") {
    std::string text;
    for (int i = 0; i < 6; ++i) text += surface_member(polygon(kFaces[i], id.empty() ? "" : id + std::to_string(i)));
    return text;
}
inline std::string gml_solid(const std::string& members) {
    return "<gml:Solid><gml:exterior><gml:CompositeSurface>" + members +
           "</gml:CompositeSurface></gml:exterior></gml:Solid>";
}

inline LoadedCity load_gml(const std::string& text, const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return load(folder.write("a.gml", text), options);
}
/// The text of the first finding with the code.
inline std::string finding_text(const LoadedCity& city, const std::string& code) {
    for (const Finding& finding : city.findings.list()) {
        if (finding.code == code) return to_text(finding);
    }
    return "no " + code;
}
inline const CityObject& object_of(const LoadedCity& city, const std::string& id) {
    for (const CityObject& object : city.city.objects) {
        if (object.id == id) return object;
    }
    throw std::runtime_error("no object " + id);
}

}  // namespace skybake
