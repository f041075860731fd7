// The sun's ways over the sky of a site: the arcs of days and the lines of hours that a sun-path diagram is made of.
#pragma once

#include <optional>
#include <vector>

#include "base/site.h"
#include "sky/solar_events.h"
#include "sky/utc_time.h"

namespace skybake {

/// Where the sun is seen (with refraction); radians, azimuth clockwise from true north.
struct SunPathPoint {
    double azimuth_rad = 0.0;
    double elevation_rad = 0.0;
};

/// A connected part of a way that lies above the horizon; ends there are at elevation 0.
using SunPathLine = std::vector<SunPathPoint>;

struct CalendarDay {
    int month = 1;
    int day = 1;
    friend constexpr bool operator==(CalendarDay, CalendarDay) = default;
};

/// The sun's way over one local solar day, every five minutes.
struct DayArc {
    CalendarDay day;
    std::optional<CalendarDay> twin;  // the day of the year's other half whose noon declination is nearest: the same
                                      // arc to half a degree
    SolarDayKind kind = SolarDayKind::normal;
    std::vector<SunPathLine> lines;
};

/// The seven arcs between the solstices of a year, from December to June: the solstices, the equinox of March, and the
/// 21st of the months between them, each but the solstices with its twin.
std::vector<DayArc> year_arcs(int year, const Site& site);

/// The arc of the local solar day that holds the instant; without twin, its calendar day that of the solar day.
DayArc arc_of(UtcTime instant, const Site& site);

/// The sun at one hour on all days of a year, in two halves, as the same hour of two days with equal declination
/// differs by the equation of time.
struct HourLine {
    int hour = 0;
    std::vector<SunPathLine> spring;  // December's solstice to June's
    std::vector<SunPathLine> autumn;  // June's to December's
};

/// The 24 hours of a clock that stands still all year, `utc_offset_min` east of UTC; or, without that, of true solar
/// time, where both halves are nearly the same. Every two days.
std::vector<HourLine> hour_lines(int year, const Site& site, std::optional<int> utc_offset_min);

/// True solar time, hours in [0, 24): 12 when the sun is in the meridian.
double true_solar_time_h(UtcTime instant, const Site& site);

}  // namespace skybake
