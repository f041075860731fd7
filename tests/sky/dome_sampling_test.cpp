#include "sky/dome_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dome_error.h"

namespace skybake {
namespace {

const std::vector<NamedSky>& skies() {
    static const std::vector<NamedSky> list = skies_to_judge();
    return list;
}

Vec3f normal_of(int i) {
    constexpr double kElevation[] = {90.0, 0.0, 0.0, 45.0, -30.0};
    constexpr double kAzimuth[] = {0.0, 135.0, 315.0, 250.0, 100.0};
    return Vec3f(world_direction(radians_from_degrees(kAzimuth[i]), radians_from_degrees(kElevation[i]), 0.0));
}

// Truth: chi² of the directions against the density they claim, in 32 × 16 bins. The lattice is more even than chance,
// so only too large a chi² is wrong; Šidák's correction for all skies and normals. Mass below the surface's horizon is
// dropped by sample() and counts as its own bin.
TEST(DomeSampling, DirectionsFollowTheirDensity) {
    constexpr int kAzimuths = 32, kHeights = 16, kCount = 20'000;
    // Wilson & Hilferty's quantile of chi² at 1 − 1e-5: the normal quantile is 4.26.
    const auto limit = [](double degrees) {
        const double t = 2.0 / (9.0 * degrees);
        return degrees * std::pow(1.0 - t + 4.26 * std::sqrt(t), 3.0);
    };
    for (const NamedSky& sky : skies()) {
        for (int i = 0; i < 5; ++i) {
            const Vec3f normal = normal_of(i);
            // Midpoints of the sampler's own cells, divided where a picture has its sun.
            std::vector<Vec3f> points;
            std::vector<double> measures;
            std::vector<int> bins_of_points;
            for (int cell = 0; cell < 256 * 64; ++cell) {
                const int h = cell / 256, a = cell % 256;
                const bool is_fine = std::holds_alternative<ImageSky>(sky.daylight.sky) && a >= 88 && a < 104;
                const int parts = is_fine ? 32 : 2;
                for (int part = 0; part < parts * parts; ++part) {
                    const double z = (h + (part / parts + 0.5) / parts) / 64.0;
                    const double azimuth = 2.0 * kPi * (a + (part % parts + 0.5) / parts) / 256.0;
                    const double r = std::sqrt(1.0 - z * z);
                    points.emplace_back(Vec3d(r * std::sin(azimuth), r * std::cos(azimuth), z));
                    measures.push_back(2.0 * kPi / (256.0 * 64.0 * parts * parts));
                    bins_of_points.push_back(h / 4 * kAzimuths + a / 8);
                }
            }
            const std::vector<double> pdf = sky.sampler.pdf_solid_angle(normal, points);
            std::vector<double> expected(kAzimuths * kHeights, 0.0);
            double mass = 0.0;
            double dropped = 0.0;
            for (std::size_t p = 0; p < points.size(); ++p) {
                mass += pdf[p] * measures[p];
                (glm::dot(points[p], normal) > 0.0f ? expected[bins_of_points[p]] : dropped) +=
                    pdf[p] * measures[p] * kCount;
            }
            EXPECT_NEAR(mass, 1.0, 1e-3) << sky.name << ", normal " << i;
            const DomeSamples samples = sky.sampler.sample(normal, kCount);
            EXPECT_NEAR(static_cast<double>(kCount - samples.size()), dropped, 5.0 + 4.0 * std::sqrt(dropped));
            std::vector<double> observed(expected.size(), 0.0);
            for (const Vec3f& direction : samples.directions) {
                const double turn = std::atan2(direction.x, direction.y) / (2.0 * kPi);
                const int column = static_cast<int>((turn - std::floor(turn)) * kAzimuths) % kAzimuths;
                const int row = std::min(static_cast<int>(direction.z * kHeights), kHeights - 1);
                observed[row * kAzimuths + column] += 1.0;
            }
            double chi2 = 0.0, rest_expected = 0.0, rest_observed = 0.0;
            int bins = 0;
            for (std::size_t b = 0; b < expected.size(); ++b) {
                if (expected[b] < 5.0) {
                    rest_expected += expected[b];
                    rest_observed += observed[b];
                    continue;
                }
                chi2 += (observed[b] - expected[b]) * (observed[b] - expected[b]) / expected[b];
                ++bins;
            }
            if (rest_expected > 5.0)
                chi2 += (rest_observed - rest_expected) * (rest_observed - rest_expected) / rest_expected;
            EXPECT_LT(chi2, limit(bins)) << sky.name << ", normal " << i;
        }
    }
}

// Truth: the model's own diffuse irradiance, and quadrature for walls: what the weights add up to without obstacles.
TEST(DomeSampling, TableIntegratesToTheModelsOwnIrradiance) {
    double worst = 0.0;
    for (const NamedSky& sky : skies()) {
        const double own = luminance(horizontal_diffuse(sky.daylight.sky).illuminance);
        const double horizontal = luminance(sky.sampler.unobstructed_irradiance(0, Vec3f(0.0f, 0.0f, 1.0f)));
        EXPECT_NEAR(horizontal, own, 1e-3 * own) << sky.name;
        worst = std::max(worst, std::abs(horizontal / own - 1.0));
        for (const Obstacle& obstacle : obstacles_to_judge()) {
            if (obstacle.name != "free wall") continue;
            const double exact = exact_illuminance(sky.daylight.sky, obstacle);
            const double wall = luminance(sky.sampler.unobstructed_irradiance(0, obstacle.normal));
            EXPECT_NEAR(wall, exact, 1e-3 * exact) << sky.name;
            worst = std::max(worst, std::abs(wall / exact - 1.0));
        }
    }
    std::printf("worst error of the table: %.2e\n", worst);
}

// Truth: quadrature on a fine grid. Free ground and walls are held to 0.5 % at 512 directions and 0.1 % at 4096, by the
// bare estimator too, but for pictures with their sun, most of whose light hangs on whether 400 or 402 of the
// directions meet the disc: there the ratio is what brings the exactness. Behind obstacles an edge cuts through the
// directions, and what is held is the measured error with a margin (docs/validation.md).
TEST(DomeSampling, ErrorsAgainstTheNumberOfDirections) {
    struct Limits {
        int count;
        double scaled_free, bare_formulas, bare_image, obstructed_rms;
    };
    std::vector<double> exact_of_case;
    for (const NamedSky& sky : skies()) {
        for (const Obstacle& obstacle : obstacles_to_judge())
            exact_of_case.push_back(exact_illuminance(sky.daylight.sky, obstacle));
    }
    for (const Limits& limits : {Limits{512, 0.005, 0.005, 0.008, 0.012}, Limits{4096, 0.001, 0.001, 0.003, 0.003}}) {
        std::size_t next = 0;
        double scaled = 0.0, bare_formulas = 0.0, bare_image = 0.0, squares = 0.0, worst = 0.0;
        int cases = 0;
        for (const NamedSky& sky : skies()) {
            for (const Obstacle& obstacle : obstacles_to_judge()) {
                const double exact = exact_of_case[next++];
                const double error = sampled_illuminance(sky.sampler, obstacle, limits.count) / exact - 1.0;
                if (obstacle.name.starts_with("free")) {
                    const double bare =
                        unscaled_illuminance(sky.sampler, sky.daylight.sky, obstacle, limits.count) / exact - 1.0;
                    EXPECT_LE(std::abs(error), limits.scaled_free) << sky.name << ", " << obstacle.name;
                    const bool is_image = std::holds_alternative<ImageSky>(sky.daylight.sky);
                    EXPECT_LE(std::abs(bare), is_image ? limits.bare_image : limits.bare_formulas)
                        << sky.name << ", " << obstacle.name;
                    scaled = std::max(scaled, std::abs(error));
                    double& worst_bare = is_image ? bare_image : bare_formulas;
                    worst_bare = std::max(worst_bare, std::abs(bare));
                } else {
                    squares += error * error;
                    worst = std::max(worst, std::abs(error));
                    ++cases;
                }
            }
        }
        const double rms = std::sqrt(squares / cases);
        EXPECT_LE(rms, limits.obstructed_rms) << limits.count;
        std::printf(
            "%d directions: free %.3f %%, without the ratio %.3f %% (formulas) and %.3f %% (picture with its sun), "
            "obstructed rms %.3f %%, worst %.2f %%\n",
            limits.count, 100.0 * scaled, 100.0 * bare_formulas, 100.0 * bare_image, 100.0 * rms, 100.0 * worst);
    }
}

// Truth: one set of directions serves every instant: the irradiance of each is that of its own sky.
TEST(DomeSampling, OneSetServesManyInstants) {
    std::vector<Daylight> instants;
    for (const NamedSky& sky : skies()) instants.push_back(sky.daylight);
    const DomeSampler sampler(instants);
    const DomeSamples samples = sampler.sample(Vec3f(0.0f, 0.0f, 1.0f), 4096);
    for (std::size_t k = 0; k < instants.size(); ++k) {
        double sum = 0.0;
        for (const Rgb& weight : samples.weights[k]) sum += static_cast<double>(luminance(weight));
        const double own = luminance(horizontal_diffuse(instants[k].sky).illuminance);
        EXPECT_NEAR(sum, own, 2e-3 * own) << skies()[k].name;
    }
}

}  // namespace
}  // namespace skybake
