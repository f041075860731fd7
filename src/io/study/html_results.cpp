#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/study/html_parts.h"
#include "io/study/sky_plate.h"

namespace skybake::io {
namespace {

constexpr std::size_t kMostRows = 40;        // of a table; all are in groups.csv
constexpr std::size_t kMostColumnPairs = 4;  // metrics and days of the tables of changes

void add_values(Html& html, const StudyReport& report, const Words& words) {
    html.element("h3", words("Values", "Werte"));
    std::vector<std::vector<Html::Cell>> rows;
    for (const Group& group : report.groups) {
        if (group.level != Level::kind) continue;
        for (std::size_t c = 0; c < report.study.columns.size(); ++c) {
            const Column& column = report.study.columns[c];
            const int decimals = traits_of(column.metric).decimals;
            rows.push_back({words.kind(group.kind),
                            {words.column(report.study, column), "words"},
                            words.number(group.columns[c].mean, decimals),
                            words.number(group.columns[c].least, decimals),
                            words.number(group.columns[c].greatest, decimals)});
        }
    }
    html.table({words("Of", "An"), words("Measure", "Größe"), words("Mean by area", "Mittel nach Fläche"),
                words("Least", "Kleinster"), words("Greatest", "Größter")},
               rows);
}

/// The groups that reports tell one by one: buildings, and areas and points, which have none.
std::vector<const Group*> told_groups(const StudyReport& report) {
    std::vector<const Group*> told;
    for (const Group& group : report.groups) {
        const bool stands_alone = group.level == Level::receiver &&
                                  (group.kind == ReceiverKind::polygon || group.kind == ReceiverKind::point);
        if (group.level == Level::building || stands_alone) told.push_back(&group);
    }
    return told;
}

std::string cut_note(std::size_t shown, std::size_t all, const Words& words) {
    if (shown >= all) return "";
    return fmt::format(
        fmt::runtime(words("The first {} of {}; all are in groups.csv.", "Die ersten {} von {}; alle in groups.csv.")),
        shown, words.count(all));
}

void add_judged(Html& html, const StudyReport& report, const Words& words) {
    if (report.rule.criteria.empty()) return;
    std::vector<const Group*> groups = told_groups(report);
    std::erase_if(groups, [](const Group* g) { return g->verdict == Verdict::none; });
    std::size_t counts[4] = {};
    for (const Group* group : groups) ++counts[static_cast<int>(group->verdict)];
    std::stable_sort(groups.begin(), groups.end(), [](const Group* a, const Group* b) {
        if (a->verdict != b->verdict) return a->verdict > b->verdict;
        return a->criteria[0].area_pass < b->criteria[0].area_pass;
    });
    html.element("h3", words("Verdicts by building, area and point", "Urteile nach Gebäude, Fläche und Punkt"));
    html.element("p",
                 fmt::format(fmt::runtime(words("{} pass, {} borderline, {} fail the required criteria.",
                                                "{} erfüllen die verbindlichen Kriterien, {} Grenzfälle, {} nicht.")),
                             counts[1], counts[2], counts[3]) +
                     " " + cut_note(kMostRows, groups.size(), words));
    std::vector<std::vector<Html::Cell>> rows;
    for (const Group* group : groups) {
        if (rows.size() == kMostRows) break;
        for (std::size_t c = 0; c < report.rule.criteria.size(); ++c) {
            const Criterion& criterion = report.rule.criteria[c];
            const GroupCriterion& result = group->criteria[c];
            if (result.verdict == Verdict::none || !criterion.is_required) continue;
            std::vector<Html::Cell> row{group->id,
                                        criterion.id,
                                        {words.number(group->area_m2, 0), "number"},
                                        {words.percent(result.area_pass), "number"},
                                        {words.percent(result.area_fail), "number"}};
            if (report.facts.has_before)
                row.push_back({result.area_pass_before ? words.percent(*result.area_pass_before) : "–", "number"});
            row.push_back(words.change(result.least_margin, traits_of(criterion.metric).decimals));
            row.push_back({words.verdict(result.verdict), name_of(result.verdict)});
            rows.push_back(std::move(row));
        }
    }
    std::vector<std::string> head{words("Of", "An"), words("Criterion", "Kriterium"), words("Area [m²]", "Fläche [m²]"),
                                  words("Area that passes", "Fläche, die erfüllt"),
                                  words("Area that fails", "Fläche, die nicht erfüllt")};
    if (report.facts.has_before) head.push_back(words("Passed before", "Erfüllte vorher"));
    head.push_back(words("Least margin", "Kleinster Abstand") +
                   fmt::format(" [{}]", words.unit(report.rule.criteria[0].metric)));
    head.push_back(words("Verdict", "Urteil"));
    html.table(head, rows);
}

/// A change of a group in one column; good when it is for the better.
struct Change {
    const Group* group = nullptr;
    std::size_t after = 0, before = 0;
    double good = 0.0;
};

void add_change_table(Html& html, const StudyReport& report, const Words& words, const std::string& title,
                      std::vector<Change> changes) {
    html.element("h3", title);
    if (changes.empty()) {
        html.element("p", words("None.", "Keine."));
        return;
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return std::abs(a.good) > std::abs(b.good); });
    if (const std::string note = cut_note(kMostRows, changes.size(), words); !note.empty()) html.element("p", note);
    std::vector<std::vector<Html::Cell>> rows;
    for (const Change& change : changes) {
        if (rows.size() == kMostRows) break;
        const Column& column = report.study.columns[change.after];
        const GroupColumn &after = change.group->columns[change.after], &before = change.group->columns[change.before];
        const int decimals = traits_of(column.metric).decimals;
        const double share = before.mean > 0.0 ? after.mean / before.mean : std::nan("");
        rows.push_back({change.group->id,
                        {words.column(report.study, column), "words"},
                        words.number(before.mean, decimals),
                        words.number(after.mean, decimals),
                        words.change(after.mean - before.mean, decimals),
                        {words.number(100.0 * share, 0) + " %", "number"},
                        words.number(after.least, decimals)});
    }
    html.table({words("Of", "An"), words("Measure", "Größe"), words("Mean before", "Mittel vorher"),
                words("Mean after", "Mittel nachher"), words("Change", "Änderung"), words("Kept", "Verblieben"),
                words("Least after", "Kleinster nachher")},
               rows);
}

void add_changes(Html& html, const StudyReport& report, const Words& words) {
    if (!report.facts.has_before) return;
    std::vector<Change> worse, better;
    std::size_t pairs = 0;
    for (const std::size_t c : leading_columns(report.rule, report.study)) {
        const std::optional<std::size_t> former = former_column(report.study, c);
        if (!former || ++pairs > kMostColumnPairs) continue;
        const Metric metric = report.study.columns[c].metric;
        for (const Group* group : told_groups(report)) {
            const double change = group->columns[c].mean - group->columns[*former].mean;
            if (std::abs(change) < traits_of(metric).least_change) continue;
            const double good = traits_of(metric).prefers_more ? change : -change;
            (good < 0.0 ? worse : better).push_back({group, c, *former, good});
        }
    }
    html.element("h2", words("What the plan changes", "Was das Vorhaben ändert"));
    add_change_table(html, report, words, words("Affected: less than before", "Betroffen: weniger als zuvor"),
                     std::move(worse));
    add_change_table(html, report, words, words("Better than before", "Besser als zuvor"), std::move(better));
}

void add_new_shadow(Html& html, const StudyReport& report, const Words& words) {
    if (!report.facts.has_before || report.study.days.empty()) return;
    std::vector<const NewShadow*> shadows;
    for (const NewShadow& shadow : report.study.new_shadows) shadows.push_back(&shadow);
    std::stable_sort(shadows.begin(), shadows.end(), [](const NewShadow* a, const NewShadow* b) {
        return a->longest_sample_min > b->longest_sample_min;
    });
    const std::optional<std::string>& zone = report.facts.settings.timezone;
    html.element("h3", words("New shadow: enter and exit", "Neuer Schatten: Beginn und Ende"));
    html.element("p", words("When any part of the receiver is in shadow that was in the sun before.",
                            "Wann irgendein Teil des Empfängers im Schatten liegt, der zuvor in der Sonne lag.") +
                          " " + cut_note(kMostRows, shadows.size(), words));
    std::vector<std::vector<Html::Cell>> rows;
    for (const NewShadow* shadow : shadows) {
        if (rows.size() == kMostRows) break;
        const SunDay& day = report.study.days[shadow->day];
        const auto clock = [&](float second) { return clock_of(day.time_of(static_cast<double>(second)), zone); };
        rows.push_back({report.study.receivers.receivers[shadow->receiver].id,
                        {words.day(day.day()), "words"},
                        {clock(shadow->episodes.front().begin_s), "number"},
                        {clock(shadow->episodes.back().end_s), "number"},
                        words.number(shadow->total_min, 1),
                        words.number(shadow->longest_sample_min, 1),
                        {words.percent(shadow->area_share), "number"}});
    }
    if (rows.empty()) {
        html.element("p", words("None.", "Keiner."));
        return;
    }
    const std::string unit = fmt::format(" [{}]", zone.value_or("UTC"));
    html.table(
        {words("Receiver", "Empfänger"), words("Day", "Tag"), words("Enters", "Beginn") + unit,
         words("Leaves", "Ende") + unit, words("Minutes in all", "Minuten insgesamt"),
         words("Longest of a cell [min]", "Längste einer Zelle [min]"), words("Share of cells", "Anteil der Zellen")},
        rows);
}

}  // namespace

std::string threshold_text(const Criterion& c, const Words& words) {
    const std::string unit = words.unit(c.metric).empty() ? "" : " " + words.unit(c.metric);
    const auto plain = [&](double value) {
        int decimals = 0;
        while (decimals < 3 &&
               std::abs(std::round(value * std::pow(10, decimals)) - value * std::pow(10, decimals)) > 1e-9)
            ++decimals;
        return words.number(value, decimals);
    };
    std::string text = c.at_least  ? words("at least ", "mindestens ") + plain(*c.at_least) + unit
                       : c.at_most ? words("at most ", "höchstens ") + plain(*c.at_most) + unit
                                   : words("reported", "berichtet");
    if (c.or_share_of_before)
        text += words(", or the former value times ", ", oder der frühere Wert mal ") + plain(*c.or_share_of_before);
    if (c.or_share_of_area_before)
        text += words(", or the area that met it before times ", ", oder die Fläche, die es zuvor erfüllte, mal ") +
                plain(*c.or_share_of_area_before);
    return text;
}

std::vector<std::size_t> leading_columns(const Rule& rule, const Study& study) {
    std::vector<Metric> metrics;
    for (const Criterion& criterion : rule.criteria) metrics.push_back(criterion.metric);
    for (const Metric metric : {Metric::sun_hours, Metric::sky_view_factor, Metric::irradiation_kwh_m2}) {
        const bool is_computed = std::any_of(study.columns.begin(), study.columns.end(),
                                             [&](const Column& column) { return column.metric == metric; });
        if (is_computed) metrics.push_back(metric);
    }
    std::vector<std::size_t> leading;
    for (const Metric metric : metrics) {
        for (std::size_t c = 0; c < study.columns.size(); ++c) {
            const Column& column = study.columns[c];
            const bool is_known = std::find(leading.begin(), leading.end(), c) != leading.end();
            if (column.metric == metric && !column.is_before && !is_known) leading.push_back(c);
        }
    }
    return leading;
}

void add_results(Html& html, const StudyReport& report, const Words& words) {
    html.element("h2", words("Results", "Ergebnisse"), {{"class", "cut"}});
    add_values(html, report, words);
    add_judged(html, report, words);
    add_changes(html, report, words);
    add_new_shadow(html, report, words);
}

}  // namespace skybake::io
