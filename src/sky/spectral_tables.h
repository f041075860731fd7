// Tables over the wavelength: the standard observer, the sun outside the atmosphere, and what the air absorbs.
#pragma once

#include <array>
#include <span>

namespace skybake {

inline constexpr double kFirstLambdaNm = 380.0;
inline constexpr double kLambdaStepNm = 5.0;

/// Maximum luminous efficacy Km of the photopic observer, lm W⁻¹.
inline constexpr double kMaxLuminousEfficacy = 683.0;

/// x̄, ȳ, z̄ of the CIE 1931 2° observer at kFirstLambdaNm + i kLambdaStepNm, 380…780 nm.
std::span<const std::array<double, 3>> standard_observer();

/// Radiance of the sun's disc outside the atmosphere at 1 AU, W m⁻² sr⁻¹ nm⁻¹; linear between the table's 10 nm, 0
/// outside 380…750 nm.
double extraterrestrial_sun_radiance(double lambda_nm);

/// S0, S1, S2 of CIE daylight for `component` 0, 1, 2: spectra of daylight are S0 + M1 S1 + M2 S2. Linear between the
/// table's 10 nm, 0 outside 380…780 nm.
double daylight_component(int component, double lambda_nm);

/// Absorption coefficients of ozone, uniformly mixed gases and water vapour, 1/cm; linear in the tables, 0 outside.
double ozone_absorption(double lambda_nm);
double mixed_gas_absorption(double lambda_nm);
double water_vapour_absorption(double lambda_nm);

}  // namespace skybake
