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

/// cells.gpkg and ground.tif with all columns and verdicts (gdal/write_maps.h).
void write_cells_gpkg(const std::filesystem::path& path, const Rule& rule, const Study& study, const std::string& crs);
bool write_ground_tiff(const std::filesystem::path& path, const Study& study, const std::string& crs);

/// A file that a study read.
struct StudyInput {
    std::string role;  // "rule", "city", "plan", "before", "polygons", "points" or "weather"
    std::string file;  // relative to the report's folder
    std::uint64_t bytes = 0;
    std::string sha256;
};

/// What the report says besides the tables.
struct StudyFacts {
    std::string program_version;
    std::string embree_isa;
    std::vector<StudyInput> inputs;
    std::vector<std::string> arguments;  // of the command line that makes it again, files relative to the report
    std::string crs;
    StudySettings settings;
    ReceiverOptions receivers;
    Period period;
    std::vector<std::string> instants;   // "LABEL: SKY" of each
    std::optional<std::string> weather;  // where light of the year comes from
    std::vector<std::string> plan, removed;
    bool has_before = false;
    std::vector<StudyInput> tables;  // the tables beside the report; without role
};

/// The report as JSON (schema/study.schema.json): rule, inputs with SHA-256, command line, settings, days, receivers,
/// results by kind and building, new shadow, sample rows. Nothing in it hangs on the clock or the machine but the
/// instruction set's name.
inline constexpr std::size_t kReportPackets = 32;  // of at most 16 rows: those of sampled_packets (study_rows.h)
nlohmann::json study_report(const Rule& rule, const Study& study, const std::vector<Group>& groups,
                            const StudyFacts& facts);

}  // namespace skybake::io
