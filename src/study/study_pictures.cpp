#include "study/study_pictures.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "sky/solar_events.h"

namespace skybake {

const char* name_of(ShadowKind kind) {
    switch (kind) {
        case ShadowKind::city:
            return "city";
        case ShadowKind::plan:
            return "plan";
        case ShadowKind::added:
            return "new";
    }
    return "";
}

std::vector<WholeHour> whole_hours(const SunDay& day, const Site& site, const std::optional<std::string>& timezone) {
    const CalendarDay date = day.day();
    const UtcTime noon = local_mean_noon(day.year(), date.month, date.day, site);
    const std::int64_t transit = solar_events(noon, site).transit.milliseconds;
    std::vector<WholeHour> hours;
    for (int hour = 0; hour < 24; ++hour) {
        const std::string clock = fmt::format("{:02}:00", hour);
        std::int64_t time = transit + (hour - 12) * 3'600'000;
        if (timezone) {
            try {
                time = parse_instant(fmt::format("{:04}-{:02}-{:02}T{}", day.year(), date.month, date.day, clock),
                                     timezone)
                           .utc.milliseconds;
            } catch (const InputError&) {
                continue;  // an hour that the switch to or from summer time skips or repeats: at night
            }
        }
        const int second = static_cast<int>(std::lround(1e-3 * static_cast<double>(time - day.begin().milliseconds)));
        for (const DaySpan& span : day.spans()) {
            if (second >= span.begin_s && second <= span.end_s) {
                hours.push_back({second, clock});
                break;
            }
        }
    }
    return hours;
}

}  // namespace skybake
