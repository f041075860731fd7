// `skybake probe` against light that is known in closed form, from a city file to the CSV.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "run_program.h"

namespace skybake {
namespace {

constexpr double kL = 1000.0;  // cd m⁻²
constexpr double kOpen = std::numbers::pi * kL;

/// A city of boxes on level ground of ±`reach` metres, in EPSG:31256.
class BoxCity {
  public:
    explicit BoxCity(double reach) {
        const int v = vertex(-reach, -reach, 0);
        vertex(reach, -reach, 0), vertex(reach, reach, 0), vertex(-reach, reach, 0);
        objects_["ground"] = {{"type", "TINRelief"},
                              {"geometry",
                               {{{"type", "CompositeSurface"},
                                 {"lod", "1"},
                                 {"boundaries", {{{v, v + 1, v + 2}}, {{v, v + 2, v + 3}}}}}}}};
    }
    BoxCity& box(std::array<double, 3> lo, std::array<double, 3> hi) {
        const int v = static_cast<int>(vertices_.size());
        for (const double z : {lo[2], hi[2]}) {
            vertex(lo[0], lo[1], z), vertex(hi[0], lo[1], z), vertex(hi[0], hi[1], z), vertex(lo[0], hi[1], z);
        }
        nlohmann::json faces = nlohmann::json::array();
        for (const std::array<int, 4>& f : {std::array{3, 2, 1, 0}, std::array{4, 5, 6, 7}, std::array{0, 1, 5, 4},
                                            std::array{1, 2, 6, 5}, std::array{2, 3, 7, 6}, std::array{3, 0, 4, 7}})
            faces.push_back({{v + f[0], v + f[1], v + f[2], v + f[3]}});
        objects_["box-" + std::to_string(v)] = {
            {"type", "Building"},
            {"geometry", {{{"type", "Solid"}, {"lod", "1"}, {"boundaries", nlohmann::json::array({faces})}}}}};
        return *this;
    }
    std::string text() const {
        return nlohmann::json{{"type", "CityJSON"},
                              {"version", "2.0"},
                              {"metadata", {{"referenceSystem", "https://www.opengis.net/def/crs/EPSG/0/31256"}}},
                              {"transform", {{"scale", {0.001, 0.001, 0.001}}, {"translate", {kX, kY, 0.0}}}},
                              {"CityObjects", objects_},
                              {"vertices", vertices_}}
            .dump();
    }
    static constexpr double kX = -67000.0, kY = 215000.0;

  private:
    int vertex(double x, double y, double z) {
        vertices_.push_back({std::llround(x * 1000), std::llround(y * 1000), std::llround(z * 1000)});
        return static_cast<int>(vertices_.size()) - 1;
    }
    nlohmann::json objects_, vertices_ = nlohmann::json::array();
};

/// One column of the CSV for a point of the city under a uniform sky.
std::map<std::string, double> probe(const BoxCity& city, std::array<double, 3> p, std::array<double, 3> n,
                                    std::vector<std::string> options) {
    const TemporaryFolder place;
    std::ofstream(place / "c.city.json") << city.text();
    std::ofstream points(place / "p.csv");
    points.precision(12);
    points << "id,x,y,z,nx,ny,nz\na," << p[0] + BoxCity::kX << ',' << p[1] + BoxCity::kY << ',' << p[2] << ',' << n[0]
           << ',' << n[1] << ',' << n[2] << '\n';
    points.close();
    std::vector<std::string> arguments{"probe", place.str("c.city.json"), "--points", place.str("p.csv"),
                                       "--sky", "uniform:luminance=1000", "--sun",    "none"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Running program(place, arguments);
    EXPECT_EQ(program.exit_code(), 0) << program.err();
    std::istringstream rows(program.out());
    std::string header, row;
    std::getline(rows, header);
    std::getline(rows, row);
    std::istringstream names(header), values(row);
    std::map<std::string, double> columns;
    std::getline(names, header, ',');
    std::getline(values, row, ',');
    for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
        columns[name] = std::stod(value);
    return columns;
}

/// Skylight in lux at a point of the city under a uniform sky, as the CSV tells it.
double sky_at(const BoxCity& city, std::array<double, 3> p, std::array<double, 3> n, int samples) {
    return probe(city, p, n, {"--sky-samples", std::to_string(samples)}).at("sky_lx");
}

/// Lamps by the inverse square law, and their light reflected once by open ground into nothing: all of it is direct.
TEST(ProbeVerbLamps, FollowTheInverseSquare) {
    const TemporaryFolder place;
    const auto lamps = [&](double x, double y, const std::string& rest) {
        return nlohmann::json::parse(R"({"id": "l)" + std::to_string(x) + R"(", "position": [)" +
                                     std::to_string(x + BoxCity::kX) + "," + std::to_string(y + BoxCity::kY) + ",4]," +
                                     rest + "}");
    };
    std::ofstream(place / "lamps.json") << nlohmann::json{
        {"lamps",
         {lamps(0, 0, R"("type": "point", "intensity_cd": 1000, "color_temperature_k": 3000)"),
          lamps(3, 0,
                R"("type": "spot", "flux_lm": 628.3185307, "direction": [0, 0, -1], "cone_half_angle_deg": 90)")}}};
    const auto light = probe(BoxCity(50), {0, 0, 0}, {0, 0, 1}, {"--lamps", place.str("lamps.json")});
    // The spot shines into half of all directions: 100 cd, at 5 m under the cosine 0.8.
    EXPECT_NEAR(light.at("lamps_lx"), 1000.0 / 16.0 + 100.0 * 0.8 / 25.0, 0.02);
    EXPECT_NEAR(light.at("total_lx"), light.at("sky_lx") + light.at("lamps_lx"), 0.02);
    std::ofstream(place / "broken.json") << R"({"lamps": [{"id": "a", "type": "point", "position": [0, 0, 0]}]})";
    std::ofstream(place / "c.city.json") << BoxCity(50).text();
    std::ofstream(place / "p.csv") << "id,x,y,z,nx,ny,nz\n";
    Running refused(place, {"probe", place.str("c.city.json"), "--points", place.str("p.csv"), "--sky",
                            "uniform:luminance=1000", "--sun", "none", "--lamps", place.str("broken.json")});
    EXPECT_EQ(refused.exit_code(), 2);
    EXPECT_NE(refused.err().find("lamp 1: needs one of 'intensity_cd' and 'flux_lm'"), std::string::npos)
        << refused.err();
}

/// A free wall before open ground of albedo 0.3 gets, from below, half of ρπL by one reflection.
TEST(ProbeVerbIndirect, GroundLightsAWall) {
    const auto light = probe(BoxCity(1500).box({-5, -5, 0}, {5, 5, 20}), {0, -5, 10}, {0, -1, 0},
                             {"--indirect", "reference", "--bounces", "1", "--paths", "20000", "--albedo", "0.3"});
    const double truth = 0.5 * 0.3 * kOpen;
    // The box hides part of the sky from the ground before it: as much as a tenth at its foot, far less on the whole.
    EXPECT_NEAR(light.at("indirect_lx"), truth, 4.0 * light.at("indirect_error_lx") + 0.1 * truth);
    EXPECT_LT(light.at("indirect_lx"), truth);
    EXPECT_GT(light.at("indirect_error_lx"), 0.0);
    EXPECT_NEAR(light.at("total_lx"), light.at("sky_lx") + light.at("indirect_lx"), 1e-2);
}

struct SamplesAndBound {
    int samples;
    double bound;  // relative, of the value
};
class ProbeVerb : public testing::TestWithParam<SamplesAndBound> {
  protected:
    void expect(double light, double truth) {
        RecordProperty("error", std::to_string(light / truth - 1.0));
        std::printf("%d directions: %.2f lx, in closed form %.2f, %+.3f %%\n", GetParam().samples, light, truth,
                    100.0 * (light / truth - 1.0));
        EXPECT_NEAR(light, truth, GetParam().bound * truth);
    }
};
INSTANTIATE_TEST_SUITE_P(DefaultAndFine, ProbeVerb,
                         testing::Values(SamplesAndBound{1024, 0.01}, SamplesAndBound{4096, 0.003}));

TEST_P(ProbeVerb, OpenGroundGetsPiL) {
    expect(sky_at(BoxCity(200), {3, 2, 0}, {0, 0, 1}, GetParam().samples), kOpen);
}

TEST_P(ProbeVerb, WallGetsHalf) {
    expect(sky_at(BoxCity(200).box({-5, -5, 0}, {5, 5, 20}), {0, -5, 10}, {0, -1, 0}, GetParam().samples), kOpen / 2);
}

TEST_P(ProbeVerb, FootOfALongWallGetsHalf) {
    expect(sky_at(BoxCity(1500).box({-1000, 0, 0}, {1000, 10, 2000}), {0, -0.05, 0}, {0, 0, 1}, GetParam().samples),
           kOpen / 2);
}

TEST_P(ProbeVerb, CanyonFloorIsOneOverRootOfOnePlusFourHSquaredOverWSquared) {
    for (const double h : {5.0, 10.0}) {
        const BoxCity city = BoxCity(1200).box({-1000, 5, 0}, {1000, 15, h}).box({-1000, -15, 0}, {1000, -5, h});
        expect(sky_at(city, {0, 0, 0}, {0, 0, 1}, GetParam().samples), kOpen / std::sqrt(1.0 + 4.0 * h * h / 100.0));
    }
}

}  // namespace
}  // namespace skybake
