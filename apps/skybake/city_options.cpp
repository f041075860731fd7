#include "city_options.h"

#include <map>

#include "base/error.h"

namespace skybake::cli {

LoadOptions CityOptions::load_options() const {
    LoadOptions load;
    if (!lod.empty()) load.lod = lod;
    if (!crs.empty()) load.crs = crs;
    load.placement = {up, {origin[0], origin[1], origin[2]}};
    if (!bbox.empty()) {
        load.bbox = Box2d{{bbox[0], bbox[1]}, {bbox[2], bbox[3]}};
        if (!(bbox[0] < bbox[2] && bbox[1] < bbox[3]))
            throw InputError("--bbox is WEST,SOUTH,EAST,NORTH, with west below east and south below north.");
    }
    load.excluded = excluded;
    load.raster = raster;
    load.footprints = footprints;
    load.ground = ground;
    load.ground_margin_m = ground_margin_m;
    load.orthophotos = orthophotos;
    return load;
}

void add_city_options(CLI::App* verb, CityOptions& options, bool is_required) {
    static const std::map<std::string, GroundChoice> kGrounds{
        {"none", GroundChoice::none}, {"plane", GroundChoice::plane}, {"draped", GroundChoice::draped}};
    verb->add_option(
            "CITY", options.files,
            "city files: CityGML 1.0, 2.0, 3.0, CityJSON 1.0, 1.1, 2.0, CityJSONSeq, OBJ, glTF, GLB, b3dm, "
            "rasters of heights (GeoTIFF, ASCII grid), footprints (GeoPackage, GeoJSON, Shapefile); several make "
            "one city")
        ->required(is_required);
    verb->add_option("--lod", options.lod, "level of detail, such as 1.3 or 2.2 (default: the highest of each object)");
    static const std::map<std::string, io::UpAxis> kUps{{"y", io::UpAxis::y}, {"z", io::UpAxis::z}};
    verb->add_option("--crs", options.crs,
                     "coordinate reference system, such as EPSG:25832, instead of the files' own");
    verb->add_option("--up", options.up, "axis that points up in meshes: y or z (default z in OBJ, y in glTF)")
        ->transform(CLI::CheckedTransformer(kUps, CLI::ignore_case).description(""));
    verb->add_option("--origin", options.origin, "map coordinates X,Y,Z of a mesh's zero, metres (default 0,0,0)")
        ->delimiter(',')
        ->expected(3);
    verb->add_option("--bbox", options.bbox, "only what lies in WEST,SOUTH,EAST,NORTH, coordinates of the files")
        ->delimiter(',')
        ->expected(4);
    verb->add_option("--exclude", options.excluded, "ids of objects to leave out, with all below them")
        ->delimiter(',')
        ->allow_extra_args(false);
    static const std::map<std::string, io::RasterContent> kContents{{"terrain", io::RasterContent::terrain},
                                                                    {"surface", io::RasterContent::surface}};
    verb->add_option("--raster", options.raster.content,
                     "what rasters show: terrain, or surface with houses and trees (default terrain)")
        ->transform(CLI::CheckedTransformer(kContents, CLI::ignore_case).description(""));
    verb->add_option("--raster-error", options.raster.max_error_m,
                     "how far triangles may lie above or below a raster, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 100.0));
    verb->add_option("--height-field", options.footprints.height_field,
                     "attribute of footprints with the height above ground, metres (default: the known names)");
    verb->add_option("--storey", options.footprints.storey_m, "height of a storey of footprints, metres")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 20.0));
    verb->add_option(
            "--ground", options.ground,
            "ground for a city without: none, plane (level), draped (through the buildings' feet) (default none)")
        ->transform(CLI::CheckedTransformer(kGrounds, CLI::ignore_case).description(""));
    verb->add_option("--ground-margin", options.ground_margin_m, "how far added ground reaches beyond the city, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1e5));
    verb->add_option("--orthophoto", options.orthophotos,
                     "picture from above for ground without texture (GeoTIFF, or PNG, JPEG with a world file)")
        ->allow_extra_args(false);
}

}  // namespace skybake::cli
