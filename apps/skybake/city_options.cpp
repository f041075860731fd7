#include "city_options.h"

#include <map>

namespace skybake::cli {

LoadOptions CityOptions::load_options() const {
    LoadOptions load;
    if (!lod.empty()) load.lod = lod;
    load.ground = ground;
    load.ground_margin_m = ground_margin_m;
    return load;
}

void add_city_options(CLI::App* verb, CityOptions& options, bool is_required) {
    static const std::map<std::string, GroundChoice> kGrounds{
        {"none", GroundChoice::none}, {"plane", GroundChoice::plane}, {"draped", GroundChoice::draped}};
    verb->add_option("CITY", options.files, "city files: CityGML 1.0, 2.0, 3.0, CityJSON 1.0, 1.1, 2.0, CityJSONSeq; several make one city")
        ->required(is_required);
    verb->add_option("--lod", options.lod, "level of detail, such as 1.3 or 2.2 (default: the highest of each object)");
    verb->add_option(
            "--ground", options.ground,
            "ground for a city without: none, plane (level), draped (through the buildings' feet) (default none)")
        ->transform(CLI::CheckedTransformer(kGrounds, CLI::ignore_case).description(""));
    verb->add_option("--ground-margin", options.ground_margin_m, "how far added ground reaches beyond the city, metres")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1e5));
}

}  // namespace skybake::cli
