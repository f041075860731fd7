// The sections of a study's report. Private to the folder.
#pragma once

#include "io/html/html.h"
#include "io/study/study_html.h"

namespace skybake::io {

void add_task(Html& html, const StudyReport& report, const Words& words);
void add_rule(Html& html, const StudyReport& report, const Words& words);
void add_data(Html& html, const StudyReport& report, const Words& words);
void add_method(Html& html, const StudyReport& report, const Words& words);
void add_results(Html& html, const StudyReport& report, const Words& words);
void add_maps(Html& html, const StudyReport& report, const Words& words);
void add_skies(Html& html, const StudyReport& report, const Words& words);
void add_shadows(Html& html, const StudyReport& report, const Words& words);
void add_uncertainty(Html& html, const StudyReport& report, const Words& words);
void add_annex(Html& html, const StudyReport& report, const Words& words);

/// An unordered list of a style of the report's sheet.
void list(Html& html, const std::vector<std::string>& entries, std::string_view style = "plain");
/// "at least 2 h", "at most 45°, or 0.8 of the former value".
std::string threshold_text(const Criterion& criterion, const Words& words);
/// The columns that maps and tables tell first: those of the criteria's metrics, or the rule's sun, sky and energy.
std::vector<std::size_t> leading_columns(const Rule& rule, const Study& study);

}  // namespace skybake::io
