// What the user asks of the light, and the daylight that follows from it.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/finding.h"
#include "base/site.h"
#include "sky/daylight.h"
#include "sky/sky_settings.h"
#include "sky/utc_time.h"
#include "sky/weather.h"

namespace skybake {

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
/// SB603 the published level, SB604 no light at all, SB605 a weather outside of the Perez model. Throws InputError when
/// something is missing: a sun for the skies that need one, a site for the instants.
std::vector<Daylight> make_daylights(const DaylightSettings& settings, const std::optional<Site>& known_site,
                                     double convergence_rad, FindingLog& findings);

}  // namespace skybake
