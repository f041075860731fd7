#include "io/assembly/file_format.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "base/error.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

std::string head_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(fmt::format("{}: cannot be opened for reading.", path.string()));
    std::string head(2048, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    if (head.find_first_not_of(" \t\r\n") == std::string::npos)
        throw InputError(fmt::format("{}: the file is empty. Is it a download that broke off?", path.string()));
    return head;
}

std::string format_of(std::string_view head) {
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
        Magic{std::string_view("II*\0", 4), "a TIFF raster"},
        Magic{std::string_view("MM\0*", 4), "a TIFF raster"},
        Magic{std::string_view("II+\0", 4), "a TIFF raster"},  // BigTIFF
        Magic{std::string_view("MM\0+", 4), "a TIFF raster"},
        Magic{"\x89PNG", "a PNG image"},
        Magic{"\xff\xd8\xff", "a JPEG image"},
        Magic{"%PDF", "a PDF document"},
        Magic{"fcb", "FlatCityBuf"},
        Magic{std::string_view("\0\0\x27\x0a", 4), "an ESRI shapefile"},
        Magic{"ncols", "an ESRI ASCII grid"},
        Magic{"solid ", "an STL mesh"},
    };
    for (const Magic& magic : kMagic) {
        if (head.substr(0, magic.bytes.size()) == magic.bytes) return std::string(magic.name);
    }
    // Application id of a GeoPackage, at a fixed place of the database's head (OGC 12-128r18, requirement 2).
    if (head.substr(0, 15) == "SQLite format 3")
        return head.size() > 72 && head.substr(68, 3) == "GPK" ? "a GeoPackage" : "an SQLite database";
    if (head.substr(0, 3) == "\xEF\xBB\xBF") head.remove_prefix(3);
    if (head.substr(0, 3) == std::string_view("\xFF\xFE<", 3) ||
        head.substr(0, 4) == std::string_view("\xFE\xFF\0<", 4))
        return "XML";  // UTF-16
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
        if (contains("\"FeatureCollection\"") || contains("\"Feature\"")) return "GeoJSON";
    }
    if (head[0] != '{' && head[0] != '[') return "a file of unknown format";
    return "";
}

std::uintmax_t checked_file_size(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (error || !std::filesystem::exists(status)) {
        throw InputError(fmt::format("{}: there is no such file.", path.string()));
    }
    if (std::filesystem::is_directory(status)) {
        throw InputError(fmt::format("{}: is a folder; name the city files in it.", path.string()));
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw InputError(fmt::format("{}: is no regular file; write it to the disk first.", path.string()));
    }
    return std::filesystem::file_size(path);
}

std::uint64_t hash_of_file(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(fmt::format("{}: cannot be opened for reading.", path.string()));
    ContentHash hash;
    std::string piece(std::size_t{1} << 20, '\0');
    while (in) {
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        hash.add(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
    }
    return hash.value();
}

}  // namespace skybake::io
