// Files that want to do harm, or that were: an error or a finding, soon, and nothing else.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>

#include "base/hash_rng.h"
#include "error_of.h"
#include "gml_text.h"
#include "test_data.h"

namespace skybake {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string error_of(const std::string& text) {
    return skybake::error_of([&] { load_gml(text); });
}

TEST(HostileCityGml, EntitiesAreRefused) {
    std::string laughs = "<!DOCTYPE CityModel [<!ENTITY a \"ha\">";
    for (char c = 'b'; c < 'k'; ++c) {
        laughs += std::string("<!ENTITY ") + c + " \"";
        for (int i = 0; i < 10; ++i) laughs += std::string("&") + static_cast<char>(c - 1) + ";";
        laughs += "\">";
    }
    laughs += "]>\n";
    EXPECT_THAT(error_of(gml_document(gml_building("<gml:name>&j;</gml:name>"), laughs)),
                AllOf(HasSubstr("a.gml:2: declares an entity ('a')"), HasSubstr("refused")));
    EXPECT_THAT(error_of(gml_document(gml_building("<gml:name>&x;</gml:name>"),
                                      "<!DOCTYPE CityModel [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>\n")),
                HasSubstr("declares an entity ('x')"));
}

TEST(HostileCityGml, DepthAndTagsAreBounded) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "<a>";
    EXPECT_THAT(error_of(gml_document(deep)), HasSubstr("nested more than 256 elements deep"));
    const std::string tag = "<a b=\"" + std::string(40u << 20, 'x') + "\"/>";
    EXPECT_THAT(error_of(gml_document(tag)), HasSubstr("holds a tag of more than 16 MB"));
}

TEST(HostileCityGml, ReferencesDoNotMultiply) {
    // Thirty sets, each naming the next one ten times.
    std::string sets;
    for (int i = 0; i < 30; ++i) {
        sets += "<gml:surfaceMember><gml:MultiSurface gml:id=\"s" + std::to_string(i) + "\">";
        for (int k = 0; k < 10; ++k) sets += refer("surfaceMember", fmt::format("s{}", i + 1));
        sets += "</gml:MultiSurface></gml:surfaceMember>";
    }
    const std::string solids = "<bldg:lod2Solid><gml:MultiSolid gml:id=\"m\">" + refer("solidMember", "m") +
                               refer("solidMember", "m") + "</gml:MultiSolid></bldg:lod2Solid>";
    const std::string both = "<bldg:lod2Geometry><gml:MultiGeometry gml:id=\"g\">" + refer("geometryMember", "g") +
                             refer("geometryMember", "g") + "</gml:MultiGeometry></bldg:lod2Geometry>";
    const auto begun = std::chrono::steady_clock::now();
    const LoadedCity city = load_gml(gml_document(
        gml_building("<bldg:lod2MultiSurface><gml:MultiSurface>" + surface_member(polygon(kFaces[1], "p")) + sets +
                     "</gml:MultiSurface></bldg:lod2MultiSurface>" + solids + both)));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(5));
    EXPECT_EQ(city.summary.surfaces, 1u);
    EXPECT_EQ(city.findings.count("SB120"), 10u) << "the last set names one that is not there";
}

TEST(HostileCityGml, NumbersThatAreNone) {
    for (const std::string positions :
         {"0 0 0 nan 0 0 1 1 0 0 0 0", "0 0 0 1e308 0 0 1 1 0 0 0 0", "0 0 0 -2147483648 0 0 1 1 0 0 0 0",
          "0 0 0 1e999 0 0 1 1 0 0 0 0", "0,5 0 0", "0 0 0 x"}) {
        const LoadedCity city = load_gml(gml_document(
            gml_building("<bldg:lod2MultiSurface><gml:MultiSurface>" + surface_member(polygon(positions)) +
                         surface_member(polygon(kFaces[1])) + "</gml:MultiSurface></bldg:lod2MultiSurface>")));
        EXPECT_EQ(city.summary.surfaces, 1u) << positions;
        EXPECT_GT(city.findings.count(Severity::error), 0u) << positions;
    }
}

TEST(HostileCityGml, WhatIsNoCityGmlIsRefusedByName) {
    EXPECT_THAT(error_of("<?xml version=\"1.0\"?>\n<kml><Document/></kml>"),
                HasSubstr("a.gml:2: is XML but no CityGML: its root is 'kml', not CityModel"));
    EXPECT_THAT(error_of("<CityModel>\n<a></b></CityModel>"),
                HasSubstr("a.gml:2: is not well-formed XML (mismatched tag)"));
    EXPECT_THAT(error_of("<?xml version=\"1.0\" encoding=\"klingon\"?><CityModel/>"), HasSubstr("unknown encoding"));
    EXPECT_EQ(load_gml("<CityModel/>").findings.count("SB117"), 1u);
}

/// Loads `text`; it must end in a city or in an error that names file and line.
void expect_clear_end(const TemporaryFolder& folder, const std::string& text, const std::string& how) {
    try {
        load(folder.write("broken.gml", text));
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("broken.gml")) << how;
    }
}

const char* const kRealFiles[] = {"data/lyon-textured-house-citygml/LYON_1ER_BATI_2015_small_house.gml",
                                  "data/ingolstadt-lod3-citygml/4018260/4018260.xml",
                                  "data/broken/val3dity/gml/csol1.gml"};

std::string text_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

TEST(HostileCityGml, RealFilesCutAtEveryKilobyte) {
    SKYBAKE_NEEDS_DATA(test_data(kRealFiles[0]));
    const TemporaryFolder folder;
    for (const char* file : kRealFiles) {
        const std::string text = text_of(test_data(file));
        for (std::size_t size = 0; size < text.size(); size += 1024) {
            try {
                load(folder.write("broken.gml", text.substr(0, size)));
                ADD_FAILURE() << file << " cut at " << size << " is read as if it were whole";
            } catch (const InputError& error) {
                EXPECT_THAT(error.what(), HasSubstr("broken.gml"));
            }
        }
    }
}

TEST(HostileCityGml, RealFilesWithGarbledBytes) {
    SKYBAKE_NEEDS_DATA(test_data(kRealFiles[0]));
    const TemporaryFolder folder;
    static constexpr std::string_view kBytes = "0<>\"#/ -.e9a&x\xff\0:=";
    for (const char* file : kRealFiles) {
        const std::string whole = text_of(test_data(file));
        for (std::uint64_t round = 0; round < 150; ++round) {
            std::string text = whole;
            const std::uint64_t seed = hash_of(file) + round;
            for (std::uint64_t i = 0; i <= round % 8; ++i) {
                const std::uint64_t at = hash_combine(seed, 2 * i) % text.size();
                text[at] = kBytes[hash_combine(seed, 2 * i + 1) % kBytes.size()];
            }
            expect_clear_end(folder, text, std::string(file) + " round " + std::to_string(round));
        }
    }
}

TEST(HostileCityGml, RealFilesWithPiecesMovedAndRepeated) {
    SKYBAKE_NEEDS_DATA(test_data(kRealFiles[0]));
    const TemporaryFolder folder;
    for (const char* file : kRealFiles) {
        const std::string whole = text_of(test_data(file));
        // Whole tags change places, so that the XML often stays well-formed and the reader itself is tried.
        std::vector<std::pair<std::size_t, std::size_t>> numbers;
        for (std::size_t at = whole.find('>'); at != std::string::npos; at = whole.find('>', at + 1)) {
            const std::size_t end = whole.find('<', at);
            if (end != std::string::npos && end > at + 1) numbers.emplace_back(at + 1, end - at - 1);
        }
        for (std::uint64_t round = 0; round < 150; ++round) {
            const std::uint64_t seed = hash_of(file) + 7 * round;
            const auto [from, length] = numbers[hash_combine(seed, 0) % numbers.size()];
            const auto [to, replaced] = numbers[hash_combine(seed, 1) % numbers.size()];
            std::string text = whole;
            text.replace(to, replaced, round % 3 == 0 ? "" : whole.substr(from, length));
            expect_clear_end(folder, text, std::string(file) + " round " + std::to_string(round));
        }
    }
}

}  // namespace
}  // namespace skybake
