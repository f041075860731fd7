// A study's report for humans: one HTML file with everything in it, that prints to A4.
#pragma once

#include <string>
#include <vector>

#include "base/finding.h"
#include "io/study/report_words.h"
#include "io/study/study_tables.h"
#include "study/study_pictures.h"

namespace skybake::io {

struct StudyReport {
    const Rule& rule;
    const Study& study;
    const std::vector<Group>& groups;  // of all levels
    const StudyFacts& facts;
    const StudyPictures& pictures;
    const FindingLog& findings;
};

/// Task, rule, data, method, results with tables, maps, skies and shadows, uncertainty, annex; no reference to any
/// other file, no script. Names of objects and files may hold anything: they are escaped.
std::string study_html(const StudyReport& report, Language language);

}  // namespace skybake::io
