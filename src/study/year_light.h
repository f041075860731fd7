// A period of weather as a few hundred directions: the sky's energy summed into one picture, the sun's spread over a
// lattice of its ways.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/site.h"
#include "sky/daylight.h"
#include "sky/image_sky.h"
#include "sky/weather.h"
#include "study/receivers.h"
#include "trace/ray_scene.h"

namespace skybake {

/// Months of a period, 1…12 each.
struct Period {
    std::vector<int> months{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
};

/// One short while of the year with the sun up.
struct SunMoment {
    Vec3f direction{0, 0, 1};  // world frame
    float beam_wh_m2 = 0.0f;   // energy on a plane that faces the sun
    float sunshine_h = 0.0f;   // expected sunshine
    bool is_winter = false;    // of the half year from 21 September to 20 March (north), else of the other (south)
    // Where it lies on the lattice of the sun's ways: four nodes and their shares.
    std::uint32_t node[4] = {};
    float share[4] = {};
};

/// The light of a period at a place.
struct YearLight {
    ImageSky sky;  // the sky's radiance summed over time, kWh m⁻² sr⁻¹ in each channel
    std::vector<SunMoment> moments;
    std::vector<Vec3f> nodes;     // directions of the lattice
    double global_kwh_m2 = 0.0;   // on open level ground
    double beam_kwh_m2 = 0.0;     // on a plane that faces the sun
    double diffuse_kwh_m2 = 0.0;  // on open level ground
    double sunshine_h = 0.0;
    double winter_sunshine_h = 0.0;
};

/// Sums a weather file over the period. Each row's Perez sky (sky/perez_sky.h) is added to a picture of 144 × 72
/// pixels; each row's interval is cut into quarters of an hour, and its beam shared among those with the sun up.
/// Sunshine is time with a beam of at least 120 W m⁻² (WMO, Guide to instruments, 2018, §8.1.1).
YearLight year_light(const Weather& weather, const Site& site, double convergence_rad, const Period& period);

/// Without weather: every moment with the sun up counts as sunshine, and there is no energy. `year` of the sun's ways.
YearLight cloudless_year(int year, const Site& site, double convergence_rad, const Period& period = {});

/// The period's light as that of one instant without a beam, for what surfaces reflect: kWh stand for lm h, and the sun
/// is spread over pixels of 2.5°, its energy on level ground kept. Nothing else should look at it: shadows of so wide a
/// sun are soft.
Daylight daylight_of(const YearLight& year);

/// What samples get of the sun over a period.
struct YearSun {
    std::vector<float> beam_kwh_m2;
    std::vector<float> sunshine_pct;         // of the period's sunshine ("annual probable sunlight hours")
    std::vector<float> winter_sunshine_pct;  // sunshine of the winter half year, of the same total
    std::uint64_t rays = 0;
};

/// Visibility is traced to the lattice's nodes (declination every 3.9°, hour angle every 3.75°) and taken as bilinear
/// between them; cosine and horizon of each sample's surface are those of each moment. Error:
/// tests/study/year_light_test.cpp. Parallel; the same for any number of threads.
YearSun year_sun(std::span<const Sample> samples, const Vec3d& scene_origin, const RayScene& rays,
                 const YearLight& year, Progress& progress);

}  // namespace skybake
