// Reflected light at a point from the photons about it (paper §3.2).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "light/path_reference.h"
#include "light/photon_search.h"
#include "light/surfaces.h"
#include "trace/ray_scene.h"

namespace skybake {

enum class PhotonArea {
    octagon,  // the photons' bounding octagon, extended so that it is unbiased
    hull,     // their convex hull, extended likewise
    circle    // the circle about the point out to the farthest photon
};
/// In the order of PhotonArea, as options and the manifest spell them.
inline constexpr std::array<std::string_view, 3> kPhotonAreaNames{"octagon", "hull", "circle"};

struct GatherOptions {
    int nearest = 200;  // photons per point, at least 4
    PhotonArea area = PhotonArea::octagon;
    int feelers = 8;  // short rays along the surface: 0, 4 or 8
};

/// Flux over area of photons in the plane, lx per channel.
///
/// `window` is a region of the plane, fixed or ended by a photon that is not among these: the ball of `radius` in the
/// area's metric about the point, less what lies beyond the limits: offset · direction k > limit[k], direction k at k ·
/// 45° from u. All photons must lie in it.
struct PhotonWindow {
    float radius = 0.0f;
    SurfaceLimits limit = no_limits();
};

/// The octagon's estimate ΣΦ (m − b) / (m A) of m photons, b of which touch their bounding octagon of area A: the
/// octagon is extended by m/(m − b). Unbiased for any m for photons evenly spread over the window or over its part up
/// to a straight border along the octagon's directions (docs/physics.md, "Octagon"); 0 where all touch it.
Rgb octagon_irradiance(std::span<const NearPhoton> photons, std::span<const Photon> all);

/// The hull's estimate: the same with the convex hull of the photons and its corners in place of the octagon and those
/// that touch it. Unbiased for any m for photons evenly spread over the window or over any convex part of it
/// (docs/physics.md, "Hull").
Rgb hull_irradiance(std::span<const NearPhoton> photons, std::span<const Photon> all);

/// The circle's estimate: ΣΦ over the window's area.
Rgb circle_irradiance(std::span<const NearPhoton> photons, std::span<const Photon> all, const PhotonWindow& window);

class PhotonGatherer {
  public:
    /// `area_m2` of all surfaces: no photon is looked for farther away than four times the radius that holds `nearest`
    /// of them on the mean.
    PhotonGatherer(const PhotonMap& map, const RayScene& rays, double area_m2, const GatherOptions& options);

    const PhotonMap& map() const { return map_; }

    /// Reflected light at a point of a surface. Feelers leave from a little above the surface and reach twice as far as
    /// the photons; beyond what they meet no photon counts, the area ends there, and others are looked for on this
    /// side, as far as the feelers. The standard error stays 0: one map knows nothing of its own. Adds the number of
    /// feelers traced to `ray_count`. `search` must be over the same map; one a thread.
    IndirectLight light(const ReceiverPoint& point, PhotonSearch& search, std::uint64_t& ray_count) const;

  private:
    Rgb estimate(std::span<const NearPhoton> found, const PhotonWindow& window) const;
    bool find_limits(const Vec3f& position, const Vec3f& normal, float reach, PhotonWindow& window,
                     std::uint64_t& ray_count) const;

    const PhotonMap& map_;
    const RayScene& rays_;
    GatherOptions options_;
    float max_distance_;
};

/// The same at free points; parallel.
std::vector<IndirectLight> gather_indirect(std::span<const ReceiverPoint> points, const PhotonGatherer& gatherer,
                                           std::uint64_t& ray_count);

}  // namespace skybake
