#include "io/study/sky_plate.h"

#include <fmt/format.h>

#include "io/svg/sun_diagram.h"

namespace skybake::io {
namespace {

constexpr const char* kHidden = "#c4c4c4";
constexpr const char* kBehind = "#9aa0a6";
constexpr const char* kNewlyHidden = "#f4a582";

/// Runs of cells of one azimuth as patches.
template <typename IsIn>
SkyShade shade(const char* colour, const IsIn& is_in) {
    SkyShade result{colour, {}};
    constexpr double kAzimuth = 2.0 * kPi / Obstruction::kAzimuths, kElevation = 0.5 * kPi / Obstruction::kElevations;
    for (int a = 0; a < Obstruction::kAzimuths; ++a) {
        for (int e = 0; e < Obstruction::kElevations;) {
            if (!is_in(a, e)) {
                ++e;
                continue;
            }
            const int begin = e;
            while (e < Obstruction::kElevations && is_in(a, e)) ++e;
            result.patches.push_back({a * kAzimuth, (a + 1) * kAzimuth, begin * kElevation, e * kElevation});
        }
    }
    return result;
}

}  // namespace

std::string clock_of(UtcTime time, const std::optional<std::string>& timezone) {
    // To the nearest minute.
    const UtcTime rounded{(time.milliseconds + 30'000) / 60'000 * 60'000};
    return to_iso8601({rounded, timezone ? utc_offset_min(rounded, *timezone) : 0}).substr(11, 5);
}

std::string sunny_times(const std::vector<SunInterval>& sunny, const SunDay& day,
                        const std::optional<std::string>& timezone) {
    std::string text;
    for (const SunInterval& interval : sunny) {
        if (!text.empty()) text += ", ";
        text += fmt::format("{}–{}", clock_of(day.time_of(static_cast<double>(interval.begin_s)), timezone),
                            clock_of(day.time_of(static_cast<double>(interval.end_s)), timezone));
    }
    return text.empty() ? "–" : text;
}

std::string sky_plate_svg(const SamplePlate& plate, const Study& study, const StudySettings& settings,
                          const std::string& title, const Words& words) {
    using Cell = Obstruction::Cell;
    SunDiagram diagram;
    diagram.title = title;
    diagram.projection = DomeProjection::equidistant;
    diagram.days = year_arcs(settings.year, settings.site);
    for (const SunDay& day : study.days)
        diagram.chosen_days.push_back(
            arc_of(local_mean_noon(day.year(), day.day().month, day.day().day, settings.site), settings.site));
    std::optional<int> clock;
    if (settings.timezone) clock = standard_utc_offset_min(settings.year, *settings.timezone);
    diagram.hours = hour_lines(settings.year, settings.site, clock);
    const auto was_free = [&](int a, int e) { return plate.before && plate.before->at(a, e) == Cell::free; };
    diagram.shades.push_back(shade(kBehind, [&](int a, int e) { return plate.after.at(a, e) == Cell::behind; }));
    diagram.shades.push_back(
        shade(kHidden, [&](int a, int e) { return plate.after.at(a, e) == Cell::hidden && !was_free(a, e); }));
    diagram.shades.push_back(
        shade(kNewlyHidden, [&](int a, int e) { return plate.after.at(a, e) == Cell::hidden && was_free(a, e); }));
    diagram.notes = {
        clock ? words("Hours of standard time (no summer time); equidistant projection, north up.",
                      "Stunden der Normalzeit (ohne Sommerzeit); mittabstandstreue Projektion, Norden oben.")
              : words("Hours of true solar time; equidistant projection, north up.",
                      "Stunden wahrer Ortszeit; mittabstandstreue Projektion, Norden oben."),
        plate.before ? words("Grey: hidden as before. Red: hidden by the plan. Darker grey: behind the own wall.",
                             "Grau: verdeckt wie zuvor. Rot: vom Vorhaben verdeckt. Dunkler: hinter der eigenen Wand.")
                     : words("Grey: hidden. Darker grey: behind the own wall.",
                             "Grau: verdeckt. Dunkler: hinter der eigenen Wand.")};
    std::string svg = sun_diagram_svg(diagram);
    // In a page the picture needs no head of its own.
    return svg.substr(svg.find("<svg"));
}

}  // namespace skybake::io
