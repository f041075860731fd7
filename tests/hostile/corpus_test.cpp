// Everything that fuzzing found, and what it began with: each file ends in a city, findings or an error, soon.
#include <gtest/gtest.h>

#include <ctime>

#include "cityjson/temporary_city.h"
#include "error_of.h"
#include "io/file/replace_file.h"
#include "io/image/image.h"

namespace skybake {
namespace {

TEST(FuzzCorpus, EachFileEnds) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(SKYBAKE_CORPUS)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const std::clock_t begun = std::clock();
        LoadOptions options;
        options.ground = GroundChoice::draped;
        error_of([&] {
            if (entry.path().parent_path().filename() == "image") {
                io::decode_image(io::read_file(entry.path()), "picture");
            } else {
                load(entry.path(), options);
            }
        });
        EXPECT_LT((std::clock() - begun) / CLOCKS_PER_SEC, 20) << entry.path();
    }
    EXPECT_GT(files, 100u);
}

}  // namespace
}  // namespace skybake
