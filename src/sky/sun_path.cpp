#include "sky/sun_path.h"

#include <date/date.h>

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "sky/solar_position.h"

namespace skybake {

namespace {

constexpr std::int64_t kMinuteMs = 60'000;
constexpr std::int64_t kHourMs = 60 * kMinuteMs;
constexpr std::int64_t kDayMs = 24 * kHourMs;

SunPathPoint seen_at(std::int64_t ms, const Site& site) {
    const SolarPosition sun = solar_position(UtcTime{ms}, site);
    return {sun.azimuth_rad, sun.apparent_elevation_rad};
}

/// The parts of a way above the horizon, with ends where it crosses the horizon (linear between two points).
std::vector<SunPathLine> lines_above_horizon(const std::vector<SunPathPoint>& way) {
    std::vector<SunPathLine> lines;
    for (std::size_t i = 0; i < way.size(); ++i) {
        const bool is_up = way[i].elevation_rad >= 0.0;
        if (i > 0 && is_up != (way[i - 1].elevation_rad >= 0.0)) {
            const SunPathPoint& a = way[i - 1];
            const SunPathPoint& b = way[i];
            const double share = a.elevation_rad / (a.elevation_rad - b.elevation_rad);
            const double turn = std::remainder(b.azimuth_rad - a.azimuth_rad, 2.0 * kPi);
            const SunPathPoint horizon{a.azimuth_rad + share * turn, 0.0};
            if (is_up) lines.emplace_back();
            lines.back().push_back(horizon);
        }
        if (!is_up) continue;
        if (i == 0) lines.emplace_back();
        lines.back().push_back(way[i]);
    }
    return lines;
}

double noon_declination(int year, CalendarDay day, const Site& site) {
    return solar_position(local_mean_noon(year, day.month, day.day, site), site).declination_rad;
}

CalendarDay day_number(int year, CalendarDay first, int days_later) {
    const date::sys_days day = date::sys_days{date::year{year} / first.month / first.day} + date::days(days_later);
    const date::year_month_day ymd(day);
    return {static_cast<int>(static_cast<unsigned>(ymd.month())), static_cast<int>(static_cast<unsigned>(ymd.day()))};
}

/// The day among `count` ones from `first` on whose declination at noon is nearest to the given one.
CalendarDay nearest_day(int year, CalendarDay first, int count, double declination_rad, const Site& site) {
    CalendarDay nearest = first;
    double least = 10.0;
    for (int i = 0; i < count; ++i) {
        const CalendarDay day = day_number(year, first, i);
        const double apart = std::abs(noon_declination(year, day, site) - declination_rad);
        if (apart < least) {
            least = apart;
            nearest = day;
        }
    }
    return nearest;
}

}  // namespace

DayArc arc_of(UtcTime instant, const Site& site) {
    const std::int64_t number = local_solar_day(instant, site);
    const date::year_month_day ymd{date::sys_days{date::days(static_cast<int>(number))}};
    DayArc arc;
    arc.day = {static_cast<int>(static_cast<unsigned>(ymd.month())),
               static_cast<int>(static_cast<unsigned>(ymd.day()))};
    arc.kind = solar_events(instant, site).kind;
    const UtcTime noon = local_mean_noon(static_cast<int>(ymd.year()), arc.day.month, arc.day.day, site);
    std::vector<SunPathPoint> way;
    for (std::int64_t t = -12 * kHourMs; t <= 12 * kHourMs; t += 5 * kMinuteMs)
        way.push_back(seen_at(noon.milliseconds + t, site));
    arc.lines = lines_above_horizon(way);
    return arc;
}

std::vector<DayArc> year_arcs(int year, const Site& site) {
    const CalendarDay june = nearest_day(year, {6, 18}, 7, 0.5 * kPi, site);
    const CalendarDay december = nearest_day(year, {12, 18}, 7, -0.5 * kPi, site);
    const CalendarDay march = nearest_day(year, {3, 18}, 5, 0.0, site);
    std::vector<DayArc> arcs;
    for (const CalendarDay day :
         {december, CalendarDay{1, 21}, CalendarDay{2, 21}, march, CalendarDay{4, 21}, CalendarDay{5, 21}, june}) {
        arcs.push_back(arc_of(local_mean_noon(year, day.month, day.day, site), site));
        if (day == december || day == june) continue;
        arcs.back().twin = nearest_day(year, june, 184, noon_declination(year, day, site), site);
    }
    return arcs;
}

std::vector<HourLine> hour_lines(int year, const Site& site, std::optional<int> utc_offset_min) {
    const CalendarDay june = nearest_day(year, {6, 18}, 7, 0.5 * kPi, site);
    const CalendarDay december = nearest_day(year - 1, {12, 18}, 7, -0.5 * kPi, site);
    const std::int64_t winter = utc_midnight(year - 1, december.month, december.day).milliseconds;
    const std::int64_t summer = utc_midnight(year, june.month, june.day).milliseconds;
    const auto mean_solar_offset_ms =
        static_cast<std::int64_t>(std::llround(site.longitude_rad / (2.0 * kPi) * static_cast<double>(kDayMs)));
    const auto sun_at = [&](std::int64_t midnight, int hour) {
        if (utc_offset_min) return seen_at(midnight + hour * kHourMs - *utc_offset_min * kMinuteMs, site);
        const std::int64_t mean = midnight + hour * kHourMs - mean_solar_offset_ms;
        const double equation_min = solar_position(UtcTime{mean}, site).equation_of_time_min;
        return seen_at(mean - std::llround(equation_min * static_cast<double>(kMinuteMs)), site);
    };
    std::vector<HourLine> lines;
    for (int hour = 0; hour < 24; ++hour) {
        std::vector<SunPathPoint> spring;
        std::vector<SunPathPoint> autumn;
        for (std::int64_t day = winter; day < summer; day += 2 * kDayMs) spring.push_back(sun_at(day, hour));
        spring.push_back(sun_at(summer, hour));
        for (std::int64_t day = summer; day < winter + 365 * kDayMs; day += 2 * kDayMs)
            autumn.push_back(sun_at(day, hour));
        autumn.push_back(sun_at(winter + 365 * kDayMs, hour));
        lines.push_back({hour, lines_above_horizon(spring), lines_above_horizon(autumn)});
    }
    return lines;
}

double true_solar_time_h(UtcTime instant, const Site& site) {
    const double hours = 12.0 + solar_position(instant, site).hour_angle_rad * 12.0 / kPi;
    return hours >= 24.0 ? hours - 24.0 : hours;
}

}  // namespace skybake
