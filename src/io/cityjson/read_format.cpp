#include "io/cityjson/read_format.h"

#include <array>

namespace skybake::io {

std::string foreign_format(std::string_view head) {
    struct Magic {
        std::string_view bytes, name;
    };
    static constexpr std::array kMagic{
        Magic{"glTF", "binary glTF (GLB)"},
        Magic{"b3dm", "3D Tiles (b3dm)"},
        Magic{"i3dm", "3D Tiles (i3dm)"},
        Magic{"pnts", "3D Tiles (pnts)"},
        Magic{"cmpt", "3D Tiles (cmpt)"},
        Magic{"PK\x03\x04", "a ZIP archive"},
        Magic{"\x1f\x8b", "gzip-compressed data"},
        Magic{"LASF", "a LAS point cloud"},
        Magic{"ply", "a PLY mesh"},
        Magic{"LOCATION,", "EnergyPlus weather (EPW)"},
        Magic{"II*", "a TIFF raster"},
        Magic{"MM", "a TIFF raster"},
        Magic{"\x89PNG", "a PNG image"},
        Magic{"\xff\xd8\xff", "a JPEG image"},
        Magic{"%PDF", "a PDF document"},
        Magic{"fcb", "FlatCityBuf"},
        Magic{"SQLite format 3", "an SQLite database (GeoPackage, 3DCityDB)"},
        Magic{"ncols", "an ESRI ASCII grid"},
        Magic{"solid ", "an STL mesh"},
    };
    for (const Magic& magic : kMagic) {
        if (head.substr(0, magic.bytes.size()) == magic.bytes) return std::string(magic.name);
    }
    if (head.substr(0, 3) == "\xEF\xBB\xBF") head.remove_prefix(3);
    const std::size_t first = head.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return "";
    head.remove_prefix(first);
    const auto contains = [&](std::string_view text) { return head.find(text) != std::string_view::npos; };
    if (head[0] == '<') {
        if (contains("CityModel") || contains("citygml")) return "CityGML";
        if (contains("gml")) return "GML";
        if (contains("COLLADA")) return "COLLADA";
        return "XML";
    }
    if (head.substr(0, 2) == "v " || head.substr(0, 7) == "mtllib " || head.substr(0, 2) == "o " || contains("\nv "))
        return "Wavefront OBJ";
    if (head[0] == '{') {
        if (contains("\"asset\"") && !contains("CityJSON"))
            return contains("geometricError") ? "a 3D Tiles tileset" : "glTF";
        if (contains("FeatureCollection")) return "GeoJSON";
    }
    return "";
}

}  // namespace skybake::io
