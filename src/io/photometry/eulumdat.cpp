// Based on: A. Stockmar, "EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner", Tagungsband
// Licht '90.
#include <algorithm>
#include <cmath>

#include "io/photometry/profile_text.h"

namespace skybake::io {
namespace {

std::size_t whole(ProfileText& text, const char* what, double lowest, double highest) {
    const double value = text.number_on_line(what, lowest, highest);
    if (value != std::floor(value)) text.fail("a number of angles or lamps is not whole");
    return static_cast<std::size_t>(value);
}

void skip(ProfileText& text, int lines, const char* what) {
    for (int i = 0; i < lines; ++i) text.line(what);
}

}  // namespace

LightProfile parse_eulumdat(ProfileText& text) {
    skip(text, 1, "the maker");
    text.number_on_line("the type", 0.0, 3.0);
    const std::size_t symmetry = whole(text, "the symmetry", 0.0, 4.0);
    const std::size_t planes = whole(text, "the number of C-planes", 1.0, 721.0);
    text.number_on_line("the distance of C-planes", 0.0, 360.0);
    const std::size_t gammas = whole(text, "the number of angles in a C-plane", 2.0, 721.0);
    text.number_on_line("the distance of angles", 0.0, 180.0);
    skip(text, 5, "report, name, number, file and date");
    skip(text, 9, "the measures");
    skip(text, 2, "the share downwards and the light output ratio");
    const double factor = text.number_on_line("the conversion factor", 1e-9, 1e9);
    skip(text, 1, "the tilt");
    const std::size_t sets = whole(text, "the number of lamp sets", 1.0, 20.0);
    double flux_lm = 0.0;
    for (std::size_t s = 0; s < sets; ++s) {
        skip(text, 2, "number and type of lamps");
        const double lumen = text.number_on_line("the lamps' flux", 0.0, 1e9);
        if (s == 0) flux_lm = lumen;  // further sets are other lamps for the same luminaire
        skip(text, 3, "colour, rendering and watts");
    }
    skip(text, 10, "the direct ratios");
    const std::vector<double> all_c = ascending_angles(text, planes, "the C-planes", true);
    const std::vector<double> gamma = ascending_angles(text, gammas, "the angles in a C-plane", true);

    // Which planes are measured: all, one, C0…C180, C270…C90, C0…C90.
    std::size_t first = 0, measured = planes;
    if (symmetry == 1) measured = 1;
    if (symmetry == 2) measured = planes / 2 + 1;
    if (symmetry == 3) {
        first = 3 * planes / 4;
        measured = planes / 2 + 1;
    }
    if (symmetry == 4) measured = planes / 4 + 1;
    if (symmetry >= 2 && planes % 4 != 0) text.fail("a symmetric table has C-planes that four does not divide");
    std::vector<double> c, candela;
    for (std::size_t i = 0; i < measured; ++i) {
        c.push_back(all_c[(first + i) % planes]);
        for (std::size_t g = 0; g < gammas; ++g)
            candela.push_back(factor * flux_lm / 1000.0 * text.number_on_line("the intensities", 0.0, 1e9));
    }
    if (symmetry == 3) {
        // C270…C90 over C0 is, by the same symmetry, C90…C270 over C180, backwards: C goes over into 180° - C.
        std::vector<double> turned_c, turned;
        for (std::size_t i = measured; i-- > 0;) {
            turned_c.push_back(180.0 - (c[i] > 180.0 ? c[i] - 360.0 : c[i]));
            const auto row = candela.begin() + static_cast<std::ptrdiff_t>(i * gammas);
            turned.insert(turned.end(), row, row + static_cast<std::ptrdiff_t>(gammas));
        }
        c = std::move(turned_c);
        candela = std::move(turned);
    }
    if (symmetry == 1) c = {0.0};
    return completed_profile(text, c, gamma, candela);
}

}  // namespace skybake::io
