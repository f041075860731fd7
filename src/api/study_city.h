// A city's study from files to results: what the verb `study` does between its options and its tables.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/load_city.h"
#include "io/study/study_tables.h"
#include "sky/weather.h"
#include "study/roll_up.h"
#include "study/study.h"

namespace skybake {

struct StudyRequest {
    std::vector<std::filesystem::path> city;
    std::vector<std::filesystem::path> added;   // files of the plan
    std::vector<std::filesystem::path> before;  // another city as the former state
    std::vector<std::string> plan;              // objects of the city that are the plan
    std::vector<std::string> removed;           // objects that the plan takes away
    LoadOptions load;

    Rule rule;
    std::filesystem::path rule_file;
    ReceiverOptions receivers;  // without polygons, and without kinds: then the rule's
    std::optional<std::filesystem::path> polygons;
    std::optional<Site> site;  // instead of the CRS's
    std::optional<Weather> weather;
    Period period;
    StudySettings settings;  // site, convergence and year_light are filled in here
};

struct StudyResult {
    Study study;
    std::vector<Group> groups;  // of all levels
    io::StudyFacts facts;
    FindingLog findings;
};

/// Loads, builds both states, computes and judges. Throws InputError for what makes the study impossible, before long
/// work: no place on Earth, a rule without what it needs (former state, weather, plan), a day without sun, no
/// receivers, unknown objects, a former state in another reference system.
StudyResult study_city(StudyRequest request, Progress& progress);

/// The files of the shipped rules in a folder, by their ids ("bre209-vsc"); sorted.
std::vector<std::string> shipped_rules(const std::filesystem::path& folder);

/// A rule's file: NAME.json in `folder`, or the path itself. Throws InputError, naming the nearest shipped rule.
std::filesystem::path rule_file_of(const std::string& name, const std::filesystem::path& folder);

}  // namespace skybake
