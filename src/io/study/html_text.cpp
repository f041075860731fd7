#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/study/html_parts.h"
#include "io/study/sky_plate.h"

namespace skybake::io {
namespace {

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

/// Of a criterion that is only reported.
std::string reported(const GroupCriterion& result, const Words& words) {
    if (result.verdict == Verdict::pass) return words("reached (not required)", "erreicht (nicht verbindlich)");
    if (result.verdict == Verdict::borderline)
        return words("borderline (not required)", "Grenzfall (nicht verbindlich)");
    return words("not reached (not required)", "nicht erreicht (nicht verbindlich)");
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
            // What is not required cannot be failed.
            const std::string style = criterion.is_required ? name_of(result.verdict) : "reported";
            html.open("div", {{"class", fmt::format("verdict {}", style)}}).open("strong");
            html.text(fmt::format("{}: {}", words.kind(group.kind),
                                  criterion.is_required ? words.verdict(result.verdict) : reported(result, words)));
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
        rows.push_back({words.role(input.role),
                        {input.file, "words"},
                        {words.count(input.bytes), "number"},
                        {input.sha256, "key"}});
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

}  // namespace skybake::io
