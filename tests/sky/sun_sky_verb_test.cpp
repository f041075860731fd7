// Runs the program: stdout, stderr and exit code of `skybake sun` and `skybake sky`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace {

using ::testing::HasSubstr;

struct Outcome {
    int exit_code = -1;
    std::string out;
    std::string err;
};

class SunSkyVerb : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("skybake-sun-sky-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    Outcome run(const std::string& arguments) const {
        const std::string command = std::string(SKYBAKE_PROGRAM) + " " + arguments + " 2>" + path("err");
        FILE* pipe = popen(command.c_str(), "r");
        Outcome outcome;
        char buffer[4096];
        for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.out.append(buffer, n);
        outcome.exit_code = WEXITSTATUS(pclose(pipe));
        std::stringstream err;
        err << std::ifstream(path("err")).rdbuf();
        outcome.err = err.str();
        return outcome;
    }

  private:
    std::filesystem::path folder_;
};

// Truth: NREL SPA's published example (DESIGN: keys of `sun --json`), up to the site's height and weather.
TEST_F(SunSkyVerb, SunGivesTheContractsKeys) {
    const Outcome one = run("sun --site 39.742476,-105.1786 --at 2003-10-17T12:30:30-07:00 --json");
    ASSERT_EQ(one.exit_code, 0) << one.err;
    const auto sun = nlohmann::json::parse(one.out);
    EXPECT_NEAR(sun["azimuth_deg"].get<double>(), 194.34024, 0.001);
    EXPECT_NEAR(sun["elevation_deg"].get<double>(), 39.87205, 0.001);
    EXPECT_GT(sun["apparent_elevation_deg"].get<double>(), sun["elevation_deg"].get<double>());
    EXPECT_NEAR(sun["distance_au"].get<double>(), 0.99654, 1e-5);
    EXPECT_NEAR(sun["equation_of_time_min"].get<double>(), 14.6415, 0.001);
    EXPECT_EQ(sun["beam_rgb"].size(), 3u);
    EXPECT_GT(sun["dni_w_m2"].get<double>(), 600.0);
    EXPECT_NEAR(0.2126 * sun["beam_rgb"][0].get<double>() + 0.7152 * sun["beam_rgb"][1].get<double>() +
                    0.0722 * sun["beam_rgb"][2].get<double>(),
                sun["direct_normal_lx"].get<double>(), 1.0);

    const Outcome many = run("sun --site 47,15 --at 2026-06-21T04:00Z/2026-06-21T20:00Z/1h --json --quiet");
    ASSERT_EQ(many.exit_code, 0) << many.err;
    const auto list = nlohmann::json::parse(many.out);
    EXPECT_EQ(list["instants"].size(), 17u);
    EXPECT_FALSE(list.contains("azimuth_deg"));
}

TEST_F(SunSkyVerb, WrongUseEndsWithTwoAndSaysWhatToDo) {
    const Outcome no_site = run("sun --at 2026-06-21T12:00Z");
    EXPECT_EQ(no_site.exit_code, 2);
    EXPECT_EQ(no_site.out, "");
    EXPECT_THAT(no_site.err, HasSubstr("give --site LAT,LON"));
    const Outcome no_sun = run("sky");
    EXPECT_EQ(no_sun.exit_code, 2);
    EXPECT_THAT(no_sun.err, HasSubstr("give --at TIME"));
    const Outcome typo = run("sky --sun-direction 180,45 --directons d.csv");
    EXPECT_EQ(typo.exit_code, 2);
    EXPECT_THAT(typo.err, HasSubstr("--directions"));
    std::ofstream(path("bad.csv")) << "azimuth_deg,elevation_deg\n10,20\n10,120\n";
    const Outcome bad = run("sky --sun-direction 180,45 --directions " + path("bad.csv"));
    EXPECT_EQ(bad.exit_code, 2);
    EXPECT_THAT(bad.err, HasSubstr("bad.csv:3: elevation_deg is '120', not a number in -90…90"));
    EXPECT_EQ(run("sky --sun-direction 180,45 -o " + path("sky.jpg")).exit_code, 2);
}

// Truth: the contract's columns; a uniform sky is L above the horizon with the chromaticity of D65, and 0 below.
TEST_F(SunSkyVerb, SkyAnswersDirections) {
    std::ofstream(path("d.csv")) << "\xef\xbb\xbf"
                                 << "id,azimuth_deg,elevation_deg\r\na,0,90\r\n\"b,c\",10.50,-5\r\n";
    const Outcome sky = run("sky --sky uniform:luminance=1000 --directions " + path("d.csv"));
    ASSERT_EQ(sky.exit_code, 0) << sky.err;
    std::stringstream lines(sky.out);
    std::string header, first, second;
    std::getline(lines, header);
    std::getline(lines, first);
    std::getline(lines, second);
    EXPECT_EQ(header, "azimuth_deg,elevation_deg,luminance_cd_m2,r,g,b,x,y,id");
    double luminance = 0, r = 0, g = 0, b = 0, x = 0, y = 0;
    ASSERT_EQ(std::sscanf(first.c_str(), "0,90,%lf,%lf,%lf,%lf,%lf,%lf,a", &luminance, &r, &g, &b, &x, &y), 6);
    EXPECT_NEAR(luminance, 1000.0, 1e-3);
    EXPECT_NEAR(r, 1000.0, 0.1);
    EXPECT_NEAR(b, 1000.0, 0.1);
    EXPECT_NEAR(x, 0.3127, 1e-4);
    EXPECT_NEAR(y, 0.3290, 1e-4);
    EXPECT_EQ(second, "10.50,-5,0,0,0,0,,,\"b,c\"");
}

TEST_F(SunSkyVerb, SkyWritesPanoramasAndSums) {
    EXPECT_EQ(run("sky --sun-direction 90,30 --width 64 -o " + path("sky.png")).exit_code, 0);
    EXPECT_EQ(run("sky --sun-direction 90,30 --width 64 -o " + path("sky.exr")).exit_code, 0);
    EXPECT_GT(std::filesystem::file_size(path("sky.png")), 200u);
    EXPECT_GT(std::filesystem::file_size(path("sky.exr")), 200u);
    EXPECT_EQ(run("sky --sun-direction 90,30 --width 64 --projection fisheye -o " + path("dome.png")).exit_code, 0);
    EXPECT_THAT(run("sky --sun-direction 90,30 --projection fish -o " + path("dome.png")).err,
                HasSubstr("did you mean 'fisheye'?"));
    const auto sums = nlohmann::json::parse(run("sky --sky uniform:luminance=1000 --json").out);
    EXPECT_NEAR(sums["diffuse_horizontal_lx"].get<double>(), 1000.0 * std::acos(-1.0), 0.1);
}

// Truth: the contract's forms of --sky; a panorama that was written is read as the sky it shows.
TEST_F(SunSkyVerb, EveryModelAnswersAndAPanoramaIsASky) {
    for (const char* sky : {"preetham:turbidity=2", "perez:dni=600,dhi=120", "cie:type=7", "cie:type=1,dhi=90",
                            "cie1994:clear", "cie1994:turbid", "cie1994:intermediate", "cie1994:overcast,dhi=120"}) {
        const Outcome outcome = run(std::string("sky --sun-direction 200,35 --json --sky ") + sky);
        ASSERT_EQ(outcome.exit_code, 0) << sky << outcome.err;
        const auto sums = nlohmann::json::parse(outcome.out);
        EXPECT_GT(sums["diffuse_horizontal_lx"].get<double>(), 5000.0) << sky;
        EXPECT_LT(sums["diffuse_horizontal_lx"].get<double>(), 40000.0) << sky;
    }
    const std::string perez = "sky --sun-direction 200,35 --sky perez:dni=600,dhi=120 ";
    ASSERT_EQ(run(perez + "--sun none --width 512 -o " + path("p.exr")).exit_code, 0);
    ASSERT_EQ(run(perez + "--width 512 -o " + path("sun.exr")).exit_code, 0);
    const auto image_lx = [&](const char* picture) {
        const Outcome image = run("sky --json --sky image:" + path(picture));
        EXPECT_EQ(image.exit_code, 0) << image.err;
        return nlohmann::json::parse(image.out)["diffuse_horizontal_lx"].get<double>();
    };
    const auto sums = nlohmann::json::parse(run(perez + "--json").out);
    const double sky_alone = sums["diffuse_horizontal_lx"].get<double>();
    EXPECT_NEAR(image_lx("p.exr"), sky_alone, 2e-3 * sky_alone);
    // With the sun in it, the picture gives all the light; its pixels are 0.7°, a hundredth of the height's sine.
    const double global = sums["global_horizontal_lx"].get<double>();
    EXPECT_NEAR(image_lx("sun.exr"), global, 1e-2 * global);
    const Outcome absent = run("sky --sky image:" + path("absent.hdr"));
    EXPECT_EQ(absent.exit_code, 2);
    EXPECT_THAT(absent.err, HasSubstr("absent.hdr: there is no such file"));
}

TEST_F(SunSkyVerb, ADayIsAStrip) {
    const std::string day = "sky --site 47,15 --at 2026-06-21T06:00Z/2026-06-21T18:00Z/6h ";
    const Outcome strip = run(day + "--width 32 -o " + path("day.png"));
    ASSERT_EQ(strip.exit_code, 0) << strip.err;
    EXPECT_THAT(strip.err, HasSubstr("32 x 24, 3 skies from top to bottom"));
    EXPECT_THAT(run(day + "--width 32 --projection fisheye -o " + path("day.exr")).err, HasSubstr("96 x 32, 3 skies"));
    EXPECT_EQ(nlohmann::json::parse(run(day + "--json").out)["instants"].size(), 3u);
    std::ofstream(path("d.csv")) << "azimuth_deg,elevation_deg\n10,20\n";
    EXPECT_THAT(run(day + "--directions " + path("d.csv")).err, HasSubstr("--directions answers for one"));
}

}  // namespace
