// What the user asks of the light, and the daylight that follows from it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/finding.h"
#include "base/site.h"
#include "sky/daylight.h"
#include "sky/utc_time.h"
#include "sky/weather.h"

namespace skybake {

/// Where the Preetham sky takes its absolute level from.
enum class SkyLevel {
    clearsky,   // the diffuse irradiance of a clear sky of the same turbidity (sky/clear_sky.h)
    published,  // the paper's own zenith luminance
    dhi         // a diffuse horizontal irradiance that the user gives
};

/// Turbidity of the sun's beam where the sky model has none of its own.
inline constexpr double kDefaultTurbidity = 3.0;

struct NoSkySettings {
    double turbidity = kDefaultTurbidity;  // of the beam only
};
struct UniformSkySettings {
    double luminance_cd_m2 = 1000.0;
    double turbidity = kDefaultTurbidity;  // of the beam only
};
struct PreethamSettings {
    double turbidity = kDefaultTurbidity;
    SkyLevel level = SkyLevel::clearsky;
    double dhi_w_m2 = 0.0;  // for SkyLevel::dhi
};
using SkySettings = std::variant<PreethamSettings, UniformSkySettings, NoSkySettings>;

/// Angles in radians; azimuth clockwise from true north, elevation above the horizon as the sun is seen.
struct SunDirection {
    double azimuth_rad = 0.0;
    double elevation_rad = 0.0;
};

struct DaylightSettings {
    SkySettings sky;
    SunShape sun = SunShape::point;
    std::vector<Instant> instants;              // with a site, or
    std::optional<SunDirection> sun_direction;  // instead of them
    // Level of sky and beam by the instants' weather, instead of a clear day's; what was found in it is told with the
    // daylight.
    std::optional<Weather> weather;
    FindingLog weather_findings;
};

/// The value of --sky: "preetham:turbidity=3,level=clearsky|published|dhi=W", "uniform:luminance=CD_M2", "none"; the
/// last two take a turbidity for the beam. Throws InputError for unknown models (saying which there are), unknown keys
/// (naming the nearest) and values out of range.
SkySettings parse_sky(std::string_view text);
/// The same settings written out whole, as parse_sky reads them: for manifests.
std::string to_text(const SkySettings& sky);

/// The value of --sun: "point", "disc" or "none". Throws InputError.
SunShape parse_sun_shape(std::string_view text);
/// The value of --sun-direction: "AZ,EL" in degrees. Throws InputError.
SunDirection parse_sun_direction(std::string_view text);
/// The value of --site: "LAT,LON" in degrees, WGS 84, north and east positive. Throws InputError.
Site parse_site(std::string_view text);

/// The sky of an instant (by its number in the settings), its level set by the weather if there is any. Throws
/// InputError when the weather file has no radiation for the instant.
SkySettings sky_at(const DaylightSettings& settings, std::size_t instant);

/// The place of the light: the site that is known otherwise, or else that of the weather file.
std::optional<Site> site_of_light(const DaylightSettings& settings, const std::optional<Site>& site);

/// One daylight for each instant, or one for the sun's direction, or one without sun. `convergence_rad` is the true
/// azimuth of grid north. Findings: SB601 a turbidity outside the usable range, SB602 a sun on or below the horizon,
/// SB603 the published level, SB604 no light at all; with weather, those of the file, SB711 and SB712 its place, SB713
/// its missing leap day. Throws InputError when something is missing: a sun for the Preetham sky, a site for the
/// instants, the instants' weather.
std::vector<Daylight> make_daylights(const DaylightSettings& settings, const std::optional<Site>& known_site,
                                     double convergence_rad, FindingLog& findings);

}  // namespace skybake
