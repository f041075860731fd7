// `skybake study --texels`: the layers of a bake against the bake's own light, against points, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "box_city.h"
#include "io/exr/exr.h"
#include "io/image/image.h"
#include "io/manifest/read_bake.h"
#include "io/manifest/write_layers.h"
#include "json_schema.h"
#include "run_program.h"

namespace skybake {
namespace {

using testing::HasSubstr;

class StudyTexels : public testing::Test {
  protected:
    StudyTexels() {
        std::ofstream(place / "city.json") << box_city({{"house", {-5, -5, 0, 5, 5, 6}}}, true);
        std::ofstream(place / "tower.json") << box_city({{"tower", {-5, -25, 0, 5, -15, 40}}}, false);
    }
    std::string run(std::vector<std::string> arguments, int exit_code = 0) {
        Running program(place, arguments);
        EXPECT_EQ(program.exit_code(), exit_code) << program.err();
        return exit_code == 0 ? program.out() : program.err();
    }
    void bake(std::vector<std::string> files) {
        std::vector<std::string> words{"bake"};
        for (const std::string& file : files) words.push_back(place.str(file));
        for (const char* word : {"--texel", "1", "--sky", "uniform:luminance=1000", "--sky-samples", "1024",
                                 "--sun-direction", "180,40", "-o"})
            words.push_back(word);
        words.push_back(place.str("bake"));
        run(words);
    }
    nlohmann::json manifest() { return nlohmann::json::parse(text_of(place / "bake" / "manifest.json")); }
    nlohmann::json layer(const std::string& id) {
        const nlohmann::json all = manifest();
        for (const nlohmann::json& entry : all.at("layers")) {
            if (entry.at("id") == id) return entry;
        }
        ADD_FAILURE() << "no layer " << id;
        return {};
    }
    std::vector<float> values_of(const nlohmann::json& entry) {
        io::ExrReader reader(place / "bake" / entry.at("pages")[0].at("exr").get<std::string>());
        std::vector<float> values(static_cast<std::size_t>(reader.width()) * static_cast<std::size_t>(reader.height()));
        reader.read(std::vector<io::ExrReader::Target>{{{"value", io::ExrType::float32}, values.data(), 1}});
        return values;
    }
    TemporaryFolder place;
};

TEST_F(StudyTexels, SeeTheSkyThatTheBakeSees) {
    bake({"city.json", "tower.json"});
    std::ofstream(place / "sky.json") << nlohmann::json{{"skybake_rule", 1},
                                                        {"id", "Sky view"},
                                                        {"version", "1.0.0"},
                                                        {"title", "Sky view"},
                                                        {"source", "test"},
                                                        {"source_date", "2026"},
                                                        {"confirmed", {"nothing"}},
                                                        {"to_check", {"nothing"}},
                                                        {"receivers", {{"kinds", {"point"}}}},
                                                        {"metrics", {"sky_view_factor"}}};
    run({"study", place.str("city.json"), place.str("tower.json"), "--rule", place.str("sky.json"), "--texels",
         place.str("bake")});
    const nlohmann::json entry = layer("sky-view_sky_view_factor");
    const std::vector<float> values = values_of(entry);
    const LightmapPage base = io::read_base(io::open_bake(place / "bake"), 0);
    ASSERT_EQ(values.size(), base.state.size());
    const io::Image8 picture = io::read_image(place / "bake" / entry.at("pages")[0].at("png").get<std::string>());
    EXPECT_EQ(picture.channels, 1);
    const double least = entry["minimum"], step = (entry["maximum"].get<double>() - least) / 255.0;
    double sum2 = 0.0;
    std::size_t count = 0, gutters = 0;
    for (std::size_t t = 0; t < values.size(); ++t) {
        ASSERT_EQ(std::isnan(values[t]), base.state[t] != TexelState::chart) << t;
        if (base.state[t] == TexelState::empty) continue;
        if (base.state[t] == TexelState::chart) {
            const double apart = static_cast<double>(values[t] - base.sky_view_factor[t]);
            sum2 += apart * apart;
            ++count;
            // Half a grey level.
            EXPECT_NEAR(least + step * picture.pixels[t], static_cast<double>(values[t]), 0.501 * step) << t;
        } else {
            // Gutters are filled with what is beside them in their chart, not with black.
            float low = 1.0f, high = 0.0f;
            for (int k = 0; k < 49; ++k) {
                const std::size_t n = t + (k % 7 - 3) + static_cast<std::size_t>((k / 7 - 3) * base.width);
                if (n >= values.size() || base.chart[n] != base.chart[t] || std::isnan(values[n])) continue;
                low = std::min(low, values[n]);
                high = std::max(high, values[n]);
            }
            if (low > high) continue;
            ++gutters;
            EXPECT_GE(least + step * picture.pixels[t], static_cast<double>(low) - 0.501 * step) << t;
            EXPECT_LE(least + step * picture.pixels[t], static_cast<double>(high) + 0.501 * step) << t;
        }
    }
    // The bake counts 1,024 directions, the study 4,096: by the rates of docs/benchmarks.md 0.5 % and less.
    EXPECT_LT(std::sqrt(sum2 / static_cast<double>(count)), 0.01);
    EXPECT_GT(count, 10000u);
    EXPECT_GT(gutters, 1000u);
}

TEST_F(StudyTexels, TellWhatATowerTakes) {
    const std::vector<std::string> study{
        "study",    place.str("city.json"), "--add", place.str("tower.json"), "--days", "03-21",
        "--texels", place.str("bake"),      "--json"};
    const auto check = [&](bool has_tower) {
        const nlohmann::json report = nlohmann::json::parse(run(study));
        const nlohmann::json schema = nlohmann::json::parse(text_of(SKYBAKE_SCHEMA_FOLDER "/manifest.schema.json"));
        check_schema(schema, schema, manifest(), "manifest");
        EXPECT_EQ(manifest()["layers"].size(), report["layers"].size());
        const nlohmann::json entry = layer("shadow-study_sun_hours_2026-03-21_change");
        EXPECT_EQ(entry["kind"], "diverging");
        EXPECT_EQ(entry["title"]["de"], "Stunden direkter Sonne, Änderung, 21. März 2026 (shadow-study)");
        // No change is within its class, as the picture has it.
        const double least = entry["minimum"], most = entry["maximum"];
        const double grey = std::round(255.0 * (0.0 - least) / (most - least));
        const double none = least + (most - least) * grey / 255.0;
        const auto above = std::find_if(entry["edges"].begin(), entry["edges"].end(),
                                        [](const nlohmann::json& edge) { return edge.get<double>() > 0.0; });
        EXPECT_LT(std::abs(none), above->get<double>());
        EXPECT_EQ(*(above - 1), -above->get<double>());
        EXPECT_EQ(least, -most);
        const std::vector<float> change = values_of(entry),
                                 after = values_of(layer("shadow-study_sun_hours_2026-03-21"));
        const LightmapPage base = io::read_base(io::open_bake(place / "bake"), 0);
        std::size_t of_tower = 0, lost = 0;
        for (std::size_t t = 0; t < change.size(); ++t) {
            if (base.state[t] != TexelState::chart) continue;
            EXPECT_FALSE(std::isnan(after[t])) << t;
            if (std::isnan(change[t])) {
                ++of_tower;
                continue;
            }
            EXPECT_LE(change[t], 1e-4f) << t;  // nothing but shadow was added
            lost += change[t] < -0.5f;
        }
        // Four walls of 10 × 40 m, the roof and, facing down, the floor.
        EXPECT_EQ(of_tower, has_tower ? 1800u : 0u);
        EXPECT_GT(lost, 500u);
    };
    bake({"city.json", "tower.json"});
    check(true);
    check(true);  // in place of the first
    bake({"city.json"});
    EXPECT_FALSE(manifest().contains("layers"));
    EXPECT_FALSE(std::filesystem::exists(place / "bake" / "layers" / "shadow-study_sun_hours_2026-03-21_0.exr"));
    check(false);
}

TEST_F(StudyTexels, RefuseAnotherCity) {
    bake({"city.json"});
    EXPECT_THAT(run({"study", place.str("tower.json"), "--texels", place.str("bake")}, 2),
                HasSubstr("was not baked from these files, but from city.json"));
    EXPECT_THAT(run({"study", place.str("city.json"), "--exclude", "house", "--texels", place.str("bake")}, 2),
                HasSubstr("its texels are not those of this city"));
    EXPECT_THAT(run({"study", place.str("city.json"), "--texels", place.str("bake"), "-o", place.str("out")}, 2),
                HasSubstr("leave out -o"));
    EXPECT_THAT(run({"study", place.str("city.json"), "--texels", place.str("none")}, 2), HasSubstr("is no folder"));
    EXPECT_FALSE(manifest().contains("layers"));
}

}  // namespace
}  // namespace skybake
