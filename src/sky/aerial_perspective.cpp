#include "sky/aerial_perspective.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace skybake {

namespace {

constexpr double kWavelengthNm[3] = {611.4, 549.1, 464.2};

/// η of the haze (appendix A.4, table 2) at 400, 450, 550, 650 and 850 nm.
struct HazeRow {
    double angle_deg;
    double eta[5];
};
constexpr double kEtaNm[5] = {400.0, 450.0, 550.0, 650.0, 850.0};
constexpr HazeRow kHaze[] = {{1.0, {4.192, 4.193, 4.177, 4.147, 4.072}},
                             {4.0, {3.311, 3.319, 3.329, 3.335, 3.339}},
                             {7.0, {2.860, 2.868, 2.878, 2.883, 2.888}},
                             {10.0, {2.518, 2.527, 2.536, 2.542, 2.547}},
                             {30.0, {1.122, 1.129, 1.138, 1.142, 1.147}},
                             {60.0, {0.3324, 0.3373, 0.3433, 0.3467, 0.3502}},
                             {80.0, {0.1644, 0.1682, 0.1730, 0.1757, 0.1785}},
                             {90.0, {0.1239, 0.1275, 0.1320, 0.1346, 0.1373}},
                             {110.0, {0.08734, 0.09111, 0.09591, 0.09871, 0.10167}},
                             {120.0, {0.08242, 0.08652, 0.09179, 0.09488, 0.09816}},
                             {130.0, {0.08313, 0.08767, 0.09352, 0.09697, 0.10065}},
                             {150.0, {0.09701, 0.1024, 0.1095, 0.1137, 0.1182}},
                             {180.0, {0.1307, 0.1368, 0.1447, 0.1495, 0.1566}}};

/// K of the haze's total scattering at the three wavelengths, between the paper's tabulated ones.
constexpr double kHazeK[3] = {0.6809, 0.6776, 0.6678};

Vec3d eta_of(const HazeRow& row) {
    Vec3d eta(0.0);
    for (int c = 0; c < 3; ++c) {
        int before = 0;
        while (before < 3 && kEtaNm[before + 1] <= kWavelengthNm[c]) ++before;
        const double share = (kWavelengthNm[c] - kEtaNm[before]) / (kEtaNm[before + 1] - kEtaNm[before]);
        eta[c] = row.eta[before] + share * (row.eta[before + 1] - row.eta[before]);
    }
    return eta;
}

Vec3d eta_at(double angle_deg) {
    const HazeRow* after = std::find_if(std::begin(kHaze), std::end(kHaze),
                                        [&](const HazeRow& row) { return row.angle_deg >= angle_deg; });
    if (after == std::begin(kHaze)) return eta_of(*after);  // the forward peak within 1° is flat
    if (after == std::end(kHaze)) return eta_of(*(after - 1));
    const HazeRow& before = *(after - 1);
    const double share = (angle_deg - before.angle_deg) / (after->angle_deg - before.angle_deg);
    return (1.0 - share) * eta_of(before) + share * eta_of(*after);
}

/// 2π ∫ η sin θ dθ of the interpolated table.
Vec3d haze_norm() {
    constexpr int kSteps = 3600;
    Vec3d sum(0.0);
    for (int i = 0; i < kSteps; ++i) {
        const double angle = kPi * (i + 0.5) / kSteps;
        sum += eta_at(degrees_from_radians(angle)) * std::sin(angle);
    }
    return sum * (2.0 * kPi * kPi / kSteps);
}

/// ∫ e^{−h/H} dx from the observer over `distance_m`, m.
double column(double height_m, double cos_zenith, double distance_m, double scale_height_m) {
    const double rise = cos_zenith * distance_m / scale_height_m;
    const double mean = std::abs(rise) < 1e-6 ? 1.0 - 0.5 * rise : -std::expm1(-rise) / rise;
    return std::exp(-height_m / scale_height_m) * mean * distance_m;
}

}  // namespace

AirScattering air_scattering(double turbidity) {
    constexpr double kIndex = 1.0003;          // n of air
    constexpr double kMolecules = 2.545e25;    // N, m⁻³
    constexpr double kDepolarisation = 0.035;  // p_n
    const double concentration = std::max(0.0, 0.6544 * turbidity - 0.6510) * 1e-18;
    AirScattering air;
    for (int c = 0; c < 3; ++c) {
        const double lambda_m = kWavelengthNm[c] * 1e-9;
        const double n2 = kIndex * kIndex - 1.0;
        air.molecules[c] = 8.0 * kPi * kPi * kPi * n2 * n2 / (3.0 * kMolecules * std::pow(lambda_m, 4.0)) *
                           (6.0 + 3.0 * kDepolarisation) / (6.0 - 7.0 * kDepolarisation);
        air.haze[c] = 0.434 * concentration * kPi * std::pow(2.0 * kPi / lambda_m, 2.0) * kHazeK[c];
    }
    return air;
}

double molecule_phase(double cos_angle) {
    return 3.0 / (16.0 * kPi) * (1.0 + cos_angle * cos_angle);
}

Vec3d haze_phase(double cos_angle) {
    static const Vec3d norm = haze_norm();
    return eta_at(degrees_from_radians(std::acos(std::clamp(cos_angle, -1.0, 1.0)))) / norm;
}

AerialPerspective::AerialPerspective(const Daylight& light, double turbidity, const Rgb& ground_luminance)
    : scattering_(air_scattering(turbidity)) {
    constexpr int kHeights = 24;  // of the whole sphere, in equal solid angles
    constexpr int kAzimuths = 32;
    const double solid_angle = 4.0 * kPi / (kHeights * kAzimuths);
    for (int h = 0; h < kHeights; ++h) {
        const double z = -1.0 + 2.0 * (h + 0.5) / kHeights;
        const double r = std::sqrt(1.0 - z * z);
        for (int a = 0; a < kAzimuths; ++a) {
            const double azimuth = 2.0 * kPi * (a + 0.5) / kAzimuths;
            const Vec3d direction(r * std::sin(azimuth), r * std::cos(azimuth), z);
            const Rgb luminance = z > 0.0 ? sky_luminance(light.sky, Vec3f(direction)) : ground_luminance;
            lights_.push_back({direction, Vec3d(luminance) * solid_angle});
        }
    }
    if (light.sun.shape != SunShape::none)
        lights_.push_back({Vec3d(light.sun.direction), Vec3d(light.sun.normal_illuminance)});
}

AerialView AerialPerspective::view(double observer_height_m, const Vec3f& direction, double distance_m) const {
    const Vec3d way(direction);
    Vec3d by_molecules(0.0);  // what a metre of air at sea level sends to the eye
    Vec3d by_haze(0.0);
    for (const Light& source : lights_) {
        // Light from ahead goes on nearly straight: the angle between its way and the way to the eye.
        const double cos_angle = glm::dot(source.direction, way);
        by_molecules += source.flux * molecule_phase(cos_angle);
        by_haze += source.flux * haze_phase(cos_angle);
    }
    by_molecules *= scattering_.molecules;
    by_haze *= scattering_.haze;

    constexpr int kSteps = 16;
    Vec3d transmittance(1.0);
    Vec3d inscatter(0.0);
    for (int step = 0; step < kSteps; ++step) {
        const double begin = distance_m * step / kSteps;
        const double length = distance_m / kSteps;
        const double height = observer_height_m + begin * way.z;
        const double molecules = column(height, way.z, length, kMoleculeHeight);
        const double haze = column(height, way.z, length, kHazeHeight);
        const Vec3d depth = scattering_.molecules * molecules + scattering_.haze * haze;
        const Vec3d after = transmittance * glm::exp(-depth);
        for (int c = 0; c < 3; ++c) {
            if (depth[c] > 0.0)
                inscatter[c] +=
                    (by_molecules[c] * molecules + by_haze[c] * haze) / depth[c] * (transmittance[c] - after[c]);
        }
        transmittance = after;
    }
    return {Rgb(transmittance), Rgb(inscatter)};
}

}  // namespace skybake
