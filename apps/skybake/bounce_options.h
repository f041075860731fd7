// The settings of reflected light, the same in every verb that computes it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/bake_lightmaps.h"
#include "light/path_reference.h"

namespace skybake::cli {

enum class Indirect { none, photons, reference };

/// As typed; `indirect` is read by indirect_of.
struct BounceOptions {
    std::string indirect = "none";
    int bounces = 8;
    int paths = 1024;                      // per point, of the reference
    std::optional<std::uint64_t> photons;  // without: 40 a square metre of surface

    int nearest = 200;
    std::string area{kPhotonAreaNames[0]};
    int feelers = 8;
};

/// --indirect, --bounces, --photons, --nearest, --area, --feelers and --paths.
void add_bounce_options(CLI::App* verb, BounceOptions& options);

/// Throws InputError for a method that there is not, naming the nearest.
Indirect indirect_of(const BounceOptions& options);

/// What decides the reflected light, by the names of the options: for the manifest.
std::vector<std::pair<std::string, std::string>> settings_of(const BounceOptions& options);

BouncePhotons photons_of(const BounceOptions& options, std::uint64_t seed);
PathOptions path_options_of(const BounceOptions& options, std::uint64_t seed);

}  // namespace skybake::cli
