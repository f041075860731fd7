// Rays against the city: the only user of Embree.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "base/vec.h"
#include "scene/scene.h"
#include "trace/crown_volume.h"

namespace skybake {

/// What a ray meets first.
struct Hit {
    float distance = 0.0f;
    std::uint32_t triangle = 0;  // index into Scene::triangles
    float u = 0.0f, v = 0.0f;    // barycentric: corner 1 and 2
    bool is_back_face = false;   // the ray meets the inner side
};

/// The bounding volume hierarchy over a scene's triangles. Read-only after construction: any number of threads may
/// trace. Triangles block light from both sides; those of Scene::crowns block none of it, but dim it.
class RayScene {
  public:
    static constexpr int kPacketSize = 16;

    explicit RayScene(const Scene& scene);
    /// The same over bare triangles, metres; hits name their index.
    explicit RayScene(std::span<const std::array<Vec3f, 3>> triangles);
    ~RayScene();
    RayScene(RayScene&&) noexcept;

    /// True when something blocks the segment from `origin` along unit `direction`, up to `distance` metres.
    bool is_occluded(const Vec3f& origin, const Vec3f& direction,
                     float distance = std::numeric_limits<float>::infinity()) const;

    /// The share of light that comes through from there: 0 behind a surface, exp(−optical depth) behind crowns, else 1.
    float visibility(const Vec3f& origin, const Vec3f& direction,
                     float distance = std::numeric_limits<float>::infinity()) const;

    /// The scene's crowns; null without any.
    const CrownVolume* crowns() const;

    /// The nearest hit of a surface that is no crown's, or none.
    std::optional<Hit> first_hit(const Vec3f& origin, const Vec3f& direction) const;

    /// How far ray origins are lifted off their surface, metres: well above the rounding of float coordinates of this
    /// scene.
    float surface_offset() const;

    /// Name of the instruction set that Embree traces with ("avx2", "avx512", …): hits may differ between them.
    const char* isa() const;

  private:
    friend class DirectionPacket;
    friend class TargetPacket;
    struct Embree;
    RayScene(std::span<const std::array<Vec3f, 3>> triangles, const std::vector<std::uint32_t>& crown_of);

    std::unique_ptr<Embree> embree_;
};

struct RayPacket;

/// Packets of 16 rays that share one direction: neighbouring texels looking at the same point of the sky. This is what
/// the tracer is fastest at (docs/architecture.md, "Rays"). One object a thread.
class DirectionPacket {
  public:
    explicit DirectionPacket(const RayScene& scene);
    ~DirectionPacket();

    /// The unit direction of all rays that follow, and how far they look, metres.
    void set_direction(const Vec3f& direction, float distance = std::numeric_limits<float>::infinity());

    /// Bit i of the result is set when the ray from (x[i], y[i], z[i]) is blocked; only the first `count` ≤ 16 are
    /// traced and read.
    std::uint32_t occluded(const float* x, const float* y, const float* z, int count);

    /// share[i] of the light comes through to (x[i], y[i], z[i]), as RayScene::visibility.
    void visibility(const float* x, const float* y, const float* z, int count, float* share);

    /// What crowns leave of it: exp(−optical depth), for those of the points that are set in `wanted`; else 1.
    void transmittance(const float* x, const float* y, const float* z, std::uint32_t wanted, int count, float* share);

  private:
    const RayScene& scene_;
    std::unique_ptr<RayPacket> rays_;
    float distance_ = 0.0f;
};

/// Packets of 16 rays that share their end: neighbouring texels looking at one lamp. One object a thread.
class TargetPacket {
  public:
    explicit TargetPacket(const RayScene& scene);
    ~TargetPacket();

    void set_target(const Vec3f& target) { target_ = target; }

    /// Bit i of the result is set when something stands between (x[i], y[i], z[i]) and the target; only the first
    /// `count` ≤ 16 are traced and read.
    std::uint32_t occluded(const float* x, const float* y, const float* z, int count);

    /// share[i] of the target's light comes through to (x[i], y[i], z[i]), as RayScene::visibility.
    void visibility(const float* x, const float* y, const float* z, int count, float* share);

  private:
    const RayScene& scene_;
    std::unique_ptr<RayPacket> rays_;
    Vec3f target_{0.0f};
};

}  // namespace skybake
