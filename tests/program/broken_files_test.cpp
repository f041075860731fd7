// Every broken file ends in findings or in an error that says what is wrong: no signal, no hang.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_program.h"
#include "test_data.h"

namespace skybake {
namespace {

TEST(BrokenFiles, EndInFindingsOrAClearError) {
    const std::filesystem::path folder = test_data("data/broken");
    SKYBAKE_NEEDS_DATA(folder);
    const TemporaryFolder place;
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        for (const std::string verb : {"check", "bake"}) {
            std::vector<std::string> arguments{verb, entry.path().string()};
            if (verb == "bake") {
                for (const char* word : {"--texel", "2", "--sky", "uniform:luminance=1000", "--sun", "none", "-o"})
                    arguments.push_back(word);
                arguments.push_back(place.str("lit"));
            }
            Running program(place, arguments);
            const int code = program.exit_code();
            EXPECT_TRUE(code == 0 || code == 1 || code == 2) << verb << ' ' << entry.path() << ": " << code;
            if (code == 2) {
                EXPECT_THAT(program.err(), testing::HasSubstr(entry.path().filename().string()));
            }
            std::filesystem::remove_all(place / "lit");
        }
    }
    EXPECT_GT(files, 30);
}

}  // namespace
}  // namespace skybake
