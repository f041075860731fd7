#include "city_options.h"

#include <map>

namespace skybake::cli {

LoadOptions CityOptions::load_options() const {
    LoadOptions load;
    if (!lod.empty()) load.lod = lod;
    if (!crs.empty()) load.crs = crs;
    load.placement = {up, {origin[0], origin[1], origin[2]}};
    load.ground = ground;
    load.ground_margin_m = ground_margin_m;
    return load;
}

void add_city_options(CLI::App* verb, CityOptions& options, bool is_required) {
    static const std::map<std::string, GroundChoice> kGrounds{
        {"none", GroundChoice::none}, {"plane", GroundChoice::plane}, {"draped", GroundChoice::draped}};
    verb->add_option("CITY", options.files,
                     "city files: CityGML 1.0, 2.0, 3.0, CityJSON 1.0, 1.1, 2.0, CityJSONSeq, OBJ; several make one "
                     "city")
        ->required(is_required);
    verb->add_option("--lod", options.lod, "level of detail, such as 1.3 or 2.2 (default: the highest of each object)");
    static const std::map<std::string, io::UpAxis> kUps{{"y", io::UpAxis::y}, {"z", io::UpAxis::z}};
    verb->add_option("--crs", options.crs,
                     "coordinate reference system, such as EPSG:25832, instead of the files' own");
    verb->add_option("--up", options.up, "axis that points up in OBJ files: y or z (default z)")
        ->transform(CLI::CheckedTransformer(kUps, CLI::ignore_case).description(""));
    verb->add_option("--origin", options.origin, "map coordinates X,Y,Z of an OBJ file's zero, metres (default 0,0,0)")
        ->delimiter(',')
        ->expected(3);
    verb->add_option(
            "--ground", options.ground,
            "ground for a city without: none, plane (level), draped (through the buildings' feet) (default none)")
        ->transform(CLI::CheckedTransformer(kGrounds, CLI::ignore_case).description(""));
    verb->add_option("--ground-margin", options.ground_margin_m, "how far added ground reaches beyond the city, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1e5));
}

}  // namespace skybake::cli
