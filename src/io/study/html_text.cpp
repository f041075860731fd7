#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/study/html_parts.h"
#include "io/study/sky_plate.h"

namespace skybake::io {
namespace {

bool computes(const Study& study, std::initializer_list<Metric> some) {
    return std::any_of(study.columns.begin(), study.columns.end(), [&](const Column& column) {
        return std::find(some.begin(), some.end(), column.metric) != some.end();
    });
}

void list(Html& html, const std::vector<std::string>& entries, std::string_view style = "plain") {
    html.open("ul", {{"class", style}});
    for (const std::string& entry : entries) html.element("li", entry);
    html.close("ul");
}

std::string days_text(const StudyReport& report, const Words& words) {
    std::vector<std::string> days;
    for (const SunDay& day : report.study.days) days.push_back(words.day(day.day()));
    return fmt::format("{}", fmt::join(days, ", "));
}

std::string first_of(const std::vector<std::string>& ids, const Words& words) {
    constexpr std::size_t kMost = 8;
    std::string text = fmt::format("{}", fmt::join(ids.begin(), ids.begin() + std::min(ids.size(), kMost), ", "));
    if (ids.size() > kMost)
        text += fmt::format(" {} {}", words("and more, in all", "und weitere, zusammen"), ids.size());
    return text;
}

std::string degrees(double radians, int decimals, const Words& words) {
    return words.number(degrees_from_radians(radians), decimals) + "°";
}

void add_verdicts(Html& html, const StudyReport& report, const Words& words) {
    if (report.rule.criteria.empty()) {
        html.element("p", words("The rule has no threshold: values are reported, nothing is judged.",
                                "Die Regel hat keine Schwelle: Werte werden berichtet, nichts wird beurteilt."));
        return;
    }
    html.open("div", {{"class", "verdicts"}});
    for (const Group& group : report.groups) {
        if (group.level != Level::kind) continue;
        for (std::size_t c = 0; c < report.rule.criteria.size(); ++c) {
            const GroupCriterion& result = group.criteria[c];
            if (result.verdict == Verdict::none) continue;
            const Criterion& criterion = report.rule.criteria[c];
            html.open("div", {{"class", std::string("verdict ") + name_of(result.verdict)}}).open("strong");
            html.text(fmt::format("{}: {}", words.kind(group.kind), words.verdict(result.verdict)));
            html.close("strong").open("div");
            html.text(fmt::format("{} ({})", criterion.text.empty() ? criterion.id : criterion.text,
                                  threshold_text(criterion, words)));
            html.close("div");
            html.element("div",
                         fmt::format(fmt::runtime(words("{} of the area pass, {} borderline, {} fail; asked: {}",
                                                        "{} der Fläche erfüllt, {} Grenzfall, {} nicht; verlangt: {}")),
                                     words.percent(result.area_pass), words.percent(result.area_borderline),
                                     words.percent(result.area_fail), words.percent(criterion.area_share)));
            html.close("div");
        }
    }
    html.close("div");
}

}  // namespace

void add_task(Html& html, const StudyReport& report, const Words& words) {
    const StudyFacts& facts = report.facts;
    html.element("h1", report.rule.title);
    std::vector<std::string> cities;
    for (const StudyInput& input : facts.inputs) {
        if (input.role == "city" || input.role == "plan")
            cities.push_back(input.file.substr(input.file.rfind('/') + 1));
    }
    html.element("p",
                 words("Sun and shadow study of ", "Besonnungs- und Verschattungsstudie zu ") +
                     fmt::format("{}", fmt::join(cities, ", ")),
                 {{"class", "lead"}});
    html.element("h2", words("Task and result", "Aufgabe und Ergebnis"));
    std::vector<std::string> kinds;
    for (const ReceiverKind kind : facts.receivers.kinds) kinds.push_back(words.kind(kind));
    std::vector<std::string> asked{
        words("Asked of: ", "Gefragt an: ") + fmt::format("{}", fmt::join(kinds, ", ")) +
        fmt::format(" ({} {}, {} {})", words.count(report.study.receivers.samples.size()), words("cells", "Zellen"),
                    words.count(report.study.receivers.receivers.size()), words("receivers", "Empfänger"))};
    if (!report.study.days.empty())
        asked.push_back(words("Days: ", "Tage: ") + days_text(report, words) + fmt::format(" {}", facts.settings.year));
    list(html, asked);
    if (!facts.plan.empty()) html.element("p", words("The plan: ", "Das Vorhaben: ") + first_of(facts.plan, words));
    if (!facts.removed.empty()) html.element("p", words("Taken away: ", "Entfernt: ") + first_of(facts.removed, words));
    if (facts.has_before)
        html.element("p", words("Both states are computed with the same receivers: those of the city with the plan, "
                                "without the plan's own surfaces.",
                                "Beide Zustände sind an denselben Empfängern gerechnet: denen der Stadt mit dem "
                                "Vorhaben, ohne dessen eigene Flächen."));
    add_verdicts(html, report, words);
}

void add_rule(Html& html, const StudyReport& report, const Words& words) {
    const Rule& rule = report.rule;
    html.element("h2", words("Rule", "Regel"));
    html.table({words("Rule", "Regel"), words("Source", "Quelle"), words("Edition", "Ausgabe")},
               {{fmt::format("{} {}", rule.id, rule.version), rule.source, {rule.source_date, "words"}}});
    if (!rule.criteria.empty()) {
        std::vector<std::vector<Html::Cell>> rows;
        for (const Criterion& c : rule.criteria) {
            rows.push_back({c.id,
                            c.text,
                            words.metric(c.metric),
                            {threshold_text(c, words), "words"},
                            {fmt::format("± {} {}", words.number(c.tolerance, 2), words.unit(c.metric)), "words"},
                            {words.percent(c.area_share), "number"},
                            c.is_required ? words("yes", "ja") : words("reported only", "nur berichtet")});
        }
        html.table({words("Criterion", "Kriterium"), words("Asks", "Verlangt"), words("Measured by", "Gemessen an"),
                    words("Threshold", "Schwelle"), words("Borderline within", "Grenzfall innerhalb"),
                    words("Share of area", "Flächenanteil"), words("Required", "Verbindlich")},
                   rows);
    }
    if (!rule.confirmed.empty()) {
        html.element("h3", words("Confirmed", "Bestätigt"));
        list(html, rule.confirmed);
    }
    if (!rule.to_check.empty()) {
        html.element("h3", words("To be checked before relying on a verdict", "Vor Verwendung zu prüfen"));
        list(html, rule.to_check, "check");
    }
}

void add_data(Html& html, const StudyReport& report, const Words& words) {
    const StudyFacts& facts = report.facts;
    html.element("h2", words("Data", "Daten"));
    std::vector<std::vector<Html::Cell>> rows;
    for (const StudyInput& input : facts.inputs)
        rows.push_back(
            {input.role, {input.file, "words"}, {words.count(input.bytes), "number"}, {input.sha256, "key"}});
    html.table({words("As", "Als"), words("File", "Datei"), words("Bytes", "Bytes"), "SHA-256"}, rows);
    const Site& site = facts.settings.site;
    list(html,
         {words("Reference system: ", "Bezugssystem: ") +
              (facts.crs.empty() ? words("not named", "nicht benannt") : facts.crs),
          words("Place: latitude ", "Ort: Breite ") + degrees(site.latitude_rad, 4, words) +
              words(", longitude ", ", Länge ") + degrees(site.longitude_rad, 4, words) +
              words("; grid north lies ", "; Gitternord liegt ") + degrees(facts.settings.convergence_rad, 3, words) +
              words(" east of true north", " östlich von geografisch Nord"),
          words("Light of the year: ", "Licht des Jahres: ") +
              facts.weather.value_or(words("not needed", "nicht benötigt"))});
    const std::vector<Finding> findings = report.findings.list();
    html.element("h3", words("Findings in the data", "Befunde zu den Daten"));
    if (findings.empty()) {
        html.element("p", words("None.", "Keine."));
        return;
    }
    constexpr std::size_t kMost = 15;
    rows.clear();
    for (const Finding& f : findings) {
        const bool is_known = !rows.empty() && rows.back()[0].text == f.code;
        if (is_known || rows.size() == kMost) continue;
        rows.push_back(
            {f.code, name_of(f.severity), {words.count(f.count), "number"}, {f.where + ": " + f.what, "words"}});
    }
    html.table({words("Code", "Code"), words("Severity", "Schwere"), words("Times", "Anzahl"),
                words("First of them", "Erster davon")},
               rows);
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
    if (computes(study, {Metric::sky_view_factor, Metric::sky_component_pct, Metric::irradiation_kwh_m2}))
        notes.push_back(fmt::format(fmt::runtime(words("Sky by {} directions for each orientation, weighed by cosine "
                                                       "and luminance (CIE overcast sky, Moon & Spencer).",
                                                       "Himmel durch {} Richtungen je Ausrichtung, gewichtet mit "
                                                       "Kosinus und Leuchtdichte (CIE bedeckt, Moon & Spencer).")),
                                    words.count(static_cast<std::uint64_t>(facts.settings.sky_directions))));
    if (computes(study, {Metric::sunshine_pct, Metric::winter_sunshine_pct, Metric::irradiation_kwh_m2}))
        notes.push_back(
            words("Sun of the period by a lattice of its ways (declination every 3.9°, hour angle every 3.75°); skies "
                  "by Perez et al. 1993.",
                  "Sonne des Zeitraums durch ein Gitter ihrer Bahnen (Deklination alle 3,9°, Stundenwinkel alle "
                  "3,75°); Himmel nach Perez et al. 1993."));
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
         {words("rays", "Strahlen"), words.count(report.study.rays)},
         {words("seconds of this run", "Sekunden dieses Laufs"), words.number(report.seconds, 1)}});
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
