// Do a study's tables follow from each other? groups.csv and all verdicts are made again from cells.csv.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "study/roll_up.h"
#include "study/study.h"

namespace skybake::io {

/// What six digits leave open, of a number: half a unit of the sixth digit is 5·10⁻⁶ at most, in each of two tables.
inline constexpr double kTableDigits = 2e-5;

/// The study as cells.csv tells it: receivers, columns (those of `columns`, without their values there) and verdicts as
/// the rule gives them anew. Numbers have the six digits of the table. Throws InputError where the file is broken or
/// lacks a column.
struct TableStudy {
    Study study;
    std::uint64_t verdicts = 0;  // of cells, that were told
    std::vector<std::string>
        other_verdicts;  // that the rule does not give: "cell 12 of ID: CRITERION is fail, not pass"
};
TableStudy read_cells_csv(const std::filesystem::path& path, const Rule& rule, const std::vector<Column>& columns);

/// What of groups.csv does not follow from the groups (2·10⁻⁵ of a number for the digits of both tables); adds the
/// number of its lines to `rows`. Throws InputError where the file is broken.
std::vector<std::string> check_groups_csv(const std::filesystem::path& path, const Rule& rule, const Study& study,
                                          const std::vector<Group>& groups, std::uint64_t& rows);

}  // namespace skybake::io
