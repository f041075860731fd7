// The density estimates on photons whose density is known: unbiased at any number, at borders and in corners; feelers
// against leaks.
#include "light/photon_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/hash_rng.h"
#include "light/surfaces.h"
#include "vessels.h"

namespace skybake {
namespace {

struct MeanAndError {
    double mean = 0.0;
    double error = 0.0;  // of the mean
};

/// Mean estimate at the origin, over `trials` sets of photons spread evenly with density 1 (lm/m²) over the part of
/// [−reach, reach]² where `is_surface` holds.
MeanAndError estimate(int nearest, PhotonArea area, int trials, const std::function<bool(const Vec2f&)>& is_surface,
                      const Scene& scene = {}, int feelers = 0, const Vec3f& position = Vec3f(0)) {
    const RayScene rays(scene);
    const float reach = 1.6f * std::sqrt(static_cast<float>(nearest));
    const int count = static_cast<int>(4.0f * reach * reach);
    const float flux = 4.0f * reach * reach / static_cast<float>(count);
    double sum = 0.0, square = 0.0;
    for (int t = 0; t < trials; ++t) {
        std::vector<Photon> photons;
        RandomSequence random(17, static_cast<std::uint64_t>(nearest), static_cast<std::uint64_t>(t));
        for (int i = 0; i < count; ++i) {
            const float x = random.next(), y = random.next();
            const Vec2f p = reach * (2.0f * Vec2f(x, y) - 1.0f);
            if (is_surface(p)) photons.emplace_back(Vec3f(p, 0.0f), Vec3f(0, 0, 1), Rgb(flux));
        }
        const PhotonMap map(std::move(photons));
        const PhotonGatherer gatherer(map, rays, static_cast<double>(map.photons().size()), {nearest, area, feelers});
        PhotonSearch search(map);
        std::uint64_t traced = 0;
        const double e =
            static_cast<double>(luminance(gatherer.light({position, {0, 0, 1}}, search, traced).irradiance));
        sum += e;
        square += e * e;
    }
    const double mean = sum / trials;
    return {mean, std::sqrt((square / trials - mean * mean) / trials)};
}

bool everywhere(const Vec2f&) {
    return true;
}
bool half(const Vec2f& p) {
    return p.y < 0.0f;
}
bool quarter(const Vec2f& p) {
    return p.x < 0.0f && p.y < 0.0f;
}
bool diagonal_half(const Vec2f& p) {
    return p.x + p.y < 0.0f;
}

void expect_one(const char* what, int nearest, const MeanAndError& e) {
    std::printf("%s, %d photons: %.4f ± %.4f\n", what, nearest, e.mean, e.error);
    // Five standard errors: with the twenty cases here, a right estimate fails once in 10⁵ runs.
    EXPECT_NEAR(e.mean, 1.0, 5.0 * e.error) << what << ' ' << nearest;
    EXPECT_LT(e.error, 0.02) << what << ' ' << nearest;
}

TEST(Octagon, IsUnbiasedForAnyNumberOfPhotons) {
    for (const int nearest : {8, 12, 20, 50, 200})
        expect_one("plane", nearest, estimate(nearest, PhotonArea::octagon, 200000 / nearest, everywhere));
}

TEST(Octagon, IsUnbiasedAtBordersAndInCorners) {
    for (const int nearest : {12, 50}) {
        expect_one("border", nearest, estimate(nearest, PhotonArea::octagon, 200000 / nearest, half));
        expect_one("corner", nearest, estimate(nearest, PhotonArea::octagon, 200000 / nearest, quarter));
        expect_one("oblique border", nearest, estimate(nearest, PhotonArea::octagon, 200000 / nearest, diagonal_half));
    }
}

/// A border midway between its directions: the octagon's tips stand out over it, and the estimate is too dark, by an
/// eighth where the point lies on the border itself. The circle is at a half there.
TEST(Octagon, IsAnEighthTooDarkOnABorderAtTheWorstAngle) {
    const MeanAndError e = estimate(50, PhotonArea::octagon, 8000, [](const Vec2f& p) {
        return p.x * std::sin(static_cast<float>(kPi / 8)) + p.y * std::cos(static_cast<float>(kPi / 8)) < 0.0f;
    });
    std::printf("border at 22.5°: %.4f ± %.4f\n", e.mean, e.error);
    EXPECT_NEAR(e.mean, 0.88, 0.01);
}

/// No border is oblique to a hull.
TEST(Hull, IsUnbiasedAtAnyConvexBorder) {
    const auto border = [](double degrees, double distance) {
        const Vec2f normal(Vec2d(std::cos(degrees * kPi / 180.0), std::sin(degrees * kPi / 180.0)));
        return [normal, distance](const Vec2f& p) { return glm::dot(p, normal) < static_cast<float>(distance); };
    };
    for (const int nearest : {12, 50, 200}) {
        const int trials = 200000 / nearest;
        expect_one("plane", nearest, estimate(nearest, PhotonArea::hull, trials, everywhere));
        expect_one("corner", nearest, estimate(nearest, PhotonArea::hull, trials, quarter));
        for (const double degrees : {10.0, 67.5})
            expect_one("border", nearest, estimate(nearest, PhotonArea::hull, trials, border(degrees, 0.0)));
        if (nearest < 50) continue;  // too few in reach of so narrow a corner: the window answers
        expect_one("acute corner", nearest, estimate(nearest, PhotonArea::hull, trials, [&](const Vec2f& p) {
                       return border(20.0, 0.0)(p) && border(170.0, 0.5)(p);
                   }));
    }
}

TEST(Circle, IsUnbiasedInThePlaneAndHalfAsBrightAtABorder) {
    for (const int nearest : {8, 50}) {
        expect_one("circle", nearest, estimate(nearest, PhotonArea::circle, 100000 / nearest, everywhere));
        EXPECT_NEAR(estimate(nearest, PhotonArea::circle, 100000 / nearest, half).mean, 0.5, 0.02);
    }
}

/// A wall's foot: the floor goes on under the wall, where no photon comes. The circle takes the dark part for its own;
/// with feelers the area ends at the wall.
TEST(Feelers, EndTheAreaAtAWallsFoot) {
    const Scene scene =
        QuadScene().ground(60).quad({60, 0.05f, 0}, {-60, 0.05f, 0}, {-60, 0.05f, 30}, {60, 0.05f, 30}).scene();
    const auto outside = [](const Vec2f& p) { return p.y < 0.05f; };
    EXPECT_LT(estimate(50, PhotonArea::circle, 2000, outside, scene, 0).mean, 0.6);
    expect_one("circle and feelers", 50, estimate(50, PhotonArea::circle, 4000, outside, scene, 4));
    expect_one("octagon and feelers", 50, estimate(50, PhotonArea::octagon, 4000, outside, scene, 8));
}

/// A thin wall between a bright court and a dark passage: none of the court's photons counts behind it.
TEST(Feelers, KeepLightFromLeakingThroughAThinWall) {
    const Scene scene = QuadScene().ground(60).quad({60, 0, 0}, {-60, 0, 0}, {-60, 0, 30}, {60, 0, 30}).scene();
    const Vec3f behind(0, 0.5f, 0);
    EXPECT_GT(estimate(50, PhotonArea::octagon, 200, half, scene, 0, behind).mean, 0.5);
    EXPECT_GT(estimate(50, PhotonArea::circle, 200, half, scene, 0, behind).mean, 0.3);
    for (const int feelers : {4, 8}) {
        EXPECT_EQ(estimate(50, PhotonArea::octagon, 200, half, scene, feelers, behind).mean, 0.0);
        EXPECT_EQ(estimate(50, PhotonArea::circle, 200, half, scene, feelers, behind).mean, 0.0);
    }
}

TEST(PhotonSearch, FindsWhatASearchThroughAllFinds) {
    std::vector<Photon> photons;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        RandomSequence random(5, i, 0);
        const float x = random.next(), y = random.next(), z = random.next(), side = random.next();
        photons.emplace_back(Vec3f(20.0f * x, 20.0f * y, 0.2f * z), Vec3f(0, 0, side < 0.5f ? -1.0f : 1.0f), Rgb(1.0f));
    }
    const PhotonMap map(photons);
    PhotonSearch search(map);  // of both: what it has taken must not change what it finds
    for (const SurfaceMetric metric : {SurfaceMetric::circle, SurfaceMetric::octagon}) {
        for (std::uint64_t q = 0; q < 200; ++q) {
            RandomSequence random(6, q, 0);
            const float x = random.next(), y = random.next();
            const Vec3f at(20.0f * x, 20.0f * y, 0.1f);
            std::vector<float> all;
            for (const Photon& photon : map.photons()) {
                const Vec3f off = photon.position - at;
                const float a = std::abs(off.x), b = std::abs(off.y);
                const float d = metric == SurfaceMetric::circle ? std::sqrt(a * a + b * b)
                                                                : std::max({a, b, 0.70710678f * (a + b)});
                if (photon.normal().z > 0.0f && std::abs(off.z) <= 0.02f + 0.1f * d) all.push_back(d);
            }
            std::sort(all.begin(), all.end());
            const std::span<const NearPhoton> nearest = search.nearest({at, {0, 0, 1}, metric, 30, 20.0f, no_limits()});
            ASSERT_EQ(nearest.size(), 30u);
            EXPECT_EQ(nearest.front().distance, std::ranges::max(nearest, {}, &NearPhoton::distance).distance);
            std::vector<float> found;
            for (const NearPhoton& photon : nearest) found.push_back(photon.distance);
            std::sort(found.begin(), found.end());
            for (std::size_t k = 0; k < 30; ++k) EXPECT_NEAR(found[k], all[k], 1e-5f);
        }
    }
}

/// On slopes that turn by 20°, with a dense half and a sparse one, and with limits: a search that has answered for
/// other points finds what a new one does.
TEST(PhotonSearch, FindsTheSameWhateverWasAskedBefore) {
    const auto normal_at = [](float x) { return glm::normalize(Vec3f(-0.36f * std::sin(0.2f * x), 0, 1)); };
    const auto height_at = [](float x) { return -1.8f * std::cos(0.2f * x); };
    std::vector<Photon> photons;
    for (std::uint64_t i = 0; i < 30000; ++i) {
        RandomSequence random(7, i, 0);
        const float side = random.next(), x = random.next(), y = random.next();
        const float along = side < 0.9f ? 10.0f * x : 10.0f + 10.0f * x;
        photons.emplace_back(Vec3f(along, 20.0f * y, height_at(along)), normal_at(along), Rgb(1.0f));
    }
    const PhotonMap map(photons);
    PhotonSearch used(map);
    for (std::uint64_t q = 0; q < 1500; ++q) {
        RandomSequence random(9, q / 10, 0);  // ten neighbours, then elsewhere
        const float x = 19.0f * random.next() + 0.05f * static_cast<float>(q % 10), y = 20.0f * random.next();
        PhotonQuery query{{x, y, height_at(x)}, normal_at(x), SurfaceMetric::octagon, 40, 8.0f, no_limits()};
        if (q % 3 == 1) query.limit[q % 8] = 0.3f;
        PhotonSearch fresh(map);
        const std::span<const NearPhoton> expected = fresh.nearest(query), found = used.nearest(query);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t k = 0; k < found.size(); ++k) ASSERT_EQ(found[k].photon, expected[k].photon) << q;
    }
}

TEST(PhotonCode, KeepsFluxColourAndNormal) {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        RandomSequence random(8, i, 0);
        const float a = random.next(), b = random.next(), r = random.next(), g = random.next(), c = random.next();
        const Vec3f normal = square_to_cosine_hemisphere(i % 2 ? Vec3f(0, 0, 1) : Vec3f(0, 0, -1), a, b);
        const Rgb flux = 37.0f * Rgb(r, g, c);
        const Photon photon({1, 2, 3}, normal, flux);
        EXPECT_NEAR(luminance(photon.flux()) / luminance(flux), 1.0f, 1e-5f);
        EXPECT_LT(glm::length(photon.flux() - flux), 1e-3f * luminance(flux));
        EXPECT_GT(glm::dot(photon.normal(), normal), 1.0f - 1e-6f);
    }
    EXPECT_EQ(Photon({0, 0, 0}, {0, -1, 0}, Rgb(1)).normal(), Vec3f(0, -1, 0));
}

}  // namespace
}  // namespace skybake
