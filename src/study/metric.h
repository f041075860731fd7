// What can be computed at a sample.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace skybake {

/// Units in the name, as rules and tables write it.
enum class Metric : std::uint8_t {
    sun_hours,             // of the window
    longest_sun_hours,     // without a break
    shadow_hours,          // of the window
    longest_shadow_hours,  // without a break
    new_shadow_hours,      // sunny before the plan and not after it
    sky_view_factor,
    sky_component_pct,  // "VSC" on a wall: of the CIE overcast sky
    sunshine_pct,       // "APSH": of the year's expected sunshine
    winter_sunshine_pct,
    beam_kwh_m2,
    sky_kwh_m2,
    irradiation_kwh_m2,  // beam and sky
    indirect_kwh_m2,     // reflected by the city, any number of times (light/path_reference.h)
    reflected_kwh_m2,    // by open level ground: StudySettings::ground_albedo
    light_incidence_deg,
    sun_lx,  // at instants, from here on
    sky_lx,
    indirect_lx,
    illuminance_lx  // the three together
};
inline constexpr int kMetricCount = 19;

struct MetricTraits {
    const char* name;          // "sun_hours", …
    const char* unit;          // as tables write it: "h", "%", "1", "kWh/m2", "deg", "lx"
    int decimals;              // that it is told with
    double least_change;       // differences below it are none: crossings are right to a second, shares to sampling
    double honest_difference;  // of two honest runs, on another processor or with another version of a library: two
                               // crossings of 2 s each; shares and energy by what a few rays along edges make
    bool prefers_more;         // more is better for who wants sun and sky
};
const MetricTraits& traits_of(Metric metric);

inline const char* name_of(Metric metric) {
    return traits_of(metric).name;
}
/// None for an unknown name.
std::optional<Metric> metric_of(std::string_view name);

/// Hangs on the rule's days.
inline bool is_of_days(Metric metric) {
    return metric <= Metric::new_shadow_hours;
}
/// Sums of a weather file.
inline bool is_energy(Metric metric) {
    return metric >= Metric::beam_kwh_m2 && metric <= Metric::reflected_kwh_m2;
}
/// Needs a YearLight.
inline bool is_of_year(Metric metric) {
    return metric >= Metric::sunshine_pct && metric <= Metric::reflected_kwh_m2;
}
/// Hangs on instants.
inline bool is_of_instants(Metric metric) {
    return metric >= Metric::sun_lx;
}
/// Needs what surfaces reflect.
inline bool is_reflected(Metric metric) {
    return metric == Metric::indirect_kwh_m2 || metric == Metric::indirect_lx || metric == Metric::illuminance_lx;
}

}  // namespace skybake
