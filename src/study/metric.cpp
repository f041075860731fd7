#include "study/metric.h"

#include <algorithm>
#include <array>

namespace skybake {
namespace {

constexpr double kSecondH = 1.0 / 3600.0;
constexpr std::array<MetricTraits, kMetricCount> kTraits{
    {{"sun_hours", "h", 2, 60 * kSecondH, 4 * kSecondH, true},
     {"longest_sun_hours", "h", 2, 60 * kSecondH, 4 * kSecondH, true},
     {"shadow_hours", "h", 2, 60 * kSecondH, 4 * kSecondH, false},
     {"longest_shadow_hours", "h", 2, 60 * kSecondH, 4 * kSecondH, false},
     {"new_shadow_hours", "h", 2, 60 * kSecondH, 4 * kSecondH, false},
     {"sky_view_factor", "1", 3, 0.002, 0.001, true},
     {"sky_component_pct", "%", 1, 0.2, 0.1, true},
     {"sunshine_pct", "%", 1, 0.2, 0.1, true},
     {"winter_sunshine_pct", "%", 1, 0.2, 0.1, true},
     {"beam_kwh_m2", "kWh/m2", 0, 1.0, 1.0, true},
     {"sky_kwh_m2", "kWh/m2", 0, 1.0, 1.0, true},
     {"irradiation_kwh_m2", "kWh/m2", 0, 1.0, 1.0, true},
     {"indirect_kwh_m2", "kWh/m2", 0, 1.0, 5.0, true},
     {"reflected_kwh_m2", "kWh/m2", 0, 1.0, 1.0, true},
     {"light_incidence_deg", "deg", 0, 1.0, 1.0, false},
     {"sun_lx", "lx", 0, 100.0, 100.0, true},
     {"sky_lx", "lx", 0, 100.0, 100.0, true},
     {"indirect_lx", "lx", 0, 100.0, 500.0, true},
     {"illuminance_lx", "lx", 0, 100.0, 500.0, true}}};

}  // namespace

const MetricTraits& traits_of(Metric metric) {
    return kTraits[static_cast<std::size_t>(metric)];
}

std::optional<Metric> metric_of(std::string_view name) {
    const auto found =
        std::find_if(kTraits.begin(), kTraits.end(), [&](const MetricTraits& traits) { return traits.name == name; });
    if (found == kTraits.end()) return std::nullopt;
    return static_cast<Metric>(found - kTraits.begin());
}

}  // namespace skybake
