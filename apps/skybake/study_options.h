// The options of `skybake study`: from the command line to a request, and back to the words that make it again.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/study_city.h"
#include "city_options.h"
#include "io/study/report_words.h"
#include "light_options.h"

namespace skybake::cli {

struct StudyOptions {
    CityOptions city;
    std::string rule = "shadow-study";
    bool lists_rules = false;
    std::filesystem::path output, verified, texels;
    std::vector<std::string> receivers;
    std::filesystem::path points, polygons, weather;
    double cell_m = 1.0, storey_height_m = 3.0;
    std::optional<double> height_m, min_elevation_deg;
    std::string days, step, site, timezone, months;
    int year = 2026;
    double scan_s = 60.0;
    int sky_directions = 4096;
    double ground_albedo = 0.2;
    std::vector<std::string> metrics;
    std::string at, sky = kDefaultSky, albedo;
    int paths = 64, bounces = 8;
    std::vector<std::filesystem::path> added, before;
    std::vector<std::string> plan, removed;
    bool leaves_out_cells = false;
    io::Language language = io::Language::english;
};

/// Where the shipped rules lie, beside the program.
std::filesystem::path rules_folder();

/// Declares all options; `options` must outlive the parsing.
void add_study_options(CLI::App* verb, StudyOptions& options);

/// The request, with rule, points and weather read; `seed` is of the paths. Throws InputError for what cannot be.
StudyRequest study_request(const StudyOptions& options, std::uint64_t seed, FindingLog& weather_findings);

/// Every file that the study reads, hashed, with its path as seen from `folder` (a shipped rule by its bare name).
std::vector<io::StudyInput> study_inputs(const StudyOptions& options, const std::filesystem::path& folder);

/// The words that make the study again: what was typed but where results go and how they are told, files as seen from
/// `folder`.
std::vector<std::string> study_arguments(const CLI::App& verb, const StudyOptions& options,
                                         const std::filesystem::path& folder);

/// The options of such words, their files as seen from here again. Throws InputError for unknown words.
void parse_study_arguments(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                           StudyOptions& options, std::uint64_t& seed);

}  // namespace skybake::cli
