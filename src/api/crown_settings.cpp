#include "api/crown_settings.h"

#include <chrono>

#include "base/error.h"

namespace skybake {

namespace {

bool is_month_in_leaf(UtcTime time, bool is_south) {
    const std::chrono::sys_time<std::chrono::milliseconds> when{std::chrono::milliseconds(time.milliseconds)};
    const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(when));
    const bool is_northern_summer = day.month() >= std::chrono::May && day.month() <= std::chrono::October;
    return is_northern_summer != is_south;
}

float transmissivity_of_season(const std::optional<bool>& is_in_leaf, const DaylightSettings& daylight,
                               const std::optional<Site>& site) {
    bool in_leaf = is_in_leaf.value_or(true);
    if (!is_in_leaf && !daylight.instants.empty()) {
        const bool is_south = site && site->latitude_rad < 0.0;
        in_leaf = is_month_in_leaf(daylight.instants.front().utc, is_south);
        for (const Instant& instant : daylight.instants) {
            if (is_month_in_leaf(instant.utc, is_south) != in_leaf)
                throw InputError(
                    "--at: trees have leaves at some of these instants and none at others. Bake the two seasons apart, "
                    "or "
                    "write --leaves on or --leaves off for all of them.");
        }
    }
    return in_leaf ? kTransmissivityInLeaf : kTransmissivityBare;
}

}  // namespace

void apply_crown_settings(const CrownSettings& settings, const DaylightSettings& daylight,
                          const std::optional<Site>& site, SceneOptions& options) {
    options.crowns = settings.treatment;
    options.crown_transmissivity = settings.transmissivity
                                       ? *settings.transmissivity
                                       : transmissivity_of_season(settings.is_in_leaf, daylight, site);
}

}  // namespace skybake
