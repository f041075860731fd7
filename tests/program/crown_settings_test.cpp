// Which season's trees a bake takes.
#include "api/crown_settings.h"

#include <gtest/gtest.h>

#include "base/vec.h"
#include "error_of.h"

namespace skybake {
namespace {

DaylightSettings at(std::string_view times) {
    DaylightSettings daylight;
    daylight.instants = parse_instants(times, std::nullopt);
    return daylight;
}

float transmissivity(const CrownSettings& settings, std::string_view times, double latitude_deg = 48.0) {
    SceneOptions options;
    apply_crown_settings(settings, at(times), Site{latitude_deg * kPi / 180.0, 0.0, 0.0}, options);
    EXPECT_EQ(options.crowns, CrownTreatment::transparent);
    return options.crown_transmissivity;
}

TEST(CrownSettings, SeasonByTheInstants) {
    EXPECT_EQ(transmissivity({}, "2026-05-01T12:00Z"), kTransmissivityInLeaf);
    EXPECT_EQ(transmissivity({}, "2026-10-31T12:00Z"), kTransmissivityInLeaf);
    EXPECT_EQ(transmissivity({}, "2026-11-01T12:00Z"), kTransmissivityBare);
    EXPECT_EQ(transmissivity({}, "2026-04-30T12:00Z"), kTransmissivityBare);
    EXPECT_EQ(transmissivity({}, "2026-06-21T12:00Z", -35.0), kTransmissivityBare);
    EXPECT_EQ(transmissivity({}, "2026-12-21T12:00Z", -35.0), kTransmissivityInLeaf);
}

TEST(CrownSettings, SeasonAsStated) {
    EXPECT_EQ(transmissivity({.is_in_leaf = true, .transmissivity = {}}, "2026-12-21T12:00Z"), kTransmissivityInLeaf);
    EXPECT_EQ(transmissivity({.is_in_leaf = {}, .transmissivity = 0.2f}, "2026-12-21T12:00Z,2026-06-21T12:00Z"), 0.2f);
}

TEST(CrownSettings, BothSeasonsAtOnceAreRefused) {
    SceneOptions options;
    const std::string error =
        error_of([&] { apply_crown_settings({}, at("2026-12-21T12:00Z,2026-06-21T12:00Z"), std::nullopt, options); });
    EXPECT_NE(error.find("--leaves"), std::string::npos) << error;
}

}  // namespace
}  // namespace skybake
