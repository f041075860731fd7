#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/study/html_parts.h"
#include "io/study/sky_plate.h"

namespace skybake::io {
namespace {

bool computes(const Study& study, std::initializer_list<Metric> some) {
    return std::any_of(study.columns.begin(), study.columns.end(), [&](const Column& column) {
        return std::find(some.begin(), some.end(), column.metric) != some.end();
    });
}

}  // namespace

void list(Html& html, const std::vector<std::string>& entries, std::string_view style) {
    html.open("ul", {{"class", style}});
    for (const std::string& entry : entries) html.element("li", entry);
    html.close("ul");
}

void add_method(Html& html, const StudyReport& report, const Words& words) {
    const Study& study = report.study;
    const StudyFacts& facts = report.facts;
    html.element("h2", words("Method", "Verfahren"));
    std::vector<std::string> notes;
    notes.push_back(fmt::format(
        fmt::runtime(words(
            "Façades, roofs and ground are cut into cells of at most {} m; façades at storeys of {} m above the "
            "building's lowest wall point. Each cell is asked at its centre; {} cells inside bodies are left out.",
            "Fassaden, Dächer und Boden sind in Zellen von höchstens {} m geteilt, Fassaden in Geschosse von {} m "
            "über dem tiefsten Wandpunkt. Jede Zelle wird in ihrer Mitte gefragt; {} Zellen in Körpern entfallen.")),
        words.number(facts.receivers.cell_m, 2), words.number(facts.receivers.storey_height_m, 1),
        words.count(study.receivers.enclosed)));
    if (!study.days.empty()) {
        notes.push_back(
            report.rule.sampled
                ? fmt::format(
                      fmt::runtime(words(
                          "Sun by the sampled construction that the rule asks for: a ray to the sun every {} minutes.",
                          "Sonne nach der verlangten Stichprobe: ein Strahl zur Sonne alle {} Minuten.")),
                      words.number(report.rule.sampled->step_s / 60.0, 0))
                : words("Sun by exact intervals: the sun's middle (NREL SPA, with refraction) is followed along its "
                        "path, and "
                        "each crossing of an edge is refined to 1 s.",
                        "Sonne in genauen Intervallen: die Sonnenmitte (NREL SPA, mit Refraktion) wird auf ihrer Bahn "
                        "verfolgt, jeder Wechsel auf 1 s bestimmt."));
        if (report.rule.min_elevation_deg > 0.0)
            notes.push_back(words("The sun counts from this geometric elevation on: ",
                                  "Die Sonne zählt ab dieser geometrischen Höhe: ") +
                            words.number(report.rule.min_elevation_deg, 1) + "°");
        std::vector<std::vector<Html::Cell>> rows;
        const std::optional<std::string>& zone = facts.settings.timezone;
        const std::string unit = fmt::format(" [{}]", zone.value_or("UTC"));
        for (const SunDay& day : study.days) {
            rows.push_back({{words.day(day.day()), "words"},
                            {clock_of(day.begin(), zone), "number"},
                            {clock_of(day.time_of(day.length_s()), zone), "number"},
                            {words.number(day.hours(), 2), "number"}});
        }
        html.table({words("Day", "Tag"), words("Looked at from", "Betrachtet ab") + unit, words("to", "bis") + unit,
                    words("Hours in which the sun counts", "Stunden, in denen die Sonne zählt")},
                   rows);
    }
    if (computes(study,
                 {Metric::sky_view_factor, Metric::sky_component_pct, Metric::sky_kwh_m2, Metric::irradiation_kwh_m2}))
        notes.push_back(fmt::format(fmt::runtime(words("Sky by {} directions for each orientation, weighed by cosine "
                                                       "and luminance (CIE overcast sky, Moon & Spencer).",
                                                       "Himmel durch {} Richtungen je Ausrichtung, gewichtet mit "
                                                       "Kosinus und Leuchtdichte (CIE bedeckt, Moon & Spencer).")),
                                    words.count(static_cast<std::uint64_t>(facts.settings.sky_directions))));
    if (computes(study, {Metric::sunshine_pct, Metric::winter_sunshine_pct, Metric::beam_kwh_m2, Metric::sky_kwh_m2,
                         Metric::irradiation_kwh_m2}))
        notes.push_back(
            words("Sun of the period by a lattice of its ways (declination every 3.9°, hour angle every 3.75°); skies "
                  "by Perez et al. 1993.",
                  "Sonne des Zeitraums durch ein Gitter ihrer Bahnen (Deklination alle 3,9°, Stundenwinkel alle "
                  "3,75°); Himmel nach Perez et al. 1993."));
    if (!facts.instants.empty())
        notes.push_back(
            words("Illuminance at instants by the sky ", "Beleuchtungsstärke zu Zeitpunkten mit dem Himmel ") +
            fmt::format("{}.", fmt::join(facts.instants, "; ")));
    if (computes(study, {Metric::indirect_kwh_m2, Metric::indirect_lx}))
        notes.push_back(fmt::format(
            fmt::runtime(
                words("Reflected light by {} paths a cell with up to {} reflections; surfaces are matt, with the "
                      "albedo of their material or texture, else of their kind (docs/physics.md). For energy, the "
                      "period's sun is spread over 2.5° of the sky.",
                      "Reflektiertes Licht durch {} Pfade je Zelle mit bis zu {} Reflexionen; Oberflächen sind "
                      "matt, mit der Albedo ihres Materials oder ihrer Textur, sonst ihrer Art "
                      "(docs/physics.md). Für Energie ist die Sonne des Zeitraums auf 2,5° verteilt.")),
            words.count(static_cast<std::uint64_t>(facts.settings.paths.paths)), facts.settings.paths.bounces));
    list(html, notes);
}

void add_uncertainty(Html& html, const StudyReport& report, const Words& words) {
    html.element("h2", words("Uncertainty", "Unsicherheit"));
    std::vector<std::string> notes;
    if (!report.study.days.empty() && !report.rule.sampled)
        notes.push_back(
            words("Times of sun and shadow: 99.9 % of the crossings are within 2 s of a ray at every second "
                  "(docs/validation.md). "
                  "The real sun is 0.53° wide: an edge takes it about two minutes to cross.",
                  "Zeiten von Sonne und Schatten: 99,9 % der Wechsel liegen innerhalb 2 s einer sekündlichen "
                  "Berechnung (docs/validation.md). "
                  "Die wirkliche Sonne ist 0,53° breit: eine Kante verdeckt sie in etwa zwei Minuten."));
    if (computes(report.study, {Metric::sky_view_factor, Metric::sky_component_pct}))
        notes.push_back(words("Shares of the sky: 0.001 of the whole sky, 0.1 percentage points of the sky component.",
                              "Himmelsanteile: 0,001 des ganzen Himmels, 0,1 Prozentpunkte des Himmelslichtanteils."));
    if (computes(report.study, {Metric::sunshine_pct, Metric::winter_sunshine_pct}))
        notes.push_back(words(
            "Probable sunlight: 0.5 % of the period's sunshine (root mean square).",
            "Wahrscheinliche Besonnung: 0,5 % des Sonnenscheins des Zeitraums (mittlerer quadratischer Fehler)."));
    if (computes(report.study, {Metric::indirect_kwh_m2, Metric::indirect_lx}))
        notes.push_back(
            fmt::format(fmt::runtime(words(
                            "Reflected light of one cell scatters by some {} % (one standard error); of a façade of n "
                            "cells by √n less. Unknown albedos weigh more: they are in proportion to it.",
                            "Reflektiertes Licht einer Zelle streut um etwa {} % (ein Standardfehler), das einer "
                            "Fassade aus n Zellen um √n weniger. Unbekannte Albedos wiegen schwerer: es ist ihnen "
                            "proportional.")),
                        words.number(100.0 / std::sqrt(static_cast<double>(report.facts.settings.paths.paths)), 0)));
    notes.push_back(
        words("The model: an edge of a roof that is wrong by 1 m at a distance of 50 m moves the shadow's time by "
              "about five minutes. "
              "Trees are there only as far as the model has them, and are then opaque.",
              "Das Modell: eine um 1 m falsche Dachkante in 50 m Entfernung verschiebt die Zeit des Schattens um etwa "
              "fünf Minuten. "
              "Bäume gibt es nur, soweit das Modell sie hat, und dann undurchsichtig."));
    notes.push_back(words("Cells lie on the façade's plane, not within the reveal of a window.",
                          "Zellen liegen in der Fassadenebene, nicht in der Laibung eines Fensters."));
    notes.push_back(
        words("Values within a criterion's tolerance are called borderline, not pass or fail.",
              "Werte innerhalb der Toleranz eines Kriteriums heißen Grenzfall, weder erfüllt noch nicht erfüllt."));
    list(html, notes);
}

void add_annex(Html& html, const StudyReport& report, const Words& words) {
    const StudyFacts& facts = report.facts;
    html.element("h2", words("Annex", "Anhang"));
    html.element("h3", words("Settings", "Einstellungen"));
    html.table(
        {words("Setting", "Einstellung"), words("Value", "Wert")},
        {{words("program", "Programm"),
          {fmt::format("skybake {} ({})", facts.program_version, facts.embree_isa), "words"}},
         {words("height of ground cells [m]", "Höhe der Bodenzellen [m]"), words.number(facts.receivers.height_m, 2)},
         {words("scan of the sun's path [s]", "Abtastung der Sonnenbahn [s]"), words.number(facts.settings.scan_s, 0)},
         {words("time zone", "Zeitzone"), facts.settings.timezone.value_or("UTC")},
         {words("months of the period", "Monate des Zeitraums"),
          {fmt::format("{}", fmt::join(facts.period.months, ", ")), "words"}},
         {words("albedo of open ground", "Albedo freien Bodens"), words.number(facts.settings.ground_albedo, 2)},
         {words("paths of reflected light", "Pfade des reflektierten Lichts"),
          words.count(static_cast<std::uint64_t>(facts.settings.paths.paths))},
         {words("rays but for these", "Strahlen außer diesen"), words.count(report.study.rays)}});
    html.element("h3", words("To make it again", "Zur Wiederholung"));
    std::string command = "skybake study";
    for (const std::string& argument : facts.arguments) command += " " + argument;
    html.open("p").element("code", command).close("p");
    html.open("p").text(
        words("A sample of the rows is computed anew, and all hashes are compared, by ",
              "Eine Stichprobe der Zeilen wird neu gerechnet, und alle Prüfsummen werden verglichen, durch "));
    html.element("code", "skybake study --verify report.json").close("p");
    std::vector<std::vector<Html::Cell>> rows;
    for (const StudyInput& table : facts.tables)
        rows.push_back({{table.file, "words"}, {words.count(table.bytes), "number"}, {table.sha256, "key"}});
    html.table({words("Table beside this report", "Tabelle neben diesem Bericht"), "Bytes", "SHA-256"}, rows);
}

}  // namespace skybake::io
