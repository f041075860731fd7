// Crowns of trees as bodies that dim light on its way: Beer and Lambert's law along rays.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace skybake {

/// Where a ray goes through a crown's surface.
struct CrownCrossing {
    float distance = 0.0f;  // along the ray, metres; negative behind its origin
    std::uint32_t triangle = 0;
    float u = 0.0f, v = 0.0f;  // barycentric: corner 1 and 2
    bool is_entry = false;     // comes from outside
    float extinction = 0.0f;   // of the body that begins or ends here, m⁻¹
    float depth = 0.0f;        // of an open surface: of the crossing itself
};

/// The crowns of a scene in a hierarchy of their own. A crown is a homogeneous body: light that went s metres through
/// it is left with exp(−extinction s); bodies that overlap add up. Read-only after construction.
class CrownVolume {
  public:
    static constexpr int kPacketSize = 16;

    /// At least one crown. `device`: Embree's (RTCDevice).
    CrownVolume(void* device, const Scene& scene);
    ~CrownVolume();

    std::span<const Crown> crowns() const { return crowns_; }

    /// Optical depth from `origin` along the unit `direction` up to `distance` metres.
    float optical_depth(const Vec3f& origin, const Vec3f& direction,
                        float distance = std::numeric_limits<float>::infinity()) const;

    /// The same for the first `count` ≤ 16 rays of a packet; only those that are set in `wanted` are looked at, the
    /// others' depth is 0. Directions are unit vectors.
    struct Rays {
        const float *x, *y, *z, *direction_x, *direction_y, *direction_z, *distance;
    };
    void optical_depth(const Rays& rays, std::uint32_t wanted, int count, float* depth) const;

    /// Crossings of the whole line through `origin` up to `distance` that matter to the ray: those ahead of the origin
    /// and the entries behind it into bodies that it stands in. In order of distance.
    void crossings(const Vec3f& origin, const Vec3f& direction, float distance, std::vector<CrownCrossing>& out) const;

  private:
    struct Embree;
    std::vector<Crown> crowns_;
    float reach_ = 0.0f;  // no body is longer, metres
    std::unique_ptr<Embree> embree_;
};

}  // namespace skybake
