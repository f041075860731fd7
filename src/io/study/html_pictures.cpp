#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/study/html_parts.h"
#include "io/study/shadow_sheet.h"
#include "io/study/sky_plate.h"
#include "io/study/study_map.h"

namespace skybake::io {
namespace {

constexpr std::size_t kMostMaps = 8;
constexpr std::size_t kMostDifferences = 4;
constexpr std::size_t kMostInstants = 6;  // of maps of one day's shadows

void figure(Html& html, const std::string& svg, const std::string& caption) {
    html.open("figure").markup(svg).element("figcaption", caption).close("figure");
}

std::string stacked_note(const StudyReport& report, bool shows_worst_low, const Words& words) {
    const std::vector<Receiver>& receivers = report.study.receivers.receivers;
    const bool has_facades = std::any_of(receivers.begin(), receivers.end(),
                                         [](const Receiver& r) { return r.kind == ReceiverKind::facade; });
    if (!has_facades) return "";
    return shows_worst_low
               ? words(" Façades: a band before the wall, with the least value of all cells above each other.",
                       " Fassaden: ein Band vor der Wand, mit dem kleinsten Wert aller Zellen übereinander.")
               : words(" Façades: a band before the wall, with the greatest value of all cells above each other.",
                       " Fassaden: ein Band vor der Wand, mit dem größten Wert aller Zellen übereinander.");
}

void add_value_map(Html& html, const StudyReport& report, const Words& words, const MapGround& ground, std::size_t c,
                   double lettering) {
    const Column& column = report.study.columns[c];
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    const bool is_low = traits_of(column.metric).prefers_more;
    const StudyMap map{
        &ground,
        &report.study.receivers,
        &column.values,
        stepped_scale(static_cast<double>(*low), static_cast<double>(*high), thresholds_of(report.rule, column.metric)),
        is_low,
        words.unit(column.metric),
        traits_of(column.metric).decimals,
        report.facts.settings.convergence_rad,
        lettering};
    figure(html, study_map_svg(map, words),
           words.column(report.study, column) + "." +
               words(" Thresholds of the rule are marked in the legend.",
                     " Schwellen der Regel sind in der Legende markiert.") +
               stacked_note(report, is_low, words));
}

void add_difference_map(Html& html, const StudyReport& report, const Words& words, const MapGround& ground,
                        std::size_t c, std::size_t former, double lettering) {
    const Column &after = report.study.columns[c], &before = report.study.columns[former];
    std::vector<float> change(after.values.size());
    double most = 0.0;
    for (std::size_t i = 0; i < change.size(); ++i) {
        change[i] = after.values[i] - before.values[i];
        most = std::max(most, static_cast<double>(std::abs(change[i])));
    }
    if (most < traits_of(after.metric).least_change) return;
    const StudyMap map{&ground,
                       &report.study.receivers,
                       &change,
                       difference_scale(most, traits_of(after.metric).least_change),
                       traits_of(after.metric).prefers_more,
                       words.unit(after.metric),
                       traits_of(after.metric).decimals,
                       report.facts.settings.convergence_rad,
                       lettering};
    figure(html, study_map_svg(map, words),
           words.column(report.study, after) +
               words(": after less before; brown has less, blue has more, white no change. The plan is violet.",
                     ": nachher weniger vorher; Braun hat weniger, Blau mehr, Weiß bleibt gleich. Das Vorhaben ist "
                     "violett.") +
               stacked_note(report, map.shows_worst_low, words));
}

std::string place_of(const Receiver& receiver, const Sample& sample, const Words& words) {
    return fmt::format("{} ({}; {}, {}, {} m)", receiver.id, words.kind(receiver.kind),
                       words.number(sample.position.x, 1), words.number(sample.position.y, 1),
                       words.number(sample.position.z, 1));
}

}  // namespace

void add_maps(Html& html, const StudyReport& report, const Words& words) {
    if (report.pictures.maps.empty()) return;
    const std::vector<std::size_t> columns = leading_columns(report.rule, report.study);
    html.element("h2", words("Maps", "Karten"), {{"class", "cut"}});
    // Several days side by side, so that they can be compared.
    const bool is_paired = columns.size() > 2;
    const double lettering = is_paired ? 1.7 : 1.0;
    html.open("div", {{"class", is_paired ? "pair" : "single"}});
    for (std::size_t i = 0; i < std::min(columns.size(), kMostMaps); ++i)
        add_value_map(html, report, words, report.pictures.maps.front(), columns[i], lettering);
    std::size_t drawn = 0;
    for (const std::size_t c : columns) {
        const std::optional<std::size_t> former = former_column(report.study, c);
        if (former && drawn++ < kMostDifferences)
            add_difference_map(html, report, words, report.pictures.maps.back(), c, *former, lettering);
    }
    html.close("div");
}

void add_shadows(Html& html, const StudyReport& report, const Words& words) {
    const StudyPictures& pictures = report.pictures;
    if (pictures.shadows.empty()) return;
    const double convergence = report.facts.settings.convergence_rad;
    const MapGround& near = pictures.shadow_map;
    html.element("h2", words("Shadows by the hour", "Schatten stundenweise"), {{"class", "cut"}});
    html.element("p", fmt::format(fmt::runtime(words("Outlines on the ground, on a lattice of {} m: edges are right to "
                                                     "1 cm where they cross it, corners are cut.",
                                                     "Umrisse auf dem Boden, auf einem Gitter von {} m: auf 1 cm, wo "
                                                     "sie es kreuzen; Ecken sind abgeschnitten.")),
                                  words.number(pictures.shadow_spacing_m, 0)));
    const bool has_plan = std::any_of(pictures.shadows.begin(), pictures.shadows.end(),
                                      [](const HourShadow& s) { return s.kind == ShadowKind::plan; });
    for (std::size_t day = 0; day < report.study.days.size(); ++day) {
        const std::string date = words.day(report.study.days[day].day());
        if (has_plan) {
            const std::string svg =
                shadow_fan_svg(pictures, near, day, ShadowKind::plan, ShadowKind::added, words, convergence);
            if (svg.empty()) continue;
            figure(html, svg,
                   date + words(": shadow of the plan alone, hour by hour (lines); where it was sunny before and is "
                                "not any more "
                                "(orange, darker where it lasts). Shadows end at the map's border.",
                                ": Schatten des Vorhabens allein, Stunde um Stunde (Linien); wo vorher Sonne war und "
                                "nun nicht mehr "
                                "(orange, dunkler, wo es dauert). Schatten enden am Kartenrand."));
            continue;
        }
        std::vector<const HourShadow*> hours;
        for (const HourShadow& shadow : pictures.shadows) {
            if (shadow.day == day && shadow.kind == ShadowKind::city) hours.push_back(&shadow);
        }
        const std::size_t step = (hours.size() + kMostInstants - 1) / kMostInstants;
        if (step == 0) continue;
        html.element("h3", date).open("div", {{"class", "pair"}});
        for (std::size_t i = (hours.size() - 1) % step / 2; i < hours.size(); i += step)
            figure(html, shadow_instant_svg(*hours[i], near, words, convergence),
                   fmt::format("{}, {} ({})", date, hours[i]->clock,
                               pictures.has_solar_clock ? words("true solar time", "wahre Ortszeit")
                                                        : words("local time", "Ortszeit")));
        html.close("div");
    }
}

void add_skies(Html& html, const StudyReport& report, const Words& words) {
    if (report.pictures.plates.empty()) return;
    html.element("h2", words("The sky of chosen places", "Der Himmel ausgewählter Orte"), {{"class", "cut"}});
    const std::optional<std::string>& zone = report.facts.settings.timezone;
    for (const SamplePlate& plate : report.pictures.plates) {
        const Sample& sample = report.study.receivers.samples[plate.sample];
        const Receiver& receiver = report.study.receivers.receivers[sample.receiver];
        const auto reason = [&]() -> std::string {
            if (plate.reason == "loses most") return words("loses most", "verliert am meisten");
            if (plate.reason == "nearest to the threshold")
                return words("nearest to the threshold", "der Schwelle am nächsten");
            if (plate.reason == "worst") return words("fares worst", "schneidet am schlechtesten ab");
            return words("chosen", "ausgewählt");
        };
        html.open("figure", {{"class", "plate"}})
            .markup(sky_plate_svg(plate, report.study, report.facts.settings, receiver.id, words));
        html.open("div").element("figcaption", reason() + ": " + place_of(receiver, sample, words));
        std::vector<std::string> head{words("Day", "Tag"),
                                      words("Sun", "Sonne") + fmt::format(" [{}]", zone.value_or("UTC"))};
        if (!plate.sunny_before.empty()) head.push_back(words("before", "vorher"));
        std::vector<std::vector<Html::Cell>> rows;
        for (std::size_t d = 0; d < report.study.days.size(); ++d) {
            const SunDay& day = report.study.days[d];
            rows.push_back({{words.day(day.day()), "words"}, {sunny_times(plate.sunny[d], day, zone), "words"}});
            if (!plate.sunny_before.empty())
                rows.back().push_back({sunny_times(plate.sunny_before[d], day, zone), "words"});
        }
        if (!rows.empty()) html.table(head, rows);
        html.close("div").close("figure");
    }
}

}  // namespace skybake::io
