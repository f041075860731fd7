// The option --weather in the verbs that compute light, and the diagram of `skybake sun`.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "program/run_program.h"

namespace skybake {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class WeatherVerb : public ::testing::Test {
  protected:
    /// One June day in Graz, each hour with other figures: DNI 10 h, DHI 100 + h.
    void SetUp() override {
        std::ofstream file(path("june.epw"), std::ios::binary);
        file << "LOCATION,Graz,ST,AUT,made,112900,47.0778,15.4489,1.0,378.8\r\nDATA "
                "PERIODS,1,1,Data,Sunday,6/21,6/21\r\n";
        for (int hour = 1; hour <= 24; ++hour) {
            const std::string row = fmt::format("2018,6,21,{},0,?9,26.7,15.8,51,97056,1149,1322,397,9999,{},{}", hour,
                                                10 * hour, 100 + hour);
            file << row << ",0,0,0,0,140,1.0,3,3,777.7,2000,9,999999999,5,0.0850,0,88,0.487,0.0,0.0\r\n";
        }
    }
    std::string path(const std::string& name) const { return folder_.str(name); }
    int run(const std::vector<std::string>& arguments) {
        Running program(folder_, arguments);
        const int exit_code = program.exit_code();
        out_ = program.out();
        err_ = program.err();
        return exit_code;
    }
    nlohmann::json json() const { return nlohmann::json::parse(out_); }

    TemporaryFolder folder_;
    std::string out_;
    std::string err_;
};

// Truth: the rows, at the middle of their hours (too few of them to find another one than the format's).
TEST_F(WeatherVerb, SkyAndSunTakeTheHour) {
    ASSERT_EQ(run({"sky", "--weather", path("june.epw"), "--at", "2026-06-21T12:30+02:00", "--json"}), 0) << err_;
    EXPECT_NEAR(json()["dhi_w_m2"].get<double>(), 112.0, 0.2);
    EXPECT_NEAR(json()["dni_w_m2"].get<double>(), 120.0, 0.01);
    EXPECT_EQ(json()["weather"]["city"], "Graz");
    EXPECT_THAT(err_, HasSubstr("SB711 info: june.epw: neither --site nor the city says where on Earth it is"));
    EXPECT_THAT(err_, HasSubstr("SB710"));

    ASSERT_EQ(run({"sun", "--weather", path("june.epw"), "--at", "2026-06-21T13:00+02:00", "--json", "--quiet"}), 0);
    EXPECT_NEAR(json()["dni_w_m2"].get<double>(), 125.0, 0.01);
    EXPECT_NEAR(json()["site"]["latitude_deg"].get<double>(), 47.0778, 1e-9);
    // 15.4489° east is 1 h 1 min 48 s, the equation of time −1 min 49 s.
    EXPECT_THAT(json()["solar_time"].get<std::string>(), HasSubstr("11:59:"));
}

TEST_F(WeatherVerb, SkyWithoutInstantTellsWhatTheFileHolds) {
    ASSERT_EQ(run({"sky", "--weather", path("june.epw"), "--json", "--quiet"}), 0) << err_;
    const auto weather = json()["weather"];
    EXPECT_EQ(weather["rows"], 24);
    EXPECT_EQ(weather["rows_left_out"], 0);
    EXPECT_EQ(weather["hour_centre_h"], -0.5);
    EXPECT_EQ(weather["hour_centre_detected"], false);
    EXPECT_NEAR(weather["sums_kwh_m2"]["direct_normal"].get<double>(), 3.0, 1e-9);
    EXPECT_NEAR(weather["sums_kwh_m2"]["diffuse_horizontal"].get<double>(), 2.7, 1e-9);
    ASSERT_EQ(run({"sky", "--weather", path("june.epw")}), 0);
    EXPECT_THAT(out_, HasSubstr("june.epw: Graz, ST, AUT (made, 112900)"));
    EXPECT_THAT(out_, HasSubstr("middle of the hours          label -0.5 h (as the format says; not detected)"));
}

TEST_F(WeatherVerb, ProbeAndBakeTakeTheHour) {
    ASSERT_EQ(run({"town", "-o", path("town.city.json"), "--buildings", "10", "--quiet"}), 0) << err_;
    std::ofstream(path("points.csv")) << "id,x,y,z,nx,ny,nz\nup,0,0,200,0,0,1\n";
    const std::vector<std::string> light = {"--weather", path("june.epw"), "--at", "2026-06-21T12:30+02:00", "--quiet"};
    std::vector<std::string> probe = {"probe", path("town.city.json"), "--points", path("points.csv")};
    probe.insert(probe.end(), light.begin(), light.end());
    ASSERT_EQ(run(probe), 0) << err_;
    double sun_lx = 0.0, sky_lx = 0.0;
    ASSERT_EQ(std::sscanf(out_.c_str() + out_.find("\nup,"), "\nup,%lf,%lf", &sun_lx, &sky_lx), 2) << out_;
    // What `sky` says of the same hour, but for some kilometres between town and station (0.1° of sun) and the
    // quadrature of the dome.
    std::vector<std::string> sky = {"sky", "--json"};
    sky.insert(sky.end(), light.begin(), light.end());
    ASSERT_EQ(run(sky), 0) << err_;
    const double diffuse_lx = json()["diffuse_horizontal_lx"], global_lx = json()["global_horizontal_lx"];
    EXPECT_NEAR(sky_lx, diffuse_lx, 5e-3 * diffuse_lx);
    EXPECT_NEAR(sun_lx, global_lx - diffuse_lx, 5e-3 * global_lx);

    std::vector<std::string> bake = {"bake", path("town.city.json"), "-o", path("lit"), "--texel",
                                     "4",    "--sky-samples",        "32"};
    bake.insert(bake.end(), light.begin(), light.end());
    ASSERT_EQ(run(bake), 0) << err_;
    const auto manifest = nlohmann::json::parse(text_of(folder_ / "lit/manifest.json"));
    EXPECT_EQ(manifest["settings"]["weather"], "june.epw");
    EXPECT_EQ(manifest["inputs"][1]["file"], "june.epw");
    EXPECT_NEAR(manifest["instants"][0]["sun"]["dni_w_m2"].get<double>(), 120.0, 1e-3);
    EXPECT_THAT(manifest["instants"][0]["sky"]["model"].get<std::string>(), HasSubstr("112"));
    EXPECT_THAT(manifest.dump(), Not(HasSubstr(path(""))));
}

TEST_F(WeatherVerb, RefusesWhatItCannotLight) {
    EXPECT_EQ(run({"sky", "--weather", path("absent.epw"), "--at", "2026-06-21T12:30+02:00"}), 2);
    EXPECT_THAT(err_, HasSubstr("absent.epw: cannot be read"));
    EXPECT_EQ(run({"sky", "--weather", path("june.epw"), "--at", "2026-07-21T12:30+02:00"}), 2);
    EXPECT_THAT(err_,
                HasSubstr("june.epw: there is no radiation for 2026-07-21T12:30:00+02:00. Choose another instant"));
    EXPECT_EQ(run({"sky", "--weather", path("june.epw"), "-o", path("sky.png")}), 2);
    EXPECT_THAT(err_, HasSubstr("--weather needs the hour of the sky: give --at TIME"));
    EXPECT_EQ(run({"sky", "--weather", path("june.epw"), "--sun-direction", "180,45"}), 2);
    EXPECT_EQ(run({"bake", path("absent.city.json"), "-o", path("lit"), "--weather", path("june.epw")}), 2);
    EXPECT_THAT(err_, HasSubstr("--weather needs to know the hour: give --at TIME"));
    std::ofstream(path("cut.epw")) << text_of(folder_ / "june.epw").substr(0, 400);
    EXPECT_EQ(run({"sky", "--weather", path("cut.epw"), "--strict"}), 1) << err_;
    EXPECT_THAT(err_, HasSubstr("SB701 error: cut.epw:"));
}

TEST_F(WeatherVerb, SunDrawsADiagram) {
    ASSERT_EQ(run({"sun", "--site", "47.07,15.44", "--timezone", "Europe/Vienna", "--at",
                   "2026-06-21T09:00,2026-06-21T23:30", "--diagram", path("graz.svg"), "--json"}),
              0)
        << err_;
    EXPECT_EQ(json()["diagram"], path("graz.svg"));
    const std::string svg = text_of(folder_ / "graz.svg");
    EXPECT_THAT(svg, HasSubstr("Sun path at 47.0700° N, 15.4400° E"));
    EXPECT_THAT(svg, HasSubstr("Hours: UTC+02:00 (Europe/Vienna)"));
    EXPECT_THAT(svg, HasSubstr("Marked: 2026-06-21"));
    EXPECT_THAT(svg, HasSubstr(">09:00</text>"));
    EXPECT_THAT(svg, HasSubstr("with refraction"));
    EXPECT_THAT(svg, HasSubstr("below the horizon: 1 of 2 instants"));

    ASSERT_EQ(run({"sun", "--site", "-33.9,151.2", "--diagram", path("sydney.svg")}), 0) << err_;
    EXPECT_THAT(text_of(folder_ / "sydney.svg"), HasSubstr("Hours: true solar time"));
    EXPECT_EQ(out_, "");

    EXPECT_EQ(run({"sun", "--diagram", path("a.svg")}), 2);
    EXPECT_THAT(err_, HasSubstr("--diagram needs a place: give --site LAT,LON"));
    EXPECT_EQ(run({"sun", "--site", "47,15", "--diagram", path("a.pdf")}), 2);
    EXPECT_THAT(err_, HasSubstr("the diagram is a .svg"));
    EXPECT_EQ(run({"sun", "--site", "47,15", "--diagram", path("a.svg"), "--projection", "stereo"}), 2);
    EXPECT_THAT(err_, HasSubstr("did you mean 'stereographic'?"));
    EXPECT_EQ(run({"sun", "--site", "47,15", "--diagram", path("a.svg"), "--diagram-hours", "clock"}), 2);
    EXPECT_THAT(err_, HasSubstr("give --timezone NAME"));
    EXPECT_EQ(run({"sun", "--sun-direction", "180,45", "--diagram", path("a.svg")}), 2);
    EXPECT_EQ(run({"sun", "--site", "47,15", "--diagram", path("absent/a.svg")}), 2);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.svg"));
}

}  // namespace
}  // namespace skybake
