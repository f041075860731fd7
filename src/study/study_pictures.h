// What the pictures of a report show: maps, skies of chosen places, shadows at instants. As data; io/study draws it.
#pragma once

#include <string>
#include <vector>

#include "study/obstruction.h"
#include "study/plan_view.h"
#include "study/shadow_outline.h"
#include "study/study.h"

namespace skybake {

/// A map's ground: what stands where, and what of it is new.
struct MapGround {
    PlanView view;
    std::vector<char> is_planned;           // one an object of the scene
    std::vector<std::string> building_ids;  // likewise: the topmost parent
    std::vector<char> is_building;          // likewise
};

/// The sky of one sample, and its sun on the days of the rule.
struct SamplePlate {
    std::size_t sample = 0;
    std::string reason;  // "loses most", "nearest to the threshold", "worst", "chosen"
    Obstruction after;
    std::optional<Obstruction> before;
    std::vector<std::vector<SunInterval>> sunny;         // one list a day
    std::vector<std::vector<SunInterval>> sunny_before;  // likewise; empty without a former state
};

enum class ShadowKind : std::uint8_t {
    city,  // of everything
    plan,  // of what the plan brings, alone
    added  // where it was sunny before and is not any more
};
/// "city", "plan" or "new".
const char* name_of(ShadowKind kind);

/// A shadow at a whole hour.
struct HourShadow {
    std::size_t day = 0;  // index into Study::days
    int second = 0;       // after SunDay::begin
    std::string clock;    // "09:00"
    ShadowKind kind = ShadowKind::city;
    ShadowOutline outline;
};

struct StudyPictures {
    std::vector<MapGround> maps;  // all receivers; with a plan also its surroundings
    MapGround shadow_map;         // what the shadows reach
    std::vector<SamplePlate> plates;
    std::vector<HourShadow> shadows;  // by day, time and kind
    double shadow_spacing_m = 1.0;
    bool has_solar_clock = false;  // HourShadow::clock is true solar time, else that of the time zone
};

/// The whole hours within the day's spans: by the time zone's clock where there is one, else by true solar time.
struct WholeHour {
    int second = 0;
    std::string clock;
};
std::vector<WholeHour> whole_hours(const SunDay& day, const Site& site, const std::optional<std::string>& timezone);

}  // namespace skybake
