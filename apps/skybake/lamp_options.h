// The settings of lamps, the same in every verb that computes light.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "base/vec.h"

namespace skybake::cli {

/// As typed.
struct LampOptions {
    std::filesystem::path file;  // empty: none
    std::string origin;          // of a glTF
};

/// --lamps and --lamps-origin.
void add_lamp_options(CLI::App* verb, LampOptions& options);

/// Map coordinates of a glTF's (0, 0, 0), when they were given. Throws InputError for other than three numbers.
std::optional<Vec3d> origin_of(const LampOptions& options);

}  // namespace skybake::cli
