// CITY… and how to read it: the same in every verb that takes a city.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/load_city.h"

namespace skybake::cli {

struct CityOptions {
    std::vector<std::filesystem::path> files;
    std::string lod;  // empty: the highest of each object
    std::string crs;  // empty: what the files name
    std::optional<io::UpAxis> up;
    std::vector<double> origin{0.0, 0.0, 0.0};
    std::vector<double> bbox;  // west, south, east, north; empty: all
    std::vector<std::string> excluded;
    io::RasterOptions raster;
    io::FootprintOptions footprints;
    GroundChoice ground = GroundChoice::none;
    double ground_margin_m = 30.0;
    std::vector<std::filesystem::path> orthophotos;

    LoadOptions load_options() const;
};

/// Adds the positional CITY…, --lod, --crs, --up, --origin, --bbox, --exclude, --raster…, --height-field, --storey,
/// --ground, --ground-margin and --orthophoto; `options` must outlive the parsing.
void add_city_options(CLI::App* verb, CityOptions& options, bool is_required = true);

}  // namespace skybake::cli
