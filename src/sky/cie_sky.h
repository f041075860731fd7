// The skies of the CIE. Based on: ISO 15469:2004 / CIE S 011/E:2003, "Spatial distribution of daylight: CIE standard
// general sky", 15 types; and CIE 110-1994 with the intermediate sky of Nakamura, Oki, Hayashi (1985).
#pragma once

#include "base/vec.h"
#include "sky/sky_colour.h"

namespace skybake {

/// One of the 15 types under one sun; made by cie_general_sky.
struct CieGeneralSky {
    Vec3d sun_direction{0.0, 0.0, 1.0};  // world frame, never below the horizon
    PerezDistribution luminance;         // cd m⁻²
    double efficacy_lm_w = 115.0;
    SkyColour colour;
};

enum class Cie1994Type { clear, turbid_clear, intermediate, overcast };

/// One of the four skies of 1994 under one sun; made by cie_1994_sky.
struct Cie1994Sky {
    Cie1994Type type = Cie1994Type::overcast;
    Vec3d sun_direction{0.0, 0.0, 1.0};  // world frame, never below the horizon
    double zenith_cd_m2 = 0.0;
    double efficacy_lm_w = 115.0;
    SkyColour colour;
};

/// Type 1…15 with a zenith luminance of 1 cd m⁻² and the colour of clouds: the standard has neither level nor colour. A
/// sun below the horizon is taken as standing on it.
CieGeneralSky cie_general_sky(int type, const Vec3d& sun_direction);
/// The same for the skies of 1994.
Cie1994Sky cie_1994_sky(Cie1994Type type, const Vec3d& sun_direction);

/// The same sky with a horizontal illuminance of `illuminance_lx` (≥ 0), by quadrature: error below 1e-4.
CieGeneralSky scaled_to(CieGeneralSky sky, double illuminance_lx);
Cie1994Sky scaled_to(Cie1994Sky sky, double illuminance_lx);

/// The same sky with a zenith luminance of `zenith_cd_m2` (≥ 0).
CieGeneralSky with_zenith(CieGeneralSky sky, double zenith_cd_m2);
Cie1994Sky with_zenith(Cie1994Sky sky, double zenith_cd_m2);

/// Luminance in a unit direction, cd m⁻²; 0 below the horizon.
double sky_luminance_cd_m2(const CieGeneralSky& sky, const Vec3d& direction);
double sky_luminance_cd_m2(const Cie1994Sky& sky, const Vec3d& direction);

}  // namespace skybake
