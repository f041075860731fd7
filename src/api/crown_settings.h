// How trees dim light at the instants of a bake or a probe.
#pragma once

#include <optional>

#include "base/site.h"
#include "scene/scene.h"
#include "sky/daylight_settings.h"

namespace skybake {

struct CrownSettings {
    CrownTreatment treatment = CrownTreatment::transparent;
    std::optional<bool>
        is_in_leaf;  // without it by the instants: May to October, south of the equator November to April
    std::optional<float> transmissivity;  // along a crown's mean chord, instead of that of the season
};

/// Puts them into the options of the scene. Without instants trees are in leaf. Throws InputError when the instants are
/// of both seasons and neither of the two settings says which one to take.
void apply_crown_settings(const CrownSettings& settings, const DaylightSettings& daylight,
                          const std::optional<Site>& site, SceneOptions& options);

}  // namespace skybake
