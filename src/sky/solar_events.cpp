#include "sky/solar_events.h"

#include <cmath>

#include "sky/solar_position.h"

namespace skybake {

namespace {

constexpr std::int64_t kDayMs = 86'400'000;
// A stay above or below the horizon that fits between two steps is a grazing one, decided by refraction that nobody
// knows.
constexpr std::int64_t kStepMs = 10 * 60'000;

/// The moment in [begin, end] where `is_past` turns from false to true, by bisection to half a second.
template <typename IsPast>
UtcTime bisect(std::int64_t begin, std::int64_t end, const IsPast& is_past) {
    while (end - begin > 500) {
        const std::int64_t middle = begin + (end - begin) / 2;
        (is_past(middle) ? end : begin) = middle;
    }
    return UtcTime{begin + (end - begin) / 2};
}

/// Local mean solar time minus UTC.
std::int64_t mean_solar_offset_ms(const Site& site) {
    return std::llround(site.longitude_rad / (2.0 * kPi) * static_cast<double>(kDayMs));
}

}  // namespace

std::int64_t local_solar_day(UtcTime instant, const Site& site) {
    const std::int64_t local = instant.milliseconds + mean_solar_offset_ms(site);
    return local >= 0 ? local / kDayMs : -((-local + kDayMs - 1) / kDayMs);
}

UtcTime local_mean_noon(int year, int month, int day, const Site& site) {
    return UtcTime{utc_midnight(year, month, day).milliseconds + kDayMs / 2 - mean_solar_offset_ms(site)};
}

SolarEvents solar_events(UtcTime instant, const Site& site) {
    const double delta_t = delta_t_s(decimal_year(instant));
    const auto sun_at = [&](std::int64_t ms) { return solar_position(UtcTime{ms}, site, {.delta_t_s = delta_t}); };
    const double horizon_rad = radians_from_degrees(kSunriseElevationDeg);
    const auto is_up = [&](std::int64_t ms) { return sun_at(ms).geocentric_elevation_rad >= horizon_rad; };

    const std::int64_t begin = local_solar_day(instant, site) * kDayMs - mean_solar_offset_ms(site);
    SolarEvents events;
    // The equation of time keeps the transit within 17 minutes of the mean noon, where the hour angle rises through
    // zero.
    const std::int64_t noon = begin + kDayMs / 2;
    events.transit = bisect(noon - 30 * 60'000, noon + 30 * 60'000,
                            [&](std::int64_t ms) { return sun_at(ms).hour_angle_rad >= 0.0; });

    bool was_up = is_up(begin);
    const bool begins_up = was_up;
    for (std::int64_t t = begin; t < begin + kDayMs; t += kStepMs) {
        const bool will_be_up = is_up(t + kStepMs);
        if (will_be_up && !was_up && !events.sunrise) events.sunrise = bisect(t, t + kStepMs, is_up);
        if (!will_be_up && was_up) events.sunset = bisect(t, t + kStepMs, [&](std::int64_t ms) { return !is_up(ms); });
        was_up = will_be_up;
    }
    if (!events.sunrise && !events.sunset)
        events.kind = begins_up ? SolarDayKind::midnight_sun : SolarDayKind::polar_night;
    return events;
}

}  // namespace skybake
