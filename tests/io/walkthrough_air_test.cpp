// viewer/test/data/air.json: tables and views of the C++ side, by which the walkthrough's tests judge its own formula.
// After a change of the formula: SKYBAKE_UPDATE_GOLDEN=1 walkthrough_air_test, then make test.
#include <Imath/half.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/manifest/web_pages.h"
#include "sky/aerial_perspective.h"
#include "sky/daylight_settings.h"

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;

const char* const kFile = SKYBAKE_VIEWER_TEST_DATA "/air.json";
const char* const kSkies[] = {"preetham:turbidity=2", "preetham:turbidity=8", "perez:dni=300,dhi=200"};
constexpr int kColumns = 8;
constexpr int kRows = 12;

Air air_of(const char* sky, double azimuth_deg, double elevation_deg) {
    FindingLog unheard;
    DaylightSettings settings;
    settings.sky = parse_sky(sky);
    settings.sun_direction = SunDirection{radians_from_degrees(azimuth_deg), radians_from_degrees(elevation_deg)};
    return air_under(make_daylights(settings, std::nullopt, 0.0, unheard).at(0), kColumns, kRows);
}

float number_of(std::uint16_t bits) {
    Imath::half value;
    value.setBits(bits);
    return static_cast<float>(value);
}

/// Little-endian halves in hexadecimal, R, G, B, 1, kcd/m², as in light/i0_air.bin.
std::string to_hex(const std::vector<Rgb>& table) {
    std::string hex;
    const auto append = [&](float kcd) {
        const std::uint16_t bits = half_from_float(kcd);
        hex += fmt::format("{:02x}{:02x}", bits & 0xff, bits >> 8);
    };
    for (const Rgb& value : table) {
        for (int c = 0; c < 3; ++c) append(1e-3f * value[c]);
        append(1.0f);
    }
    return hex;
}

std::vector<Rgb> from_hex(const std::string& hex) {
    std::vector<Rgb> table;
    for (std::size_t i = 0; i + 16 <= hex.size(); i += 16) {
        Rgb value(0.0f);
        for (int c = 0; c < 3; ++c) {
            const unsigned long bytes = std::stoul(hex.substr(i + 4 * static_cast<std::size_t>(c), 4), nullptr, 16);
            value[c] = 1e3f * number_of(static_cast<std::uint16_t>((bytes >> 8) | ((bytes & 0xff) << 8)));
        }
        table.push_back(value);
    }
    return table;
}

Json to_json(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

/// The air as the walkthrough gets it, its tables rounded to halves, and what one sees through it.
Json truth_of(const char* sky, Air air, const Vec3d& sun) {
    const std::string hex = to_hex(air.molecule_airlight) + to_hex(air.haze_airlight);
    air.molecule_airlight = from_hex(to_hex(air.molecule_airlight));
    air.haze_airlight = from_hex(to_hex(air.haze_airlight));
    Json views = Json::array();
    for (const double height : {2.0, 60.0, 900.0}) {
        for (const Vec3d& towards : {sun, Vec3d(-sun), Vec3d(0, 1, 0), Vec3d(0.8, -0.6, 0.0), Vec3d(-0.3, 0.5, -0.04),
                                     Vec3d(0.1, 0.1, -1.0)}) {
            for (const double distance : {10.0, 300.0, 2000.0, 30'000.0}) {
                const Vec3d direction = glm::normalize(towards);
                if (height + distance * direction.z < 0.0) continue;
                const AerialView view = view_through(air, height, direction, distance);
                views.push_back({{"height_m", height},
                                 {"direction", to_json(direction)},
                                 {"distance_m", distance},
                                 {"transmittance", to_json(Vec3d(view.transmittance))},
                                 {"inscatter_kcd_m2", to_json(1e-3 * Vec3d(view.inscatter))}});
            }
        }
    }
    return {{"sky", sky},
            {"pole", to_json(air.pole)},
            {"air",
             {{"turbidity", 3.0},
              {"base_m", 0.0},
              {"molecules_per_m", to_json(air.scattering.molecules)},
              {"haze_per_m", to_json(air.scattering.haze)},
              {"molecule_height_m", kMoleculeHeight},
              {"haze_height_m", kHazeHeight},
              {"airlight",
               {{"uri", "light/i0_air.bin"},
                {"columns", air.columns},
                {"rows", air.rows},
                {"format", "rgba16f"},
                {"unit", "kcd/m2"}}}}},
            {"airlight", hex},
            {"views", views}};
}

/// All numbers of two documents agree within `tolerance` of their size, all else exactly.
void expect_near(const Json& value, const Json& expected, double tolerance, const std::string& where) {
    ASSERT_EQ(value.type_name(), std::string(expected.type_name())) << where;
    ASSERT_EQ(value.size(), expected.size()) << where;
    if (value.is_number()) {
        EXPECT_NEAR(value.get<double>(), expected.get<double>(), tolerance * (1.0 + std::abs(expected.get<double>())))
            << where;
    } else if (value.is_structured()) {
        for (auto it = value.begin(), other = expected.begin(); it != value.end(); ++it, ++other)
            expect_near(*it, *other, tolerance, where + "/");
    } else {
        EXPECT_EQ(value, expected) << where;
    }
}

TEST(WalkthroughAir, FileHoldsWhatTheCodeSays) {
    Json skies = Json::array();
    for (const auto& [azimuth, elevation] : {std::pair{200.0, 35.0}, {95.0, 4.0}, {180.0, 75.0}}) {
        const char* sky = kSkies[skies.size()];
        const Air air = air_of(sky, azimuth, elevation);
        skies.push_back(truth_of(sky, air, air.pole));
    }
    if (std::getenv("SKYBAKE_UPDATE_GOLDEN")) {
        std::ofstream(kFile) << Json{{"skies", skies}}.dump() << '\n';
        GTEST_SKIP() << "wrote " << kFile;
    }
    std::ifstream file(kFile);
    ASSERT_TRUE(file) << kFile;
    Json stored = Json::parse(file).at("skies");
    ASSERT_EQ(stored.size(), skies.size());
    for (std::size_t i = 0; i < skies.size(); ++i) {
        // Halves have 11 bits; sums may be rounded to another one on another machine.
        const std::vector<Rgb> tables = from_hex(skies[i].at("airlight"));
        const std::vector<Rgb> stored_tables = from_hex(stored[i].at("airlight"));
        ASSERT_EQ(tables.size(), stored_tables.size());
        for (std::size_t t = 0; t < tables.size(); ++t)
            EXPECT_LE(glm::length(tables[t] - stored_tables[t]), 2e-3f * glm::length(tables[t]));
        stored[i].erase("airlight");
        skies[i].erase("airlight");
        expect_near(skies[i], stored[i], 2e-3, kSkies[i]);
    }
}

}  // namespace
}  // namespace skybake::io
