// The periodic terms of NREL SPA. Based on: Reda & Andreas, "Solar position algorithm for solar radiation
// applications", NREL/TP-560-34302, revised 2008, tables A4.2 and A4.3.
#pragma once

#include <array>
#include <span>

namespace skybake {

/// One term A cos(B + C τ), τ in Julian ephemeris millennia; A in units of 1e-8 rad (1e-8 AU for R), B and C in rad.
struct PeriodicTerm {
    double a;
    double b;
    double c;
};

/// One term of the nutation: its argument is Σ Yj Xj; (a + b T) sin and (c + d T) cos in units of 0.0001″.
struct NutationTerm {
    std::array<int, 5> y;
    double a;
    double b;
    double c;
    double d;
};

std::array<std::span<const PeriodicTerm>, 6> heliocentric_longitude_terms();  // L0…L5
std::array<std::span<const PeriodicTerm>, 2> heliocentric_latitude_terms();   // B0, B1
std::array<std::span<const PeriodicTerm>, 5> sun_distance_terms();            // R0…R4
std::span<const NutationTerm> nutation_terms();

}  // namespace skybake
