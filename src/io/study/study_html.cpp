#include "io/study/study_html.h"

#include "io/study/html_parts.h"

namespace skybake::io {
namespace {

constexpr const char* kStyle = R"css(
@page { size: A4; margin: 15mm 14mm 16mm; }
* { box-sizing: border-box; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
body { font: 10.5pt/1.42 "DejaVu Sans", "Liberation Sans", Verdana, Arial, sans-serif; color: #1a1a1a; max-width: 182mm;
       margin: 8mm auto; padding: 0 4mm; }
@media print { body { margin: 0; padding: 0; max-width: none; font-size: 9pt; } .cut { break-before: page; } }
h1 { font-size: 1.75em; line-height: 1.2; margin: 0 0 .2em; }
h2 { font-size: 1.3em; margin: 1.6em 0 .5em; border-bottom: 2px solid #333; padding-bottom: .1em; break-after: avoid; }
h3 { font-size: 1.05em; margin: 1.2em 0 .4em; break-after: avoid; }
p, li { orphans: 3; widows: 3; overflow-wrap: anywhere; }
.lead { color: #444; margin: 0 0 1em; }
table { border-collapse: collapse; width: 100%; margin: .4em 0 1em; font-size: .86em; }
thead { display: table-header-group; }
tr { break-inside: avoid; }
th, td { padding: .25em .5em; border-bottom: 1px solid #ccc; text-align: left; vertical-align: top; overflow-wrap: break-word; }
th { border-bottom: 1.5px solid #333; background: #f2f2f2; font-weight: bold; overflow-wrap: break-word; hyphens: auto; }
td.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
td.pass, .pass { color: #17652d; font-weight: bold; }
td.fail, .fail { color: #a11226; font-weight: bold; }
td.borderline, .borderline { color: #8a5300; font-weight: bold; }
.verdicts { display: flex; flex-wrap: wrap; gap: .6em; margin: 1em 0; }
.verdict { border: 1.5px solid #333; border-left-width: 9px; padding: .5em .8em; flex: 1 1 40%; break-inside: avoid; }
.verdict.pass { border-color: #17652d; } .verdict.fail { border-color: #a11226; } .verdict.borderline { border-color: #b06a00; }
.verdict.reported { border-color: #777; }
.verdict * { color: #1a1a1a; font-weight: normal; } .verdict strong { font-weight: bold; }
figure { margin: .8em 0 1.2em; break-inside: avoid; } figcaption { font-size: .86em; color: #333; margin-top: .3em; }
svg { display: block; width: 100%; height: auto; } svg.map { max-height: 225mm; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 6mm; } .pair figure { margin: 0 0 .6em; }
.check li { list-style: none; } .check li::before { content: "☐ "; margin-left: -1.4em; }
code { font: .9em "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
.key { font: .8em "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
.plate { display: grid; grid-template-columns: 112mm 1fr; gap: 4mm; align-items: center; }
)css";

/// The rule with its texts in the language, where it has them.
Rule rule_in(Rule rule, Language language) {
    if (language == Language::english || !rule.german) return rule;
    rule.title = rule.german->title;
    rule.confirmed = rule.german->confirmed;
    rule.to_check = rule.german->to_check;
    for (std::size_t c = 0; c < rule.criteria.size(); ++c) rule.criteria[c].text = rule.german->criteria[c];
    return rule;
}

}  // namespace

std::string study_html(const StudyReport& results, Language language) {
    const Words words(language);
    const Rule rule = rule_in(results.rule, language);
    const StudyReport report{rule, results.study, results.groups, results.facts, results.pictures, results.findings};
    Html html;
    html.markup("<!DOCTYPE html>\n");
    html.open("html", {{"lang", words.code()}}).open("head");
    html.markup("<meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    html.element("title", report.rule.title).open("style").markup(kStyle).close("style").close("head").open("body");
    add_task(html, report, words);
    add_rule(html, report, words);
    add_data(html, report, words);
    add_method(html, report, words);
    add_results(html, report, words);
    add_maps(html, report, words);
    add_shadows(html, report, words);
    add_skies(html, report, words);
    add_uncertainty(html, report, words);
    add_annex(html, report, words);
    html.close("body").close("html");
    return html.str();
}

}  // namespace skybake::io
