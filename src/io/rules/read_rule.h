// Rules of sun and sky from JSON files (schema/rule.schema.json).
#pragma once

#include <filesystem>

#include "study/rule.h"

namespace skybake::io {

/// The version of the format that this program reads: the value of "skybake_rule".
inline constexpr int kRuleFormat = 1;

/// Reads a rule file. Throws InputError, naming file, place and remedy, for a file that is no JSON, another format
/// version, a key that nobody knows (naming the nearest), a value of the wrong kind or out of range, a metric that does
/// not exist, and a rule without its days.
Rule read_rule(const std::filesystem::path& path);

}  // namespace skybake::io
