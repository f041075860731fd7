// A city's study from files to results: what the verb `study` does between its options and its tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/prepared_study.h"
#include "io/study/study_tables.h"
#include "study/roll_up.h"
#include "study/study.h"
#include "study/study_pictures.h"

namespace skybake {

struct StudyResult {
    Study study;
    std::vector<Group> groups;              // of all levels
    std::optional<StudyPictures> pictures;  // where the request wants them
    std::optional<CityModel> city;          // where the request wants it
    io::StudyFacts facts;                   // inputs and arguments are the caller's to fill in
    FindingLog findings;
};

/// Loads, builds both states, computes and judges. Throws InputError as prepare_study does, before long work.
StudyResult study_city(const StudyRequest& request, Progress& progress);

/// The files of the shipped rules in a folder, by their ids ("bre209-vsc"); sorted.
std::vector<std::string> shipped_rules(const std::filesystem::path& folder);

/// A rule's file: NAME.json in `folder`, or the path itself. Throws InputError, naming the nearest shipped rule.
std::filesystem::path rule_file_of(const std::string& name, const std::filesystem::path& folder);

}  // namespace skybake
