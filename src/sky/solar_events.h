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

/// Rise, transit and set of the local solar day that holds the instant: the 24 hours of local mean solar time from its
/// midnight on (not of the clock, nor of UTC). The geocentric elevation without parallax crosses kSunriseElevationDeg;
/// the site's height does not count, nor do hills and houses. Accuracy 1 s of the geometry; real refraction moves
/// sunrise by a minute. On a day with two crossings of one kind (near the polar circles) the first rise and the last
/// set count. Costs about 1 ms.
SolarEvents solar_events(UtcTime instant, const Site& site);

/// The number of the local solar day that holds the instant, counted from 1970-01-01: the same for all instants with
/// the same events.
std::int64_t local_solar_day(UtcTime instant, const Site& site);

/// The moment of local mean noon of a calendar day. Throws InputError for a day that does not exist.
UtcTime local_mean_noon(int year, int month, int day, const Site& site);

}  // namespace skybake
