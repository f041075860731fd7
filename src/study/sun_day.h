// One day of a study: when the sun counts, and where it stands.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/site.h"
#include "base/vec.h"
#include "sky/sun_path.h"
#include "sky/utc_time.h"

namespace skybake {

/// From when to when of a day a rule looks.
struct SunWindow {
    enum class Clock {
        daylight,       // from sunrise to sunset (sky/solar_events.h); start and end are not used
        civil,          // the time zone's clock, summer time included
        standard,       // the time zone's clock without summer time
        solar,          // true solar time: 12 when the sun is in the meridian
        after_sunrise,  // start: hours after sunrise; end: hours before sunset
    };
    Clock clock = Clock::daylight;
    double start_h = 0.0;
    double end_h = 24.0;
};

struct SunDayOptions {
    SunWindow window = {};
    double min_elevation_deg = 0.0;                      // geometric elevation below which the sun does not count
    std::optional<std::string> timezone = std::nullopt;  // IANA name; civil and standard clocks need it
};

/// A span of whole seconds after SunDay::begin.
struct DaySpan {
    int begin_s = 0;
    int end_s = 0;
};

/// The sun over the window of one day. Directions are tabulated every 10 s and interpolated: error below 10⁻⁷ rad.
class SunDay {
  public:
    /// Empty spans when the sun stays below the least elevation, or below the horizon, all through the window. The
    /// window is cut to sunrise and sunset. Throws InputError for a day that does not exist, a clock without time zone,
    /// a window that ends before it begins.
    SunDay(int year, CalendarDay day, const Site& site, double convergence_rad, const SunDayOptions& options);

    /// Unit vector to the sun's middle as it is seen (with refraction) in the world frame, `second` in [0, length()].
    /// In the minutes about sunrise and sunset in which only the upper limb shows it lies 0.05° above the horizon.
    Vec3f direction(double second) const;
    /// Geometric elevation, radians.
    double elevation_rad(double second) const;

    int length_s() const { return length_s_; }
    const std::vector<DaySpan>& spans() const { return spans_; }  // when the sun counts, to 1 s
    /// Their sum, hours.
    double hours() const;
    UtcTime begin() const { return begin_; }
    UtcTime time_of(double second) const;
    int year() const { return year_; }
    CalendarDay day() const { return day_; }

  private:
    int year_;
    CalendarDay day_;
    UtcTime begin_;
    int length_s_ = 0;
    std::vector<Vec3d> directions_;
    std::vector<double> elevations_rad_;
    std::vector<DaySpan> spans_;
};

}  // namespace skybake
