// Files of every format cut at every kilobyte: what states its length or closes its brackets is refused with its name;
// of lists of lines what is whole is read. Nothing else happens.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "cityjson/temporary_city.h"
#include "error_of.h"
#include "io/image/image.h"
#include "test_data.h"
#include "vector_file.h"

namespace skybake {
namespace {

using testing::HasSubstr;

std::string text_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

enum class Cut { is_refused, may_be_read };

/// Loads `whole` cut at every kilobyte, at most `most` times, evenly.
void expect_ends(const std::string& whole, const std::string& name, Cut cut, std::size_t most = 400) {
    const TemporaryFolder folder;
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 1024 / most) * 1024;
    std::size_t refused = 0;
    for (std::size_t size = 0; size < whole.size(); size += step) {
        const auto path = folder.write(name, whole.substr(0, size));
        const std::string error = error_of([&] { load(path); });
        refused += error != "no error";
        if (error != "no error") {
            EXPECT_THAT(error, HasSubstr(name)) << size;
        } else if (cut == Cut::is_refused) {
            ADD_FAILURE() << name << " of " << whole.size() << " bytes, cut at " << size
                          << ", is read as if it were whole";
        }
    }
    EXPECT_GT(refused, 0u) << "at least the empty one";
}

TEST(CutFiles, RealCitiesAndTiles) {
    struct File {
        const char* path;
        Cut cut;
        std::size_t most;
    };
    for (const File& file : {
             File{"data/fzk-haus-cityjson-textured/01-FZK-Haus-LoD2-Tex-no-Storey-CG30-V01_formatted.json",
                  Cut::is_refused, 400},
             File{"data/delft-3dbag/delft.city.json", Cut::is_refused, 100},
             File{"data/railway-templates-cityjsonseq/geom_temp.city.jsonl", Cut::may_be_read, 400},
             File{"data/lyon-obj-geometric-issues/palais_de_justice.obj", Cut::may_be_read, 400},
             File{"data/berlin-block-3dtiles/1511577738.buildings.b3dm", Cut::is_refused, 400},
             File{"data/berlin-block-3dtiles/1511577738.buildings.derived.glb", Cut::is_refused, 400},
             File{"data/broken/real/frankfurt_draco.b3dm", Cut::is_refused, 400},
             File{"data/goteborg-kronenhuset-measured/DEM_KR.tif", Cut::is_refused, 400},
             File{"data/goteborg-kronenhuset-measured/DEM_KR.derived.asc", Cut::is_refused, 100},
         }) {
        const auto path = test_data(file.path);
        SKYBAKE_NEEDS_DATA(path);
        expect_ends(text_of(path), path.filename().string(), file.cut, file.most);
    }
}

TEST(CutFiles, Footprints) {
    const TemporaryFolder folder;
    const std::filesystem::path place = folder.write("x", "").parent_path();
    for (const auto& [driver, name] :
         {std::pair("GeoJSON", "h.geojson"), {"GPKG", "h.gpkg"}, {"ESRI Shapefile", "h.shp"}}) {
        write_squares(place / name, driver, 400);
        EXPECT_EQ(load(place / name).city.objects.size(), 400u) << name;
        const std::string whole = text_of(place / name);
        // A shapefile's index and attributes stay whole beside it.
        for (std::size_t size = 0; size < whole.size(); size += 1024) {
            const auto path = folder.write(name, whole.substr(0, size));
            EXPECT_THAT(error_of([&] { load(path); }), HasSubstr(name)) << size << " of " << whole.size();
        }
    }
}

TEST(CutFiles, Pictures) {
    io::Image8 noise{200, 150, 3, {}};
    for (std::uint32_t i = 0; i < 200 * 150 * 3; ++i)
        noise.pixels.push_back(static_cast<std::uint8_t>(i * 2654435761u >> 24));
    const TemporaryFolder folder;
    const auto png = folder.write("a.png", "");
    io::write_png(png, noise);
    std::vector<std::string> pictures{text_of(png)};
    if (const auto jpeg = test_data("data/lyon-textured-house-citygml"); std::filesystem::exists(jpeg)) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(jpeg)) {
            if (entry.path().extension() == ".jpg") pictures.push_back(text_of(entry.path()));
        }
    }
    for (const std::string& whole : pictures) {
        const auto bytes = [&](std::size_t size) {
            return std::span(reinterpret_cast<const std::uint8_t*>(whole.data()), size);
        };
        EXPECT_EQ(error_of([&] { io::decode_image(bytes(whole.size()), "a", 1u << 26); }), "no error");
        const std::size_t step = std::max<std::size_t>(1, whole.size() / 1024 / 100) * 1024;
        for (std::size_t size = 0; size < whole.size() - 2; size += step)
            EXPECT_THAT(error_of([&] { io::decode_image(bytes(size), "cut", 1u << 26); }), HasSubstr("cut: ")) << size;
    }
}

}  // namespace
}  // namespace skybake
