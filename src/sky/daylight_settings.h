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
};

/// The value of --sun: "point", "disc" or "none". Throws InputError.
SunShape parse_sun_shape(std::string_view text);
/// The value of --sun-direction: "AZ,EL" in degrees. Throws InputError.
SunDirection parse_sun_direction(std::string_view text);
/// The value of --site: "LAT,LON" in degrees, WGS 84, north and east positive. Throws InputError.
Site parse_site(std::string_view text);

/// One daylight for each instant, or one for the sun's direction, or one without sun. `convergence_rad` is the true
/// azimuth of grid north. Findings: SB601 a turbidity outside the usable range, SB602 a sun on or below the horizon,
/// SB603 the published level, SB604 no light at all, SB605 a weather outside of the Perez model. Throws InputError when
/// something is missing: a sun for the skies that need one, a site for the instants.
std::vector<Daylight> make_daylights(const DaylightSettings& settings, const std::optional<Site>& site,
                                     double convergence_rad, FindingLog& findings);

}  // namespace skybake
