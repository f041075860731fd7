// CITY… and how to read it: the same in every verb that takes a city.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "api/load_city.h"

namespace skybake::cli {

struct CityOptions {
    std::vector<std::filesystem::path> files;
    std::string lod;  // empty: the highest of each object
    std::string crs;  // empty: what the files name
    io::UpAxis up = io::UpAxis::z;
    std::vector<double> origin{0.0, 0.0, 0.0};
    GroundChoice ground = GroundChoice::none;
    double ground_margin_m = 30.0;

    LoadOptions load_options() const;
};

/// Adds the positional CITY…, --lod, --crs, --up, --origin, --ground and --ground-margin; `options` must outlive the
/// parsing.
void add_city_options(CLI::App* verb, CityOptions& options, bool is_required = true);

}  // namespace skybake::cli
