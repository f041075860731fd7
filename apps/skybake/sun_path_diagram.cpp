#include "sun_path_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/nearest_word.h"
#include "sky/solar_position.h"
#include "sky/sun_path.h"

namespace skybake::cli {

namespace {

io::DomeProjection projection_of(const std::string& name) {
    const std::vector<std::string> known = {"stereographic", "equidistant", "orthographic"};
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (known[i] == name) return static_cast<io::DomeProjection>(i);
    }
    throw InputError(fmt::format("--projection '{}' is unknown; did you mean '{}'?", name, nearest_word(name, known)));
}

std::string offset_text(int utc_offset_min) {
    if (utc_offset_min == 0) return "UTC";
    return fmt::format("UTC{}{:02}:{:02}", utc_offset_min < 0 ? "−" : "+", std::abs(utc_offset_min) / 60,
                       std::abs(utc_offset_min) % 60);
}

std::string degrees_text(double radians, const char* positive, const char* negative) {
    return fmt::format("{:.4f}° {}", std::abs(degrees_from_radians(radians)), radians < 0.0 ? negative : positive);
}

/// The offset of the clock whose hours are drawn; none: true solar time.
std::optional<int> clock_of(const DiagramOptions& options, const DaylightSettings& settings, int year,
                            const std::string& timezone) {
    if (!options.hours.empty() && options.hours != "clock" && options.hours != "solar")
        throw InputError(fmt::format("--diagram-hours '{}' is unknown; it is clock or solar.", options.hours));
    if (options.hours == "solar") return std::nullopt;
    const std::vector<Instant>& instants = settings.instants;
    const bool is_one_clock =
        !instants.empty() && std::all_of(instants.begin(), instants.end(), [&](const Instant& instant) {
            return instant.utc_offset_min == instants.front().utc_offset_min;
        });
    if (is_one_clock) return instants.front().utc_offset_min;
    if (!timezone.empty()) return standard_utc_offset_min(year, timezone);
    if (!instants.empty()) return instants.front().utc_offset_min;
    if (settings.weather) return static_cast<int>(std::lround(60.0 * settings.weather->station.utc_offset_h));
    if (options.hours == "clock") {
        throw InputError(
            "--diagram-hours clock needs to know the clock: give --timezone NAME, for example --timezone "
            "Europe/Vienna.");
    }
    return std::nullopt;
}

std::string list_of(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, ", "));
}

constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

std::string day_text(CalendarDay day) {
    return fmt::format("{} {}", day.day, kMonths[day.month - 1]);
}

/// Days that the diagram cannot show, since they have no arc.
void note_polar_night(const std::vector<DayArc>& days, std::vector<std::string>& notes) {
    std::vector<std::string> dark;
    for (const DayArc& day : days) {
        if (!day.lines.empty()) continue;
        dark.push_back(day_text(day.day));
        if (day.twin) dark.push_back(day_text(*day.twin));
    }
    if (!dark.empty()) notes.push_back(fmt::format("Polar night, without an arc: {}.", list_of(dark)));
}

/// Marks the instants with a sun above the horizon by their clock time, with the day where there are several, and adds
/// the arcs of up to four days.
void mark_instants(const std::vector<Instant>& instants, const Site& site, io::SunDiagram& diagram) {
    constexpr std::size_t kMostArcs = 4;
    std::map<std::int64_t, UtcTime> solar_days;
    std::map<std::string, int> dates;
    for (const Instant& instant : instants) {
        solar_days.try_emplace(local_solar_day(instant.utc, site), instant.utc);
        ++dates[to_iso8601(instant).substr(0, 10)];
    }
    std::size_t below = 0;
    for (const Instant& instant : instants) {
        const SolarPosition sun = solar_position(instant.utc, site);
        if (sun.apparent_elevation_rad < 0.0) {
            ++below;
            continue;
        }
        const std::string text = to_iso8601(instant);
        const std::string clock = text.substr(11, 5);
        const CalendarDay day{std::stoi(text.substr(5, 2)), std::stoi(text.substr(8, 2))};
        diagram.marks.push_back({dates.size() > 1 ? fmt::format("{} {}", day_text(day), clock) : clock, sun.azimuth_rad,
                                 sun.apparent_elevation_rad});
    }
    if (solar_days.size() <= kMostArcs) {
        for (const auto& [number, utc] : solar_days) diagram.chosen_days.push_back(arc_of(utc, site));
    }
    if (dates.size() == 1) diagram.subtitles.push_back(fmt::format("Marked: {}", dates.begin()->first));
    if (below > 0)
        diagram.notes.push_back(
            fmt::format("Not shown, the sun being below the horizon: {} of {} instants.", below, instants.size()));
}

}  // namespace

io::SunDiagram sun_path_diagram(const DiagramOptions& options, const DaylightSettings& settings,
                                const std::string& timezone, const Site& site) {
    const int year = settings.instants.empty() ? kDiagramYear : year_of(settings.instants.front());
    const std::optional<int> clock = clock_of(options, settings, year, timezone);
    io::SunDiagram diagram;
    diagram.projection = projection_of(options.projection);
    diagram.title = fmt::format("Sun path at {}, {}", degrees_text(site.latitude_rad, "N", "S"),
                                degrees_text(site.longitude_rad, "E", "W"));
    if (!clock) {
        diagram.subtitles.push_back("Hours: true solar time");
    } else if (timezone.empty()) {
        diagram.subtitles.push_back(fmt::format("Hours: {}", offset_text(*clock)));
    } else {
        diagram.subtitles.push_back(fmt::format("Hours: {} ({})", offset_text(*clock), timezone));
    }
    diagram.days = year_arcs(year, site);
    diagram.hours = hour_lines(year, site, clock);
    constexpr const char* kProjectionNames[] = {"Stereographic", "Equidistant", "Orthographic"};
    diagram.notes.push_back(
        fmt::format("Year {}. {} projection, azimuth from true north, map view (east on the right).", year,
                    kProjectionNames[static_cast<int>(diagram.projection)]));
    diagram.notes.push_back("Places as seen, with refraction (standard atmosphere, 12 °C); open horizon.");
    diagram.notes.push_back(clock ? "Hours solid from December to June, dashed from June to December."
                                  : "Hours of true solar time: 12 is due south or north.");
    note_polar_night(diagram.days, diagram.notes);
    mark_instants(settings.instants, site, diagram);
    return diagram;
}

}  // namespace skybake::cli
