// The straight way of a photon or a path through surfaces and crowns.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "base/hash_rng.h"
#include "light/surfaces.h"
#include "trace/ray_scene.h"

namespace skybake {

/// One way at a time; one object a thread. Scene and rays must outlive it.
class Flight {
  public:
    Flight(const Scene& scene, const RayScene& rays) : scene_(scene), rays_(rays) {}

    /// Where light from `origin` along the unit `direction` ends: on a surface, or on a leaf, of whose crowns it passes
    /// exp(−optical depth) in the mean; none when it leaves the scene. Takes a random number only where it meets
    /// crowns.
    std::optional<SurfacePoint> end(const Vec3f& origin, const Vec3f& direction, RandomSequence& random);

    /// The outsides of crowns that it came through on that way, the last one where it may have ended: they get light as
    /// surfaces do.
    const std::vector<SurfacePoint>& passed() const { return passed_; }

  private:
    std::optional<SurfacePoint> leaf_on_the_way(const Vec3f& origin, const Vec3f& direction, float distance,
                                                float depth);

    const Scene& scene_;
    const RayScene& rays_;
    std::vector<CrownCrossing> crossings_;
    std::vector<SurfacePoint> passed_;
};

/// The albedo of a single scattering with which a deep body of leaves reflects as a surface of the given albedo: w = 1
/// −
/// ((1 − R) / (1 + R))². Source: B. Hapke, "Bidirectional reflectance spectroscopy 1", 1981, eq. 20 (diffusive
/// reflectance).
Rgb leaf_albedo(const Rgb& crown_albedo);

}  // namespace skybake
