// Illuminance and reflected light by `skybake study`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "box_city.h"
#include "run_program.h"

namespace skybake {
namespace {

using testing::HasSubstr;

class StudyLight : public testing::Test {
  protected:
    StudyLight() {
        std::ofstream(place / "city.json") << box_city({{"house", {-5, -5, 0, 5, 5, 6}}}, true);
        for (const auto& [name, albedo] : {std::pair{"white.json", 0.9}, {"black.json", 0.02}}) {
            nlohmann::json tower = box_city({{"tower", {-15, 20, 0, 15, 30, 40}}}, false);
            tower["appearance"] = {{"materials", {{{"name", "render"}, {"diffuseColor", {albedo, albedo, albedo}}}}}};
            tower["CityObjects"]["tower"]["geometry"][0]["material"] = {{"walls", {{"value", 0}}}};
            std::ofstream(place / name) << tower;
        }
        std::ofstream points(place / "points.csv");
        points << "id,x,y,z,nx,ny,nz\n";
        for (int i = 0; i < 5; ++i) {
            points << "n" << i << ',' << kX - 4 + 2 * i << ',' << kY + 5 << ",3,0,1,0\n";
            points << "g" << i << ',' << kX + 6 + i << ',' << kY + 8 << ",0,0,0,1\n";
        }
    }
    std::string run(std::vector<std::string> arguments, int exit_code = 0) {
        Running program(place, arguments);
        EXPECT_EQ(program.exit_code(), exit_code) << program.err();
        return exit_code == 0 ? program.out() : program.err();
    }
    /// Rows of a CSV by their first column.
    static std::map<std::string, std::map<std::string, std::string>> rows_of(const std::string& text) {
        std::istringstream lines(text);
        std::string line;
        std::getline(lines, line);
        const auto cells_of = [](const std::string& row) {
            std::vector<std::string> cells;
            std::istringstream stream(row);
            for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
            return cells;
        };
        const std::vector<std::string> header = cells_of(line);
        std::map<std::string, std::map<std::string, std::string>> rows;
        while (std::getline(lines, line)) {
            const std::vector<std::string> cells = cells_of(line);
            for (std::size_t c = 0; c < cells.size(); ++c) rows[cells[0]][header.at(c)] = cells[c];
        }
        return rows;
    }
    TemporaryFolder place;
};

TEST_F(StudyLight, IsThatOfTheProbe) {
    const std::vector<std::string> light{"--at",          "2026-06-21T15:00+02:00",
                                         "--points",      place.str("points.csv"),
                                         "--sky-samples", "512",
                                         "--paths",       "256",
                                         "--sky",         "perez:dni=600,dhi=150",
                                         "--seed",        "5"};
    std::vector<std::string> study{"study", place.str("city.json"), "--receivers", "points", "-o", place.str("out")};
    study.insert(study.end(), light.begin(), light.end());
    std::vector<std::string> probe{"probe", place.str("city.json"), "--indirect", "reference"};
    probe.insert(probe.end(), light.begin(), light.end());
    const auto probed = rows_of(run(probe));
    run(study);
    const auto studied = rows_of(text_of(place / "out" / "cells.csv"));
    ASSERT_EQ(studied.size(), 10u);
    for (const auto& [id, row] : studied) {
        for (const auto& [column, name] : {std::pair{"sun_lx", "sun_lx"},
                                           {"sky_lx", "sky_lx"},
                                           {"indirect_lx", "indirect_lx"},
                                           {"illuminance_lx", "total_lx"}}) {
            const double found = std::stod(row.at(std::string(column) + "_2026-06-21T15:00:00+02:00"));
            const double truth = std::stod(probed.at(id).at(name));
            // The same estimators, directions and paths: what is left is the six digits of the tables.
            EXPECT_NEAR(found, truth, 1e-5 * truth + 1e-3) << id << ' ' << column;
        }
    }
    EXPECT_GT(std::stod(studied.at("g4").at("sun_lx_2026-06-21T15:00:00+02:00")), 10000.0);
    EXPECT_THAT(text_of(place / "out" / "report.html"), HasSubstr("illuminance"));
    EXPECT_EQ(run({"study", "--verify", place.str("out/report.json")}).substr(0, 6), "agrees");
}

/// A house whose north side looks at a tower in the sun gains by a light façade what it does not by a dark one.
TEST_F(StudyLight, OfALightFacadeIsAGain) {
    const auto change_of = [&](const char* tower) {
        run({"study", place.str("city.json"), "--add", place.str(tower), "--receivers", "points", "--points",
             place.str("points.csv"), "--at", "2026-06-21T12:00+02:00", "--paths", "4096", "-o", place.str("out")});
        double change = 0.0;
        for (const auto& [id, row] : rows_of(text_of(place / "out" / "cells.csv"))) {
            if (id[0] != 'n') continue;
            const std::string column = "indirect_lx_2026-06-21T12:00:00+02:00";
            change += (std::stod(row.at(column)) - std::stod(row.at("before_" + column))) / 5.0;
        }
        return change;
    };
    const double white = change_of("white.json"), black = change_of("black.json");
    std::printf("reflected light on the north side: %+.0f lx by a white tower, %+.0f lx by a black one\n", white,
                black);
    EXPECT_GT(white, 1000.0);
    EXPECT_LT(black, 100.0);
}

TEST_F(StudyLight, SaysWhatItLacks) {
    EXPECT_THAT(run({"study", place.str("city.json"), "--metrics", "illuminance_lx"}, 2), HasSubstr("Pass --at TIME"));
    EXPECT_THAT(run({"study", place.str("city.json"), "--metrics", "indirect_kwh"}, 2),
                HasSubstr("did you mean 'indirect_kwh_m2'"));
    EXPECT_THAT(run({"study", place.str("city.json"), "--metrics", "indirect_kwh_m2"}, 2), HasSubstr("needs weather"));
}

}  // namespace
}  // namespace skybake
