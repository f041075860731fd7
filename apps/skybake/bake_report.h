// The figures of a bake for --json.
#pragma once

#include <nlohmann/json.hpp>

#include "bake/bake_report.h"

namespace skybake::cli {

/// The keys that scripts rely on; see docs/formats.md.
nlohmann::json to_json(const BakeReport& report);

}  // namespace skybake::cli
