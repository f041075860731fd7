// Photometric files of our own making: what they say, and what is said of broken ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "error_of.h"
#include "io/photometry/read_profile.h"
#include "scratch_folder.h"

namespace skybake::io {
namespace {

using testing::HasSubstr;

class Photometry : public testing::Test {
  protected:
    LightProfile read(const std::string& text) {
        std::ofstream(folder_ / "lamp.txt", std::ios::binary) << text;
        return read_profile(folder_ / "lamp.txt");
    }
    std::string error_of(const std::string& text) {
        return skybake::error_of([&] { read(text); });
    }
    ScratchFolder folder_{"photometry"};
};

/// Share at C and γ, degrees.
float at(const LightProfile& profile, double c_deg, double gamma_deg) {
    const double c = radians_from_degrees(c_deg), gamma = radians_from_degrees(gamma_deg);
    return profile.share(Vec3f(Vec3d(std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c), std::cos(gamma))));
}

/// Header, the ten and the three numbers, and a table.
std::string ies(const std::string& counts, const std::string& table, const std::string& tilt = "TILT=NONE") {
    return "IESNA:LM-63-2002\r\n[TEST] ours\r\n[MORE] 1 2 3\r\n" + tilt + "\r\n1 1000 2 " + counts +
           " 1 2 0.1 0.1 0\r\n0.5 1 40\r\n" + table;
}

TEST_F(Photometry, IesOfOnePlaneStandsForAll) {
    const LightProfile profile = read(ies("3 1", "0 45 90\r\n0\r\n100\r\n60, 20\r\n"));
    EXPECT_NEAR(profile.peak_cd(), 100.0, 1e-9);  // times multiplier 2 and ballast 0.5
    for (const double c : {0.0, 77.0, 300.0}) {
        EXPECT_NEAR(at(profile, c, 22.5), 0.8f, 1e-5f);
        EXPECT_NEAR(at(profile, c, 90.0), 0.2f, 1e-5f);
        EXPECT_EQ(at(profile, c, 91.0), 0.0f);
    }
}

/// An even intensity over the lower half has 2π of solid angle, whichever symmetry it is written in.
TEST_F(Photometry, EvenIntensityHasItsFlux) {
    for (const auto& [planes, table] : {std::pair<std::string, std::string>{"2 1", "0 90 0 50 50"},
                                        {"2 2", "0 90 0 90 50 50 50 50"},
                                        {"2 3", "0 90 0 90 180 50 50 50 50 50 50"},
                                        {"2 3", "0 90 90 180 270 50 50 50 50 50 50"},
                                        {"2 3", "0 90 0 180 360 50 50 50 50 50 50"}}) {
        const LightProfile profile = read(ies(planes, table));
        EXPECT_NEAR(profile.solid_angle() * profile.peak_cd(), 2.0 * kPi * 50.0, 1e-3) << table;
    }
}

TEST_F(Photometry, SymmetriesAreCompleted) {
    const LightProfile quarter = read(ies("2 3", "0 90 0 45 90 100 100 60 60 20 20"));
    for (const double c : {45.0, 135.0, 225.0, 315.0}) EXPECT_NEAR(at(quarter, c, 30), 0.6f, 1e-5f) << c;
    for (const double c : {90.0, 270.0}) EXPECT_NEAR(at(quarter, c, 30), 0.2f, 1e-5f) << c;
    EXPECT_NEAR(at(quarter, 180, 30), 1.0f, 1e-5f);
    EXPECT_NEAR(at(quarter, 337.5, 30), 0.8f, 1e-5f);
    const LightProfile half = read(ies("2 3", "0 90 0 90 180 100 100 60 60 20 20"));
    EXPECT_NEAR(at(half, 270, 30), 0.6f, 1e-5f);
    EXPECT_NEAR(at(half, 225, 30), 0.4f, 1e-5f);
    const LightProfile aside = read(ies("2 3", "0 90 90 180 270 100 100 60 60 20 20"));
    EXPECT_NEAR(at(aside, 90, 30), 1.0f, 1e-5f);
    EXPECT_NEAR(at(aside, 0, 30), 0.6f, 1e-5f);
    EXPECT_NEAR(at(aside, 45, 30), 0.8f, 1e-5f);
    EXPECT_NEAR(at(aside, 315, 30), 0.4f, 1e-5f);
}

/// Head, planes at 0, 90, 180, 270, angles 0 and 90, 2000 lm.
std::string eulumdat(int symmetry, const std::string& intensities) {
    std::string text = "Ours\n1\n" + std::to_string(symmetry) + "\n4\n90\n2\n90\n";
    for (int i = 0; i < 5; ++i) text += "name\n";
    for (int i = 0; i < 9; ++i) text += "100\n";
    text += "100\n80\n1\n0\n1\n1\nLED\n2000\n3000\n80\n20\n";
    for (int i = 0; i < 10; ++i) text += "0,5\n";
    return text + "0\n90\n180\n270\n0\n90\n" + intensities;
}

TEST_F(Photometry, EulumdatIsPerThousandLumens) {
    const LightProfile even = read(eulumdat(1, "50\n50\n"));
    EXPECT_NEAR(even.peak_cd(), 100.0, 1e-9);
    EXPECT_NEAR(even.solid_angle() * even.peak_cd(), 2.0 * kPi * 100.0, 1e-3);
    const LightProfile all = read(eulumdat(0, "50\n50\n40\n40\n30\n30\n20\n20\n"));
    const std::array<float, 4> expected{1.0f, 0.8f, 0.6f, 0.4f};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(at(all, 90 * i, 30), expected[static_cast<std::size_t>(i)], 1e-5f);
    const LightProfile to_180 = read(eulumdat(2, "50\n50\n40\n40\n30\n30\n"));
    EXPECT_NEAR(at(to_180, 270, 30), 0.8f, 1e-5f);
    const LightProfile to_90 = read(eulumdat(3, "50\n50\n40\n40\n30\n30\n"));  // C270, C0, C90
    EXPECT_NEAR(at(to_90, 270, 30), 1.0f, 1e-5f);
    EXPECT_NEAR(at(to_90, 0, 30), 0.8f, 1e-5f);
    EXPECT_NEAR(at(to_90, 180, 30), 0.8f, 1e-5f);
    EXPECT_NEAR(at(to_90, 90, 30), 0.6f, 1e-5f);
    const LightProfile quarter = read(eulumdat(4, "50\n50\n40\n40\n"));
    EXPECT_NEAR(at(quarter, 180, 30), 1.0f, 1e-5f);
    EXPECT_NEAR(at(quarter, 270, 30), 0.8f, 1e-5f);
}

TEST_F(Photometry, FaultsNameFileAndLine) {
    EXPECT_THAT(error_of(""), HasSubstr("lamp.txt: line 0: the file ends before the maker"));
    EXPECT_THAT(error_of(ies("3 1", "0 45 90\r\n0\r\n100\r\n")), HasSubstr("the file ends before the candela values"));
    EXPECT_THAT(error_of(ies("3 1", "0 45 40\r\n0\r\n1 1 1")),
                HasSubstr("line 7: the vertical angles: they do not asc"));
    EXPECT_THAT(error_of(ies("3 1", "0 45 90\r\n0\r\n100 x 1")), HasSubstr("line 9: the candela values is no number"));
    EXPECT_THAT(error_of(ies("3 1", "0 45 90\r\n0\r\n100 -4 1")), HasSubstr("not within 0"));
    EXPECT_THAT(error_of(ies("3 1", "0 45 90\r\n0\r\n0 0 0")), HasSubstr("all intensities are 0"));
    EXPECT_THAT(error_of(ies("1e9 1", "0")), HasSubstr("not within 1 and 4096"));
    EXPECT_THAT(error_of(ies("2.5 1", "0")), HasSubstr("not whole"));
    EXPECT_THAT(error_of(ies("2 2", "0 90 0 77 1 1 1 1")), HasSubstr("no symmetry completes"));
    EXPECT_THAT(error_of(ies("2 1", "0 90 0 1 1", "TILT=INCLUDE")), HasSubstr("line 4: lamps that fade"));
    EXPECT_THAT(error_of("TILT=NONE\n1 1 1 2 1 2 2 0 0 0 1 1 1 0 90 0 1 1"), HasSubstr("only C (1) is read"));
    EXPECT_THAT(error_of(eulumdat(1, "50\n")), HasSubstr("the file ends before the intensities"));
    EXPECT_THAT(error_of(eulumdat(7, "50\n50\n")), HasSubstr("line 3: the symmetry is 7, not within 0 and 4"));
}

/// Whatever a file is cut off at or garbled with, it is read or refused.
TEST_F(Photometry, BrokenFilesEndInErrorsAlone) {
    for (const std::string& whole :
         {ies("3 1", "0 45 90\r\n0\r\n100\r\n60, 20\r\n"), eulumdat(0, "50\n50\n40\n40\n30\n30\n20\n20\n")}) {
        for (std::size_t end = 0; end < whole.size(); ++end) {
            error_of(whole.substr(0, end));
            std::string garbled = whole;
            garbled[end] = static_cast<char>(end * 37);
            error_of(garbled);
        }
    }
}

}  // namespace
}  // namespace skybake::io
