// `skybake study` from city files to tables, maps and verdicts, and how it refuses what it cannot do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "box_city.h"
#include "json_schema.h"
#include "run_program.h"

namespace skybake {
namespace {

using testing::HasSubstr;
using testing::Not;

class StudyVerb : public testing::Test {
  protected:
    StudyVerb() {
        std::ofstream(place / "city.json") << box_city({{"house", {-5, -5, 0, 5, 5, 6}}}, true);
        std::ofstream(place / "bare.json") << box_city({{"house", {-5, -5, 0, 5, 5, 6}}}, false);
        std::ofstream(place / "tower.json") << box_city({{"tower", {-5, -25, 0, 5, -15, 40}}}, false);
        std::ofstream(place / "park.geojson") << park(kX, kY, "31256");
        std::ofstream(place / "away.geojson") << park(0.0, 0.0, "31256");
    }
    /// A park of 20 × 10 m north of where the tower is to stand.
    static nlohmann::json park(double x, double y, const std::string& epsg) {
        const double x0 = x + 10, y0 = y - 20;
        return {{"type", "FeatureCollection"},
                {"crs", {{"type", "name"}, {"properties", {{"name", "urn:ogc:def:crs:EPSG::" + epsg}}}}},
                {"features",
                 {{{"type", "Feature"},
                   {"properties", {{"id", "park"}}},
                   {"geometry",
                    {{"type", "Polygon"},
                     {"coordinates", {{{x0, y0}, {x0 + 20, y0}, {x0 + 20, y0 + 10}, {x0, y0 + 10}, {x0, y0}}}}}}}}}};
    }
    nlohmann::json json_of(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "study");
        arguments.push_back("--json");
        Running program(place, arguments);
        EXPECT_EQ(program.exit_code(), 0) << program.err();
        return nlohmann::json::parse(program.out());
    }
    std::string refusal(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "study");
        Running program(place, arguments);
        EXPECT_EQ(program.exit_code(), 2) << program.out();
        return program.err();
    }
    TemporaryFolder place;
};

TEST_F(StudyVerb, WritesTablesMapsAndReport) {
    const nlohmann::json report =
        json_of({place.str("city.json"), "-o", place.str("out"), "--receivers", "ground,facades"});
    EXPECT_EQ(report["skybake_study"], 1);
    EXPECT_EQ(report["samples"], 120 * 120 - 100 + 4 * 10 * 6);
    EXPECT_EQ(report["crs"], "EPSG:31256");
    EXPECT_EQ(report["inputs"][0]["sha256"].get<std::string>().size(), 64u);
    EXPECT_EQ(report["rule"]["id"], "shadow-study");
    for (const char* file : {"cells.csv", "groups.csv", "cells.gpkg", "ground.tif", "report.json"})
        EXPECT_TRUE(std::filesystem::exists(place / "out" / file)) << file;
    EXPECT_FALSE(std::filesystem::exists(place / "out" / "new_shadow.csv"));
    const std::string cells = text_of(place / "out" / "cells.csv");
    EXPECT_EQ(std::count(cells.begin(), cells.end(), '\n'), 120 * 120 - 100 + 240 + 1);
    EXPECT_THAT(cells.substr(0, cells.find('\n')), HasSubstr("sun_hours_03-21,longest_sun_hours_03-21"));
    // The same bits for another number of threads.
    json_of({place.str("city.json"), "-o", place.str("one"), "--receivers", "ground,facades", "--threads", "1"});
    EXPECT_EQ(text_of(place / "one" / "cells.csv"), cells);
    EXPECT_EQ(text_of(place / "one" / "report.json"), text_of(place / "out" / "report.json"));
}

TEST_F(StudyVerb, TowerThrowsNewShadow) {
    const nlohmann::json report =
        json_of({place.str("city.json"), "--rule", "nyc-ceqr", "--add", place.str("tower.json"), "--polygons",
                 place.str("park.geojson"), "-o", place.str("out")});
    EXPECT_EQ(report["plan"], nlohmann::json::array({"tower"}));
    ASSERT_FALSE(report["new_shadow"].empty());
    EXPECT_EQ(report["new_shadow"][0]["receiver"], "park");
    // The park lies east of the tower: its shadow falls there in the afternoon, after 11 UTC (noon at 15.4° east).
    for (const nlohmann::json& shadow : report["new_shadow"]) {
        EXPECT_GT(shadow["enter"].get<std::string>().substr(11, 5), "10:00") << shadow;
        EXPECT_GT(shadow["minutes"].get<double>(), 10.0);
    }
    EXPECT_THAT(text_of(place / "out" / "new_shadow.csv"), HasSubstr("park,polygon,,2026-12-21,2026-12-21T"));
    // The same with the tower in the city and named as the plan, and the other way round.
    const nlohmann::json named = json_of({place.str("city.json"), place.str("tower.json"), "--rule", "nyc-ceqr",
                                          "--plan", "tower", "--polygons", place.str("park.geojson")});
    EXPECT_EQ(named["new_shadow"], report["new_shadow"]);
    const nlohmann::json gone = json_of({place.str("city.json"), place.str("tower.json"), "--rule", "nyc-ceqr",
                                         "--remove", "tower", "--polygons", place.str("park.geojson")});
    EXPECT_TRUE(gone["new_shadow"].empty());
}

/// A report that anybody can open and print: one file, no script, no link; a hostile id is text.
TEST_F(StudyVerb, ReportIsOneSafeFile) {
    std::ofstream(place / "evil.json") << box_city({{"<script>alert(1)</script>\"&", {-5, -5, 0, 5, 5, 6}}}, true);
    json_of({place.str("evil.json"), "--rule", "en17037-sunlight", "--add", place.str("tower.json"), "-o",
             place.str("out")});
    const std::string html = text_of(place / "out" / "report.html");
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;&quot;&amp;"));
    for (const char* reference : {"src=\"", "href=\"http", "@import", "<link", "url("})
        EXPECT_THAT(html, Not(HasSubstr(reference)));
    for (const char* part :
         {"To be checked before relying on a verdict", "SHA-256", "at least 1.5 h", "What the plan changes",
          "Affected: less than before", "Better than before", "New shadow: enter and exit", "The sky of chosen places",
          "Shadows by the hour", "Uncertainty", "--rule=en17037-sunlight"})
        EXPECT_THAT(html, HasSubstr(part));
    json_of({place.str("evil.json"), "--rule", "en17037-sunlight", "--lang", "de", "-o", place.str("de")});
    const std::string german = text_of(place / "de" / "report.html");
    EXPECT_THAT(german, HasSubstr("<html lang=\"de\">"));
    EXPECT_THAT(german, HasSubstr("mindestens 1,5 h"));
    // The rule's own texts, too.
    EXPECT_THAT(german, HasSubstr("<h1>EN 17037: Besonnung</h1>"));
    EXPECT_THAT(german, HasSubstr("Die Sonne zählt ab dieser geometrischen Höhe"));
    for (const char* english : {"exposure to sunlight", "at least", "The text of the standard"})
        EXPECT_THAT(german, Not(HasSubstr(english)));
    // Levels that are not required are no failures.
    EXPECT_THAT(german, HasSubstr("verdict reported"));
    EXPECT_THAT(german, HasSubstr("erreicht (nicht verbindlich)"));
}

TEST_F(StudyVerb, VerifiesItsReport) {
    json_of({place.str("city.json"), "--rule", "nyc-ceqr", "--add", place.str("tower.json"), "--polygons",
             place.str("park.geojson"), "-o", place.str("out")});
    const std::string report = place.str("out") + "/report.json";
    const nlohmann::json held = json_of({"--verify", report});
    EXPECT_EQ(held["agrees"], true);
    EXPECT_EQ(held["rows"], 200);  // a park of 20 × 10 m
    EXPECT_EQ(held["equal_values"], held["values"]);

    // A number that was made better by hand.
    nlohmann::json forged = nlohmann::json::parse(text_of(report));
    double& value = forged["rows"][7]["values"][0].get_ref<double&>();
    value += 0.1;
    std::ofstream(report) << forged;
    Running differs(place, {"study", "--verify", report});
    EXPECT_EQ(differs.exit_code(), 1);
    EXPECT_THAT(differs.err(), HasSubstr("cell 7 of park: sun_hours_12-21"));
    EXPECT_THAT(differs.out(), HasSubstr("does not agree: 200 rows"));
    value -= 0.1;

    // A table that was edited, and one that is gone.
    std::ofstream(report) << forged;
    std::ofstream(place / "out" / "cells.csv", std::ios::app) << "x\n";
    std::filesystem::remove(place / "out" / "groups.csv");
    Running edited(place, {"study", "--verify", report});
    EXPECT_EQ(edited.exit_code(), 1);
    EXPECT_THAT(edited.err(), HasSubstr("cells.csv is not the table"));
    EXPECT_THAT(edited.out(), HasSubstr("not here to compare: groups.csv"));

    std::ofstream(place / "tower.json", std::ios::app) << " ";
    EXPECT_THAT(refusal({"--verify", report}), HasSubstr("its plan '../tower.json' has changed since"));
    std::filesystem::remove(place / "tower.json");
    EXPECT_THAT(refusal({"--verify", report}), HasSubstr("tower.json"));
    std::ofstream(report) << "{}";
    EXPECT_THAT(refusal({"--verify", report}), HasSubstr("is no report of skybake study"));
    std::ofstream(report) << R"({"skybake_study": 1})";
    EXPECT_THAT(refusal({"--verify", report}), HasSubstr("is damaged"));
}

TEST_F(StudyVerb, VerifiesItsSummaries) {
    json_of({place.str("city.json"), "--rule", "bre209-vsc", "--receivers", "facades", "--add", place.str("tower.json"),
             "-o", place.str("out")});
    const auto verified = [&](int exit_code) {
        Running program(place, {"study", "--verify", place.str("out/report.json"), "--json"});
        EXPECT_EQ(program.exit_code(), exit_code) << program.err();
        return nlohmann::json::parse(program.out());
    };
    const nlohmann::json good = verified(0);
    const std::string groups = text_of(place / "out" / "groups.csv"), cells = text_of(place / "out" / "cells.csv");
    EXPECT_EQ(good["groups"], std::count(groups.begin(), groups.end(), '\n') - 1);
    EXPECT_EQ(good["verdicts"], std::count(cells.begin(), cells.end(), '\n') - 1);
    // Someone betters a summary, and the hash beside it.
    const std::string report = text_of(place / "out" / "report.json");
    const auto tampered = [&](const std::string& text, const std::string& from, const std::string& to) {
        std::string other = text;
        const std::size_t at = other.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return at == std::string::npos ? other : other.replace(at, from.size(), to);
    };
    const std::size_t kind = groups.find("\nkind,");
    const std::string row = groups.substr(kind, groups.find('\n', kind + 1) - kind);
    const std::string mean = row.substr(row.find(",fail,") + 6, 4);
    std::ofstream(place / "out" / "groups.csv") << tampered(groups, ",fail," + mean, ",fail,9" + mean);
    EXPECT_THAT(verified(1)["differences"].dump(), HasSubstr("in groups.csv, and"));
    std::ofstream(place / "out" / "groups.csv") << groups;
    const nlohmann::json told = nlohmann::json::parse(report);
    nlohmann::json bettered = told;
    bettered["buildings"][0]["verdict"] = told["buildings"][0]["verdict"] == "pass" ? "fail" : "pass";
    std::ofstream(place / "out" / "report.json") << bettered;
    EXPECT_THAT(verified(1)["differences"].dump(), HasSubstr("building house: the report says"));
    // The same study makes the same report, to the last byte of each file.
    json_of({place.str("city.json"), "--rule", "bre209-vsc", "--receivers", "facades", "--add", place.str("tower.json"),
             "-o", place.str("again")});
    for (const char* file : {"report.html", "cells.csv", "groups.csv", "city.city.json"}) {
        EXPECT_EQ(text_of(place / "again" / file), text_of(place / "out" / file)) << file;
    }
    EXPECT_EQ(text_of(place / "again" / "report.json"), report);
}

TEST_F(StudyVerb, ReportsKeepTheirSchema) {
    const nlohmann::json schema = nlohmann::json::parse(text_of(SKYBAKE_SCHEMA_FOLDER "/study.schema.json"));
    json_of({place.str("city.json"), "--rule", "nyc-ceqr", "--add", place.str("tower.json"), "--polygons",
             place.str("park.geojson"), "-o", place.str("a")});
    json_of({place.str("city.json"), "--rule", "bre209-apsh", "--cell", "3", "--remove", "house", "--add",
             place.str("tower.json"), "--receivers", "ground", "--timezone", "Europe/Vienna", "--step", "30min", "-o",
             place.str("b"), "--no-cells"});
    for (const char* folder : {"a", "b"}) {
        const nlohmann::json report = nlohmann::json::parse(text_of(place / folder / "report.json"));
        check_schema(schema, schema, report, folder);
    }
    EXPECT_TRUE(std::filesystem::exists(place / "a" / "shadows.gpkg"));
    EXPECT_FALSE(std::filesystem::exists(place / "b" / "shadows.gpkg"));  // the rule has no days
}

TEST_F(StudyVerb, CityHasTheResultsAsAttributes) {
    nlohmann::json city = nlohmann::json::parse(text_of(place / "city.json"));
    city["CityObjects"]["house"]["attributes"] = {{"name", "Alte Mühle"}};
    std::ofstream(place / "city.json") << city;
    const nlohmann::json report =
        json_of({place.str("city.json"), "--rule", "bre209-vsc", "--receivers", "facades,roofs", "--add",
                 place.str("tower.json"), "--metrics", "sky_view_factor", "-o", place.str("out")});
    const std::string written = place.str("out/city.city.json");
    // Our own reader takes it without a finding, in the same reference system.
    Running check(place, {"check", written, "--json", "--strict"});
    EXPECT_EQ(check.exit_code(), 0) << check.err();
    const nlohmann::json checked = nlohmann::json::parse(check.out());
    EXPECT_EQ(checked["findings"], nlohmann::json::array());
    EXPECT_EQ(checked["buildings"], 2);
    EXPECT_THAT(checked["crs"].dump(), HasSubstr("31256"));
    const nlohmann::json result = nlohmann::json::parse(text_of(written));
    const nlohmann::json& house = result["CityObjects"]["house"];
    EXPECT_EQ(house["attributes"]["name"], "Alte Mühle");
    EXPECT_EQ(house["attributes"]["skybake_rule"], "bre209-vsc 1.0.0");
    EXPECT_EQ(house["attributes"]["skybake_verdict"], report["buildings"][0]["verdict"]);
    EXPECT_FALSE(result["CityObjects"]["tower"].contains("attributes"));  // the plan's own surfaces are no receivers
    // Four walls and a roof, each with its own numbers; the floor has none. In groups.csv they stand as facades.
    const nlohmann::json& semantics = house["geometry"][0]["semantics"];
    std::map<std::string, int> types;
    const std::string groups = text_of(place / "out" / "groups.csv");
    for (const nlohmann::json& surface : semantics["surfaces"]) {
        ++types[surface["type"].get<std::string>()];
        if (surface["type"] == "GroundSurface") {
            EXPECT_EQ(surface.size(), 1u);
            continue;
        }
        const double view = surface.at("skybake_sky_view_factor").get<double>();
        EXPECT_NEAR(view, surface["type"] == "RoofSurface" ? 0.95 : 0.4, 0.12);
        EXPECT_THAT(groups, HasSubstr("," + surface.at("skybake_sky_view_factor").dump() + ","));
    }
    EXPECT_EQ(types["WallSurface"], 4);
    EXPECT_EQ(types["RoofSurface"], 1);
    json_of({place.str("city.json"), "-o", place.str("none"), "--no-cells"});
    EXPECT_FALSE(std::filesystem::exists(place / "none" / "city.city.json"));
}

TEST_F(StudyVerb, MonthsAreAPeriod) {
    const auto sunshine = [&](const std::string& months) {
        return json_of(
            {place.str("city.json"), "--rule", "bre209-apsh", "--cell", "5", "--months", months})["kinds"][0];
    };
    EXPECT_EQ(sunshine("10-3"), sunshine("1,2,3,10-12"));
    EXPECT_NE(sunshine("4-9"), sunshine("10-3"));
    EXPECT_THAT(refusal({place.str("city.json"), "--months", "13"}), HasSubstr("--months '13'"));
    EXPECT_THAT(refusal({place.str("city.json"), "--months", "4-"}), HasSubstr("--months '4-'"));
}

TEST_F(StudyVerb, RefusesWhatItCannotDo) {
    EXPECT_THAT(refusal({place.str("city.json"), "--rule", "bre209"}), HasSubstr("did you mean 'bre209-vsc'"));
    EXPECT_THAT(refusal({place.str("city.json"), "--rule", "nyc-ceqr", "--polygons", place.str("park.geojson")}),
                HasSubstr("compares with the former state"));
    EXPECT_THAT(refusal({place.str("city.json"), "--rule", "zurich-3h-shadow", "--timezone", "Europe/Zurich"}),
                HasSubstr("shadow of the plan alone"));
    EXPECT_THAT(refusal({place.str("city.json"), "--rule", "nsw-adg"}), HasSubstr("pass --timezone"));
    EXPECT_THAT(refusal({place.str("bare.json"), "--receivers", "ground"}), HasSubstr("there is no receiver"));
    EXPECT_THAT(refusal({place.str("city.json"), "--receivers", "polygons", "--polygons", place.str("away.geojson")}),
                HasSubstr("its polygons lie at"));
    EXPECT_THAT(refusal({place.str("city.json"), "--days", "12-21", "--site", "71.3,-156.8"}),
                HasSubstr("on 2026-12-21 the sun does not come above"));
    EXPECT_THAT(refusal({place.str("city.json"), "--remove", "houze"}), HasSubstr("did you mean 'house'"));
    EXPECT_THAT(refusal({place.str("city.json"), "--step", "soon"}), HasSubstr("--step 'soon'"));
    EXPECT_THAT(refusal({}), HasSubstr("needs a CITY"));
    // Without ground between them a city and a hamlet 30 km apart: a raster of both at 1 m would hold 9e8 cells.
    std::ofstream(place / "hamlet.json") << box_city({{"hut", {29000, 29000, 0, 29010, 29010, 5}}}, false);
    nlohmann::json ground = nlohmann::json::parse(text_of(place / "hamlet.json"));
    ground["vertices"].insert(ground["vertices"].end(),
                              {{28990000, 28990000, 0}, {29020000, 28990000, 0}, {29020000, 29020000, 0}});
    ground["CityObjects"]["meadow"] = {
        {"type", "TINRelief"},
        {"geometry", {{{"type", "CompositeSurface"}, {"lod", "1"}, {"boundaries", {{{8, 9, 10}}}}}}}};
    std::ofstream(place / "hamlet.json") << ground;
    EXPECT_THAT(refusal({place.str("city.json"), place.str("hamlet.json"), "--receivers", "ground"}),
                HasSubstr("the areas lie far apart"));
}

TEST_F(StudyVerb, ListsItsRules) {
    Running program(place, {"study", "--list-rules"});
    EXPECT_EQ(program.exit_code(), 0);
    EXPECT_THAT(program.out(), HasSubstr("EN 17037: exposure to sunlight"));
}

}  // namespace
}  // namespace skybake
