// Where tests find real cities and reference tables; a test that needs an absent file says so and is skipped.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace skybake {

/// A file below the data folder ("data/delft-3dbag/delft.city.json", "reference/solar_position.csv"). SKYBAKE_DATA
/// overrides the folder.
inline std::filesystem::path test_data(const std::string& relative) {
    const char* folder = std::getenv("SKYBAKE_DATA");
    return std::filesystem::path(folder ? folder : SKYBAKE_TEST_DATA_DEFAULT) / relative;
}

}  // namespace skybake

/// In a test: skips it, naming the file, when the file is absent.
#define SKYBAKE_NEEDS_DATA(path)        \
    if (!std::filesystem::exists(path)) \
    GTEST_SKIP() << "absent: " << (path) << " (set SKYBAKE_DATA to the folder that holds data/ and reference/)"
