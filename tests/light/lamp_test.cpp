// Lamps in closed form: inverse square, cosine, cone, flux, colour.
#include "light/lamp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/hash_rng.h"
#include "light/lamp_tree.h"
#include "light/point_light.h"
#include "light/surfaces.h"
#include "vessels.h"

namespace skybake {
namespace {

TEST(LampLight, FollowsInverseSquareAndCosine) {
    const Lamp lamp = point_lamp({0, 0, 5}, 1000.0f);
    for (const float x : {0.0f, 1.0f, 3.0f, 12.0f}) {
        const float r2 = 25.0f + x * x;
        EXPECT_NEAR(luminance(unobstructed_irradiance(lamp, {x, 0, 0}, {0, 0, 1})), 1000.0f * 5.0f / std::pow(r2, 1.5f),
                    1e-3f);
    }
    EXPECT_EQ(unobstructed_irradiance(lamp, {0, 0, 6}, {0, 0, 1}), Rgb(0));
}

TEST(LampLight, StandsInShadows) {
    const Scene scene = QuadScene().ground(20).box({1, -1, 0}, {2, 1, 3}).scene();
    const RayScene rays(scene);
    const std::vector<Lamp> lamps{point_lamp({0, 0, 2}, 100.0f), point_lamp({8, 0, 2}, 50.0f)};
    const std::vector<ReceiverPoint> points{{{4, 0, 0}, {0, 0, 1}}, {{-1, 0, 0}, {0, 0, 1}}};
    const std::vector<Rgb> light = light_points_by_lamps(points, lamps, rays);
    EXPECT_NEAR(luminance(light[0]), 50.0f * 2.0f / std::pow(20.0f, 1.5f), 1e-4f);  // only the lamp on its side
    EXPECT_NEAR(luminance(light[1]), 100.0f * 2.0f / std::pow(5.0f, 1.5f), 1e-4f);
}

TEST(LampLight, SpotHasItsConeAndItsFlux) {
    Lamp spot{"s", Lamp::Type::spot, {0, 0, 4}, Rgb(1.0f), {0, 0, -1}, 0.5f, 0.0f};
    EXPECT_EQ(intensity_share(spot, glm::normalize(Vec3f(std::tan(0.49f), 0, -1))), 1.0f);
    EXPECT_EQ(intensity_share(spot, glm::normalize(Vec3f(std::tan(0.51f), 0, -1))), 0.0f);
    EXPECT_NEAR(effective_solid_angle(spot), 2.0 * kPi * (1.0 - std::cos(0.5)), 1e-6);
    spot.blend_rad = 0.2f;
    EXPECT_NEAR(intensity_share(spot, glm::normalize(Vec3f(std::tan(0.4f), 0, -1))), 0.5f, 1e-4f);
    // The flux on a fine grid of the plane below is intensity times solid angle.
    double flux = 0.0;
    constexpr double kStep = 0.01;
    for (double x = -3.0; x < 3.0; x += kStep) {
        for (double y = -3.0; y < 3.0; y += kStep) {
            flux += kStep * kStep *
                    static_cast<double>(
                        unobstructed_irradiance(spot, Vec3f(Vec3d(x + kStep / 2, y + kStep / 2, 0)), {0, 0, 1}).x);
        }
    }
    EXPECT_NEAR(flux / effective_solid_angle(spot), 1.0, 1e-3);
}

/// A Lambertian luminaire, I = I₀ cos γ, measured each 2.5°: the flux is π I₀.
LightProfile lambertian(double peak_cd) {
    std::vector<double> gamma, candela;
    for (int i = 0; i <= 36; ++i) {
        gamma.push_back(radians_from_degrees(2.5 * i));
        candela.push_back(i == 36 ? 0.0 : peak_cd * std::cos(gamma.back()));
    }
    return {{0.0}, gamma, candela};
}

TEST(LightProfiles, LambertianHasItsFlux) {
    const LightProfile profile = lambertian(200.0);
    EXPECT_EQ(profile.peak_cd(), 200.0);
    // A chord lies below the cosine by h²/8 of its curvature at most: 2.4e-4, two thirds of it on the mean.
    EXPECT_NEAR(profile.solid_angle() / kPi, 1.0, 3e-4);
    EXPECT_NEAR(profile.share(glm::normalize(Vec3f(1, 0, 1))), std::sqrt(0.5f), 3e-4f);
    EXPECT_EQ(profile.share({0, 0, -1}), 0.0f);
}

/// C = 90° lies counter-clockwise of C = 0 for who looks down on the lamp; between planes the share is linear in C.
TEST(LightProfiles, TurnWithTheirLamp) {
    const auto profile = std::make_shared<const LightProfile>(std::vector<double>{0.0, kPi / 2, kPi, 3 * kPi / 2},
                                                              std::vector<double>{0.0, kPi},
                                                              std::vector<double>{100, 100, 50, 50, 20, 20, 10, 10});
    Lamp lamp{"p", Lamp::Type::profile, {0, 0, 5}, Rgb(100.0f)};
    lamp.profile = profile;
    lamp.c_zero = {0, 1, 0};  // to the north
    EXPECT_NEAR(intensity_share(lamp, glm::normalize(Vec3f(0, 1, -1))), 1.0f, 1e-5f);
    EXPECT_NEAR(intensity_share(lamp, glm::normalize(Vec3f(-1, 0, -1))), 0.5f, 1e-5f);  // west
    EXPECT_NEAR(intensity_share(lamp, glm::normalize(Vec3f(0, -1, -1))), 0.2f, 1e-5f);
    EXPECT_NEAR(intensity_share(lamp, glm::normalize(Vec3f(1, 0, -1))), 0.1f, 1e-5f);
    EXPECT_NEAR(intensity_share(lamp, glm::normalize(Vec3f(-1, 1, -1))), 0.75f, 1e-5f);
    EXPECT_NEAR(intensity_share(lamp, glm::normalize(Vec3f(1, 1, -1))), 0.55f, 1e-5f);  // from the last to the first
}

/// The mean of share over density is the solid angle, for each kind of lamp; and directions lie where it shines.
TEST(LampSamples, HaveTheirDensity) {
    Lamp spot{"s", Lamp::Type::spot, {0, 0, 4}, Rgb(1.0f), glm::normalize(Vec3f(1, 2, -3)), 0.9f, 0.4f};
    Lamp profile = spot;
    profile.type = Lamp::Type::profile;
    profile.c_zero = glm::normalize(glm::cross(profile.axis, Vec3f(0, 0, 1)));
    profile.profile = std::make_shared<const LightProfile>(lambertian(3.0));
    Lamp point = spot;
    point.type = Lamp::Type::point;
    for (const Lamp& lamp : {point, spot, profile}) {
        double sum = 0.0, worst = 0.0;
        constexpr int kSide = 512;
        for (int i = 0; i < kSide * kSide; ++i) {
            const LampSample sample = sample_lamp(lamp, (static_cast<float>(i % kSide) + 0.5f) / kSide,
                                                  (static_cast<float>(i / kSide) + 0.5f) / kSide);
            const double ratio = static_cast<double>(intensity_share(lamp, sample.direction)) / sample.pdf_solid_angle;
            sum += ratio;
            worst = std::max(worst, ratio);
        }
        EXPECT_NEAR(sum / (kSide * kSide) / effective_solid_angle(lamp), 1.0, 1e-3);
        // Photons of nearly one flux: at worst twice the mean, where in the last cell before γ = 90° the share falls
        // from twice the cell's mean to 0. Evenly over the sphere it would be four times.
        if (lamp.type == Lamp::Type::profile) {
            EXPECT_LT(worst / effective_solid_angle(lamp), 2.0);
        }
    }
}

/// What is left out is below the cutoff at every point of the patch, whatever the lamps; a cutoff of 0 leaves out none
/// that shines there.
TEST(LampTrees, KeepTheirBound) {
    RandomSequence random(7, 0, 0);
    const auto in = [&](float lo, float hi) { return lo + (hi - lo) * random.next(); };
    std::vector<Lamp> lamps;
    for (int i = 0; i < 500; ++i) {
        Lamp lamp = point_lamp({in(-300, 300), in(-300, 300), in(0, 12)}, in(10, 1000));
        lamp.axis = glm::normalize(Vec3f(in(-1, 1), in(-1, 1), -1));
        lamp.c_zero = glm::normalize(glm::cross(lamp.axis, Vec3f(1, 0, 0)));
        lamp.cone_half_angle_rad = in(0.2f, 2.0f);
        lamp.blend_rad = 0.1f;
        lamp.type = static_cast<Lamp::Type>(i % 3);
        lamp.profile = std::make_shared<const LightProfile>(lambertian(1.0));
        lamps.push_back(lamp);
    }
    const LampTree tree(lamps);
    for (const Vec3f& normal : {Vec3f(0, 0, 1), Vec3f(0, -1, 0), glm::normalize(Vec3f(1, 1, 1))}) {
        const TangentFrame frame = tangent_frame(normal);
        std::vector<Vec3f> points;
        ReceiverPatch patch{{}, true, normal, 1e9f};
        for (int i = 0; i < 64; ++i) {
            points.push_back(Vec3f(20, -30, 1) + in(-8, 8) * frame.u + in(-8, 8) * frame.v);
            patch.box.extend(points.back());
            patch.plane_offset = std::min(patch.plane_offset, glm::dot(normal, points.back()));
        }
        for (const double cutoff : {0.0, 0.05, 1.0}) {
            const std::vector<std::uint32_t> kept = tree.relevant(patch, cutoff);
            EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
            if (cutoff > 0.0) {
                EXPECT_LT(kept.size(), lamps.size());
            }
            for (const Vec3f& p : points) {
                double dropped = 0.0;
                for (std::uint32_t l = 0; l < lamps.size(); ++l) {
                    if (!std::binary_search(kept.begin(), kept.end(), l))
                        dropped += static_cast<double>(luminance(unobstructed_irradiance(lamps[l], p, normal)));
                }
                EXPECT_LE(dropped, cutoff * (1.0 + 1e-4)) << kept.size();
            }
        }
    }
}

/// CIE 15: illuminant A is a black body of 2856 K with x = 0.4476, y = 0.4074.
TEST(BlackBody, IsIlluminantA) {
    const Rgb a = black_body_colour(2856.0);
    EXPECT_NEAR(luminance(a), 1.0f, 1e-5f);
    // Rec. 709 of x = 0.4476, y = 0.4074, Y = 1 by the matrix of IEC 61966-2-1.
    EXPECT_NEAR(a.x, 1.8456f, 0.01f);
    EXPECT_NEAR(a.y, 0.8259f, 0.01f);
    EXPECT_NEAR(a.z, 0.2334f, 0.01f);
    EXPECT_LT(black_body_colour(10000.0).x, black_body_colour(10000.0).z);
}

}  // namespace
}  // namespace skybake
