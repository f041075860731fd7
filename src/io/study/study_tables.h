// A study's results as tables and as a report (docs/formats.md, "Studies").
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/roll_up.h"
#include "study/study.h"

namespace skybake::io {

/// cells.csv: a line a sample: receiver, place, normal, area, columns, and value, margin and verdict of each criterion.
void write_cells_csv(const std::filesystem::path& path, const Rule& rule, const Study& study);

/// groups.csv: a line a group of any level: mean, least and greatest of each column, shares and verdict of each
/// criterion, the group's verdict.
void write_groups_csv(const std::filesystem::path& path, const Rule& rule, const Study& study,
                      const std::vector<Group>& groups);

/// new_shadow.csv: a line a receiver, day and episode: enter and exit (UTC), minutes, and the totals of the receiver.
void write_new_shadow_csv(const std::filesystem::path& path, const Study& study);

/// cells.gpkg and ground.tif with all columns and verdicts (geodata/geodata.h).
void write_cells_gpkg(const std::filesystem::path& path, const Rule& rule, const Study& study, const std::string& crs);
bool write_ground_tiff(const std::filesystem::path& path, const Study& study, const std::string& crs);

/// What the report says besides the tables.
struct StudyFacts {
    std::string program_version;
    std::string embree_isa;
    std::string rule_file;
    std::vector<std::filesystem::path> inputs;  // every file that was read; hashed here
    std::string crs;
    StudySettings settings;
    ReceiverOptions receivers;
    std::optional<std::string> weather;  // where light of the year comes from
    std::vector<std::string> plan, removed;
    bool has_before = false;
};

/// The report as JSON: rule whole, inputs with SHA-256, settings, days, receivers, results
/// by kind and building, new shadow. Nothing in it hangs on the clock or the machine but the instruction set's name.
nlohmann::json study_report(const Rule& rule, const Study& study, const std::vector<Group>& groups,
                            const StudyFacts& facts);

/// The unit of a metric as tables and maps name it: "h", "%", "1", "kWh/m2", "deg".
const char* unit_of(Metric metric);

}  // namespace skybake::io
