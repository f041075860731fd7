// skybake study --verify: does a report hold?
#pragma once

#include <filesystem>

#include "program.h"

namespace skybake::cli {

/// Computes the sample rows of a report.json anew from the same inputs, and compares them and the hashes of the tables
/// beside it. Prints what agrees; kDone when all does, else kDifference. Throws InputError for a report that is none,
/// and when an input is missing or has changed since.
int verify_study(const CommonOptions& common, const std::filesystem::path& report);

}  // namespace skybake::cli
