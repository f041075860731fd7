#include "sky/aerial_perspective.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/check.h"

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
    return eta_of(before) * glm::pow(eta_of(*after) / eta_of(before), Vec3d(share));  // falls off nearly exponentially
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

/// Light that arrives at the observer.
struct Light {
    Vec3d direction;  // it comes from
    Vec3d flux;       // luminance × solid angle, or the sun's illuminance
};

std::vector<Light> lights_of(const Daylight& light) {
    constexpr int kHeights = 24;  // of the whole sphere, in equal solid angles of 7°
    constexpr int kAzimuths = 32;
    const double solid_angle = 4.0 * kPi / (kHeights * kAzimuths);
    // A picture's own sun would be hit or missed by the middles alone.
    const int samples = std::holds_alternative<ImageSky>(light.sky) ? 32 : 1;
    const auto direction_of = [](double height, double azimuth) {
        const double z = -1.0 + 2.0 * height / kHeights;
        const double r = std::sqrt(1.0 - z * z);
        const double turn = 2.0 * kPi * azimuth / kAzimuths;
        return Vec3d(r * std::sin(turn), r * std::cos(turn), z);
    };
    const Vec3d land(land_luminance(light));
    std::vector<Light> lights;
    for (int h = 0; h < kHeights; ++h) {
        for (int a = 0; a < kAzimuths; ++a) {
            Vec3d luminance = land;
            if (h >= kHeights / 2) {
                luminance = Vec3d(0.0);
                for (int i = 0; i < samples * samples; ++i) {
                    const Vec3d point =
                        direction_of(h + (i % samples + 0.5) / samples, a + (i / samples + 0.5) / samples);
                    luminance += Vec3d(sky_luminance(light.sky, Vec3f(point))) / static_cast<double>(samples * samples);
                }
            }
            lights.push_back({direction_of(h + 0.5, a + 0.5), luminance * solid_angle});
        }
    }
    if (light.sun.shape != SunShape::none)
        lights.push_back({Vec3d(light.sun.direction), Vec3d(light.sun.normal_illuminance)});
    return lights;
}

/// What an endless view in a direction would show, through molecules alone and through haze alone.
struct Airlight {
    Vec3d molecules{0.0};
    Vec3d haze{0.0};
};

Airlight scattered(const std::vector<Light>& lights, const Vec3d& view) {
    // The haze's phase function, every tenth of a degree: it is asked for millions of times.
    static const std::vector<Vec3d> kPhase = [] {
        std::vector<Vec3d> phase;
        for (int i = 0; i <= 1800; ++i) phase.push_back(haze_phase(std::cos(kPi * i / 1800.0)));
        return phase;
    }();
    Airlight sum;
    for (const Light& light : lights) {
        // Light from ahead goes on nearly straight: the angle between its way and the way to the eye.
        const double cos_angle = std::clamp(glm::dot(light.direction, view), -1.0, 1.0);
        sum.molecules += light.flux * molecule_phase(cos_angle);
        sum.haze += light.flux * kPhase[static_cast<std::size_t>(std::lround(std::acos(cos_angle) * 1800.0 / kPi))];
    }
    return sum;
}

/// The mixture of both at the ground, where an endless level path lies.
Vec3d mixed(const Airlight& airlight, const AirScattering& scattering) {
    return (scattering.molecules * airlight.molecules + scattering.haze * airlight.haze) /
           (scattering.molecules + scattering.haze);
}

/// How much brighter than single scattering the sky's own horizon is, in a level direction; 0 where nothing scatters.
Vec3d horizon_ratio(const Daylight& light, const std::vector<Light>& lights, const AirScattering& scattering,
                    const Vec3d& level) {
    const Vec3d computed = mixed(scattered(lights, level), scattering);
    const Vec3d seen(sky_luminance(light.sky, Vec3f(level)));
    Vec3d ratio(0.0);
    for (int c = 0; c < 3; ++c) {
        if (computed[c] > 0.0) ratio[c] = seen[c] / computed[c];
    }
    return ratio;
}

Vec3d level_direction(double azimuth) {
    return {std::sin(azimuth), std::cos(azimuth), 0.0};
}

/// Bilinear in a table of Air.
Vec3d at(const Air& air, const std::vector<Rgb>& table, const Vec3d& direction) {
    const AirAxes axes = air_axes(air.pole);
    const double across_a = glm::dot(direction, axes.a);
    const double across_b = glm::dot(direction, axes.b);
    const double angle = std::atan2(std::hypot(across_a, across_b), glm::dot(direction, air.pole));
    const double row = std::sqrt(angle / kPi) * (air.rows - 1);
    const double column = (std::atan2(across_b, across_a) / (2.0 * kPi) + 1.0) * air.columns - 0.5;
    const int upper = std::min(static_cast<int>(row), air.rows - 2);
    const int left = static_cast<int>(std::floor(column));
    const auto value = [&](int r, int c) {
        return Vec3d(table[static_cast<std::size_t>(r * air.columns + c % air.columns)]);
    };
    const double down = row - upper;
    const double right = column - left;
    return (1.0 - down) * ((1.0 - right) * value(upper, left) + right * value(upper, left + 1)) +
           down * ((1.0 - right) * value(upper + 1, left) + right * value(upper + 1, left + 1));
}

/// ∫ e^{−h/H} dx over a piece of the path whose ends are at the given heights, m.
double column_of(double begin_height_m, double end_height_m, double length_m, double scale_height_m) {
    const double rise = (end_height_m - begin_height_m) / scale_height_m;
    const double mean = std::abs(rise) < 1e-6 ? 1.0 - 0.5 * rise : -std::expm1(-rise) / rise;
    return std::exp(-begin_height_m / scale_height_m) * mean * length_m;
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

AirAxes air_axes(const Vec3d& pole) {
    const Vec3d aside = std::abs(pole.z) < 0.9 ? Vec3d(0.0, 0.0, 1.0) : Vec3d(1.0, 0.0, 0.0);
    const Vec3d a = glm::normalize(aside - glm::dot(aside, pole) * pole);
    return {a, glm::cross(pole, a)};
}

Air air_under(const Daylight& light, int columns, int rows) {
    SKYBAKE_CHECK_LT(0, columns);
    SKYBAKE_CHECK_LT(1, rows);
    Air air{air_scattering(light.turbidity), Vec3d(light.sun.direction), columns, rows, {}, {}};
    const std::vector<Light> lights = lights_of(light);
    constexpr int kAzimuths = 32;
    Vec3d mean_ratio(0.0);
    for (int a = 0; a < kAzimuths; ++a)
        mean_ratio += horizon_ratio(light, lights, air.scattering, level_direction(2.0 * kPi * a / kAzimuths)) /
                      static_cast<double>(kAzimuths);
    const AirAxes axes = air_axes(air.pole);
    air.molecule_airlight.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    air.haze_airlight.resize(air.molecule_airlight.size());
    tbb::parallel_for(std::size_t{0}, air.molecule_airlight.size(), [&](std::size_t i) {
        const double row = std::floor(static_cast<double>(i) / columns);
        const double angle = kPi * row * row / ((rows - 1.0) * (rows - 1.0));
        const double turn = 2.0 * kPi * (static_cast<double>(i) - row * columns + 0.5) / columns;
        const Vec3d view =
            std::cos(angle) * air.pole + std::sin(angle) * (std::cos(turn) * axes.a + std::sin(turn) * axes.b);
        // Upright views belong to no azimuth: the steeper, the more they take the ratio of the whole horizon.
        const Vec3d own = horizon_ratio(light, lights, air.scattering, level_direction(std::atan2(view.x, view.y)));
        const Vec3d ratio = mean_ratio + (1.0 - view.z * view.z) * (own - mean_ratio);
        const Airlight airlight = scattered(lights, view);
        air.molecule_airlight[i] = Rgb(airlight.molecules * ratio);
        air.haze_airlight[i] = Rgb(airlight.haze * ratio);
    });
    return air;
}

AerialView view_through(const Air& air, double height_m, const Vec3d& direction, double distance_m) {
    constexpr int kPieces = 4;
    const Vec3d molecule_airlight = at(air, air.molecule_airlight, direction);
    const Vec3d haze_airlight = at(air, air.haze_airlight, direction);
    const double length = distance_m / kPieces;
    Vec3d transmittance(1.0);
    Vec3d inscatter(0.0);
    for (int piece = 0; piece < kPieces; ++piece) {
        const double begin = height_m + piece * length * direction.z;
        const double end = begin + length * direction.z;
        const Vec3d molecules = air.scattering.molecules * column_of(begin, end, length, kMoleculeHeight);
        const Vec3d haze = air.scattering.haze * column_of(begin, end, length, kHazeHeight);
        const Vec3d depth = molecules + haze;
        const Vec3d after = transmittance * glm::exp(-depth);
        for (int c = 0; c < 3; ++c) {
            if (depth[c] > 0.0)
                inscatter[c] += (molecule_airlight[c] * molecules[c] + haze_airlight[c] * haze[c]) / depth[c] *
                                (transmittance[c] - after[c]);
        }
        transmittance = after;
    }
    return {Rgb(transmittance), Rgb(inscatter)};
}

}  // namespace skybake
