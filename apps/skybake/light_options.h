// The settings of the light, the same in every verb that computes light.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/crown_settings.h"
#include "base/finding.h"
#include "base/rgb.h"
#include "base/site.h"
#include "sky/daylight_settings.h"

namespace skybake::cli {

inline constexpr const char* kDefaultSky = "preetham:turbidity=3,level=clearsky";

/// As typed; parsed by the functions below.
struct LightOptions {
    std::string at;
    std::string timezone;
    std::string site;
    std::string sun_direction;
    std::string sky = kDefaultSky;
    std::string weather;
    std::string sun = "point";
    int sky_samples = 1024;  // directions per texel
    std::string albedo;
    std::string crowns = "transparent";
    std::string leaves;                         // "on", "off" or empty
    std::optional<float> crown_transmissivity;  // 0…1
};

/// --at, --timezone, --site, --sun-direction, --sky and --weather.
void add_daylight_options(CLI::App* verb, LightOptions& options);
/// The above, and --sun, --sky-samples, --albedo and what trees are.
void add_light_options(CLI::App* verb, LightOptions& options);

/// Throws InputError for whatever is wrong with the options by themselves, so that a long run does not find it out
/// after reading the city.
void check_light_options(const LightOptions& options);

/// The options parsed, and the picture of an image sky read. Throws InputError.
DaylightSettings daylight_settings_of(const LightOptions& options);
CrownSettings crown_settings_of(const LightOptions& options);
/// --site, or else what the city's CRS says, if anything.
std::optional<Site> site_of(const LightOptions& options, const std::optional<Site>& site_from_crs);

/// The daylight of each instant. `convergence_rad` is the true azimuth of grid north. Throws InputError as
/// check_light_options does, and when
/// --at needs a site that neither --site nor the CRS gives.
std::vector<Daylight> daylights_of(const LightOptions& options, const std::optional<Site>& site_from_crs,
                                   double convergence_rad, FindingLog& findings);

/// --albedo: linear albedos 0…1 by the kind of surface ("roof", "wall", … as name_of(SurfaceType) has them), and
/// "default" for all that are not named. From "0.3", "R,G,B" (both for "default") or
/// "default=0.3,roof=0.4,0.2,0.1,ground=0.2". Empty for an empty text. Throws InputError.
std::vector<std::pair<std::string, Rgb>> parse_albedo(std::string_view text);

}  // namespace skybake::cli
