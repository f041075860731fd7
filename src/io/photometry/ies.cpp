// Based on: IESNA LM-63-2002, "Standard file format for the electronic transfer of photometric data".
#include <algorithm>
#include <cmath>

#include "io/photometry/profile_text.h"

namespace skybake::io {
namespace {

std::size_t count_of(ProfileText& text, const char* what) {
    constexpr double kMostAngles = 4096.0;
    const double value = text.number(what, 1.0, kMostAngles);
    if (value != std::floor(value)) text.fail("a number of angles is not whole");
    return static_cast<std::size_t>(value);
}

void skip_to_numbers(ProfileText& text) {
    for (;;) {
        const std::string_view line = text.line("TILT=");
        if (!line.starts_with("TILT=")) continue;
        if (line == "TILT=NONE") return;
        // The factors tell how lamps fade when the luminaire is tilted from where it was measured.
        text.fail("lamps that fade with their tilt are not read, only TILT=NONE");
    }
}

}  // namespace

LightProfile parse_ies(ProfileText& text) {
    skip_to_numbers(text);
    text.number("the number of lamps", 1.0, 1e6);
    text.number("lumens per lamp", -1.0, 1e9);
    const double multiplier = text.number("the multiplier", 1e-9, 1e9);
    const std::size_t gammas = count_of(text, "the number of vertical angles");
    const std::size_t planes = count_of(text, "the number of horizontal angles");
    if (text.number("the photometric type", 1.0, 3.0) != 1.0)
        text.fail("the photometric type is B or A; only C (1) is read");
    text.number("the units", 1.0, 2.0);
    for (const char* what : {"the width", "the length", "the height"}) text.number(what, -1e6, 1e6);
    const double ballast = text.number("the ballast factor", 0.0, 1e3);
    const double ballast_lamp = text.number("the factor after the ballast's", 0.0, 1e3);
    text.number("the watts", 0.0, 1e9);
    const std::vector<double> gamma = ascending_angles(text, gammas, "the vertical angles", false);
    const std::vector<double> c = ascending_angles(text, planes, "the horizontal angles", false);
    std::vector<double> candela;
    candela.reserve(planes * gammas);
    for (std::size_t i = 0; i < planes * gammas; ++i)
        candela.push_back(multiplier * ballast * ballast_lamp * text.number("the candela values", 0.0, 1e12));
    return completed_profile(text, c, gamma, candela);
}

}  // namespace skybake::io
