#include "study/sun_day.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sky/solar_events.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

constexpr int kTableStepS = 10;
constexpr double kHourMs = 3600e3;
constexpr double kLowestRad = 0.05 * kPi / 180.0;

UtcTime after(UtcTime t, double ms) {
    return {t.milliseconds + std::llround(ms)};
}

std::string clock_text(int year, CalendarDay day, double hour) {
    const int minutes = static_cast<int>(std::lround(hour * 60.0));
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}", year, day.month, day.day, minutes / 60, minutes % 60);
}

UtcTime by_clock(int year, CalendarDay day, double hour, const Site& site, const SunDayOptions& options) {
    switch (options.window.clock) {
        case SunWindow::Clock::civil:
            return parse_instant(clock_text(year, day, hour), options.timezone).utc;
        case SunWindow::Clock::standard:
            return after(utc_midnight(year, day.month, day.day),
                         hour * kHourMs - 60e3 * standard_utc_offset_min(year, *options.timezone));
        default: {
            const UtcTime mean = after(local_mean_noon(year, day.month, day.day, site), (hour - 12.0) * kHourMs);
            return after(mean, -60e3 * solar_position(mean, site).equation_of_time_min);
        }
    }
}

std::pair<UtcTime, UtcTime> window_of(int year, CalendarDay day, const Site& site, const SunDayOptions& options) {
    using Clock = SunWindow::Clock;
    const SunWindow& window = options.window;
    if ((window.clock == Clock::civil || window.clock == Clock::standard) && !options.timezone)
        throw InputError("the rule's window is by the clock: pass --timezone, such as Europe/Vienna.");
    const UtcTime noon = local_mean_noon(year, day.month, day.day, site);
    const SolarEvents events = solar_events(noon, site);
    if (events.kind == SolarDayKind::polar_night) return {noon, noon};
    const UtcTime sunrise = events.sunrise.value_or(after(noon, -12.0 * kHourMs));
    const UtcTime sunset = events.sunset.value_or(after(noon, 12.0 * kHourMs));
    if (window.clock == Clock::daylight) return {sunrise, sunset};
    if (window.clock == Clock::after_sunrise)
        return {after(sunrise, window.start_h * kHourMs), after(sunset, -window.end_h * kHourMs)};
    if (!(window.start_h < window.end_h))
        throw InputError(
            fmt::format("the window ends at {} h, before it begins at {} h.", window.end_h, window.start_h));
    return {std::max(sunrise, by_clock(year, day, window.start_h, site, options)),
            std::min(sunset, by_clock(year, day, window.end_h, site, options))};
}

}  // namespace

SunDay::SunDay(int year, CalendarDay day, const Site& site, double convergence_rad, const SunDayOptions& options)
    : year_(year), day_(day) {
    const auto [begin, end] = window_of(year, day, site, options);
    begin_ = begin;
    length_s_ =
        std::max(0, static_cast<int>(std::lround(static_cast<double>(end.milliseconds - begin.milliseconds) / 1e3)));
    const double delta_t = delta_t_s(decimal_year(begin));
    for (int s = 0; s < length_s_ + kTableStepS; s += kTableStepS) {
        const SolarPosition sun = solar_position(after(begin, 1e3 * s), site, {.delta_t_s = delta_t});
        directions_.push_back(
            world_direction(sun.azimuth_rad, std::max(sun.apparent_elevation_rad, kLowestRad), convergence_rad));
        elevations_rad_.push_back(sun.elevation_rad);
    }
    // A least elevation of 0 asks for no more than the day from sunrise to sunset, which is the upper limb's.
    const double least_rad = options.min_elevation_deg > 0.0 ? radians_from_degrees(options.min_elevation_deg) : -1.0;
    for (int s = 0; s < length_s_; ++s) {
        if (elevation_rad(s + 0.5) < least_rad) continue;
        if (spans_.empty() || spans_.back().end_s != s) spans_.push_back({s, s});
        spans_.back().end_s = s + 1;
    }
}

Vec3f SunDay::direction(double second) const {
    const std::size_t i = std::min(static_cast<std::size_t>(second / kTableStepS), directions_.size() - 2);
    const double share = second / kTableStepS - static_cast<double>(i);
    return Vec3f(glm::normalize((1.0 - share) * directions_[i] + share * directions_[i + 1]));
}

double SunDay::elevation_rad(double second) const {
    const std::size_t i = std::min(static_cast<std::size_t>(second / kTableStepS), elevations_rad_.size() - 2);
    const double share = second / kTableStepS - static_cast<double>(i);
    return (1.0 - share) * elevations_rad_[i] + share * elevations_rad_[i + 1];
}

double SunDay::hours() const {
    double seconds = 0.0;
    for (const DaySpan& span : spans_) seconds += span.end_s - span.begin_s;
    return seconds / 3600.0;
}

UtcTime SunDay::time_of(double second) const {
    return after(begin_, 1e3 * second);
}

}  // namespace skybake
