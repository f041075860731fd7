// Sunrise, noon and sunset of one local solar day.
#pragma once

#include <optional>

#include "base/site.h"
#include "sky/utc_time.h"

namespace skybake {

enum class SolarDayKind { normal, midnight_sun, polar_night };

struct SolarEvents {
    SolarDayKind kind = SolarDayKind::normal;
    UtcTime transit;  // the sun in the meridian, highest of the day
    std::optional<UtcTime> sunrise;
    std::optional<UtcTime> sunset;
};

/// The sun's elevation at rise and set, by convention: its upper limb on a sea horizon with mean refraction. Degrees.
inline constexpr double kSunriseElevationDeg = -0.8333;

/// Rise, transit and set of the local solar day `year`-`month`-`day`: the 24 hours of local mean solar time that begin
/// at its midnight (not of the clock, nor of UTC). The geocentric elevation without parallax crosses
/// kSunriseElevationDeg; the site's height does not count, nor do hills and houses. Accuracy 1 s of the geometry; real
/// refraction moves sunrise by a minute. On a day with two crossings of one kind (near the poles' circles) the first
/// rise and the last set count. Throws InputError for a day that does not exist.
SolarEvents solar_events(int year, int month, int day, const Site& site);

}  // namespace skybake
