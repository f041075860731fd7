#include "sky/spectral_tables.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace skybake {

namespace {

// clang-format off
// CIE 1931 2° standard observer (CIE 015), 380…780 nm in steps of 5 nm: x̄, ȳ, z̄.
constexpr std::array<double, 3> kObserver[] = {
    {0.001368, 3.9e-05, 0.006450001}, {0.002236, 6.4e-05, 0.01054999}, {0.004243, 0.00012, 0.02005001},
    {0.00765, 0.000217, 0.03621}, {0.01431, 0.000396, 0.06785001}, {0.02319, 0.00064, 0.1102}, {0.04351, 0.00121, 0.2074},
    {0.07763, 0.00218, 0.3713}, {0.13438, 0.004, 0.6456}, {0.21477, 0.0073, 1.03905}, {0.2839, 0.0116, 1.3856},
    {0.3285, 0.01684, 1.62296}, {0.34828, 0.023, 1.74706}, {0.34806, 0.0298, 1.7826}, {0.3362, 0.038, 1.77211},
    {0.3187, 0.048, 1.7441}, {0.2908, 0.06, 1.6692}, {0.2511, 0.0739, 1.5281}, {0.19536, 0.09098, 1.28764},
    {0.1421, 0.1126, 1.0419}, {0.09564, 0.13902, 0.8129501}, {0.05795001, 0.1693, 0.6162}, {0.03201, 0.20802, 0.46518},
    {0.0147, 0.2586, 0.3533}, {0.0049, 0.323, 0.272}, {0.0024, 0.4073, 0.2123}, {0.0093, 0.503, 0.1582}, {0.0291, 0.6082, 0.1117},
    {0.06327, 0.71, 0.07824999}, {0.1096, 0.7932, 0.05725001}, {0.1655, 0.862, 0.04216}, {0.2257499, 0.9148501, 0.02984},
    {0.2904, 0.954, 0.0203}, {0.3597, 0.9803, 0.0134}, {0.4334499, 0.9949501, 0.008749999}, {0.5120501, 1, 0.005749999},
    {0.5945, 0.995, 0.0039}, {0.6784, 0.9786, 0.002749999}, {0.7621, 0.952, 0.0021}, {0.8425, 0.9154, 0.0018},
    {0.9163, 0.87, 0.001650001}, {0.9786, 0.8163, 0.0014}, {1.0263, 0.757, 0.0011}, {1.0567, 0.6949, 0.001},
    {1.0622, 0.631, 0.0008}, {1.0456, 0.5668, 0.0006}, {1.0026, 0.503, 0.00034}, {0.9384, 0.4412, 0.00024},
    {0.8544499, 0.381, 0.00019}, {0.7514, 0.321, 0.0001}, {0.6424, 0.265, 4.999999e-05}, {0.5419, 0.217, 3e-05},
    {0.4479, 0.175, 2e-05}, {0.3608, 0.1382, 1e-05}, {0.2835, 0.107, 0}, {0.2187, 0.0816, 0}, {0.1649, 0.061, 0},
    {0.1212, 0.04458, 0}, {0.0874, 0.032, 0}, {0.0636, 0.0232, 0}, {0.04677, 0.017, 0}, {0.0329, 0.01192, 0},
    {0.0227, 0.00821, 0}, {0.01584, 0.005723, 0}, {0.01135916, 0.004102, 0}, {0.008110916, 0.002929, 0},
    {0.005790346, 0.002091, 0}, {0.004109457, 0.001484, 0}, {0.002899327, 0.001047, 0}, {0.00204919, 0.00074, 0},
    {0.001439971, 0.00052, 0}, {0.0009999493, 0.0003611, 0}, {0.0006900786, 0.0002492, 0}, {0.0004760213, 0.0001719, 0},
    {0.0003323011, 0.00012, 0},
    {0.000234826, 8.48e-05, 0}, {0.000166151, 6e-05, 0}, {0.000117413, 4.24e-05, 0}, {8.30753e-05, 3e-05, 0}, {5.87065e-05, 2.12e-05, 0}, {4.15099e-05, 1.499e-05, 0},
};

// Sun outside the atmosphere at 1 AU, W m⁻² sr⁻¹ nm⁻¹, 380…750 nm in steps of 10 nm (Preetham et al. 1999, table 2, as the authors' code scales it).
constexpr double kSunRadiance[] = {
    16559, 16233.7, 21127.5, 25888.2, 25829.1, 24232.3, 26760.5, 29658.3, 30545.4, 30057.5, 30663.7, 28830.4, 28712.1, 27825,
    27100.6, 27233.6, 26361.3, 25503.8, 25060.2, 25311.6, 25355.9, 25134.2, 24631.5, 24173.2, 23685.3, 23212.1, 22827.7, 22339.8,
    21970.2, 21526.7, 21097.9, 20728.3, 20240.4, 19870.8, 19427.2, 19072.4, 18628.9, 18259.2,
};

// CIE daylight (CIE 015): mean spectrum and its first two components, 380…780 nm in steps of 10 nm.
constexpr std::array<double, 41> kDaylight[] = {{
    63.4, 65.8, 94.8, 104.8, 105.9, 96.8, 113.9, 125.6, 125.5, 121.3, 121.3, 113.5, 113.1, 110.8, 106.5, 108.8, 105.3,
    104.4, 100, 96, 95.1, 89.1, 90.5, 90.3, 88.4, 84, 85.1, 81.9, 82.6, 84.9, 81.3, 71.9, 74.3, 76.4, 63.3, 71.7, 77,
    65.2, 47.7, 68.6, 65,
}, {
    38.5, 35, 43.4, 46.3, 43.9, 37.1, 36.7, 35.9, 32.6, 27.9, 24.3, 20.1, 16.2, 13.2, 8.6, 6.1, 4.2, 1.9, 0, -1.6,
    -3.5, -3.5, -5.8, -7.2, -8.6, -9.5, -10.9, -10.7, -12, -14, -13.6, -12, -13.3, -12.9, -10.6, -11.6, -12.2, -10.2,
    -7.8, -11.2, -10.4,
}, {
    3, 1.2, -1.1, -0.5, -0.7, -1.2, -2.6, -2.9, -2.8, -2.6, -2.6, -1.8, -1.5, -1.3, -1.2, -1, -0.5, -0.3, 0, 0.2, 0.5,
    2.1, 3.2, 4.1, 4.7, 5.1, 6.7, 7.3, 8.6, 9.8, 10.2, 8.3, 9.6, 8.5, 7, 7.6, 8, 6.7, 5.2, 7.4, 6.8,
}};

struct Sample {
    double lambda_nm;
    double value;
};

// Absorption coefficients, 1/cm (Preetham et al. 1999, table 2, after Iqbal 1983); linear between, zero outside.
constexpr Sample kOzone[] = {
    {300, 10}, {305, 4.8}, {310, 2.7}, {315, 1.35}, {320, 0.8}, {325, 0.38}, {330, 0.16}, {335, 0.075}, {340, 0.04}, {345, 0.019},
    {350, 0.007}, {355, 0}, {445, 0.003}, {450, 0.003}, {455, 0.004}, {460, 0.006}, {465, 0.008}, {470, 0.009}, {475, 0.012},
    {480, 0.014}, {485, 0.017}, {490, 0.021}, {495, 0.025}, {500, 0.03}, {505, 0.035}, {510, 0.04}, {515, 0.045}, {520, 0.048},
    {525, 0.057}, {530, 0.063}, {535, 0.07}, {540, 0.075}, {545, 0.08}, {550, 0.085}, {555, 0.095}, {560, 0.103}, {565, 0.11},
    {570, 0.12}, {575, 0.122}, {580, 0.12}, {585, 0.118}, {590, 0.115}, {595, 0.12}, {600, 0.125}, {605, 0.13}, {610, 0.12},
    {620, 0.105}, {630, 0.09}, {640, 0.079}, {650, 0.067}, {660, 0.057}, {670, 0.048}, {680, 0.036}, {690, 0.028}, {700, 0.023},
    {710, 0.018}, {720, 0.014}, {730, 0.011}, {740, 0.01}, {750, 0.009}, {760, 0.007}, {770, 0.004}, {780, 0}, {790, 0},
};
constexpr Sample kMixedGases[] = {{759, 0}, {760, 3.0}, {770, 0.21}, {771, 0}};
constexpr Sample kWaterVapour[] = {
    {689, 0}, {690, 0.016}, {700, 0.024}, {710, 0.0125}, {720, 1}, {730, 0.87}, {740, 0.061}, {750, 0.001}, {760, 1e-5}, {770, 1e-5},
    {780, 0.0006}, {790, 0.0175}, {800, 0.036}};
// clang-format on

template <std::size_t N>
double interpolate(const Sample (&table)[N], double lambda_nm) {
    if (lambda_nm < table[0].lambda_nm || lambda_nm > table[N - 1].lambda_nm) return 0.0;
    const Sample* after = std::upper_bound(std::begin(table), std::end(table), lambda_nm,
                                           [](double lambda, const Sample& s) { return lambda < s.lambda_nm; });
    if (after == std::end(table)) return table[N - 1].value;
    const Sample* before = after - 1;
    return before->value +
           (after->value - before->value) * (lambda_nm - before->lambda_nm) / (after->lambda_nm - before->lambda_nm);
}

}  // namespace

std::span<const std::array<double, 3>> standard_observer() {
    return kObserver;
}

double extraterrestrial_sun_radiance(double lambda_nm) {
    const double place = (lambda_nm - kFirstLambdaNm) / 10.0;
    if (place < 0.0 || place > static_cast<double>(std::size(kSunRadiance) - 1)) return 0.0;
    const std::size_t before = std::min(static_cast<std::size_t>(place), std::size(kSunRadiance) - 2);
    const double share = place - static_cast<double>(before);
    return kSunRadiance[before] + share * (kSunRadiance[before + 1] - kSunRadiance[before]);
}

double daylight_component(int component, double lambda_nm) {
    const std::array<double, 41>& table = kDaylight[component];
    const double place = (lambda_nm - kFirstLambdaNm) / 10.0;
    if (place < 0.0 || place > static_cast<double>(table.size() - 1)) return 0.0;
    const std::size_t before = std::min(static_cast<std::size_t>(place), table.size() - 2);
    return table[before] + (place - static_cast<double>(before)) * (table[before + 1] - table[before]);
}

double ozone_absorption(double lambda_nm) {
    return interpolate(kOzone, lambda_nm);
}

double mixed_gas_absorption(double lambda_nm) {
    return interpolate(kMixedGases, lambda_nm);
}

double water_vapour_absorption(double lambda_nm) {
    return interpolate(kWaterVapour, lambda_nm);
}

}  // namespace skybake
