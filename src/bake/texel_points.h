// Places in the texels of one chart that rays leave from, and packets of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "atlas/chart_samples.h"
#include "trace/ray_scene.h"

namespace skybake {

/// A texel's 16 subsamples: the centres of 4 × 4 parts.
inline constexpr int kSubdivision = 4;
inline constexpr int kSubsamples = kSubdivision * kSubdivision;

class TexelPoints {
  public:
    TexelPoints(const Scene& scene, const Chart& chart, const ChartSamples& samples, const RayScene& rays)
        : scene_(scene), chart_(chart), samples_(samples), offset_(rays.surface_offset()) {}

    Vec3f normal(std::size_t texel) const;

    /// The texel's own point, lifted off the surface.
    Vec3f lifted(std::size_t texel) const { return samples_.position[texel] + offset_ * normal(texel); }

    /// Subsample `sub` of a covered texel, lifted off the triangle it lies in: the texel's or one that a neighbour lies
    /// in; none outside of these. On its own triangle, since planar charts hold slopes of half a degree: in the
    /// chart's plane it would be under the ground.
    std::optional<Vec3f> subsample(int column, int row, int sub) const;

  private:
    const Scene& scene_;
    const Chart& chart_;
    const ChartSamples& samples_;
    float offset_;
};

/// Collects rays and traces them sixteen at a time through `Packet::visibility`; on_light(tag, share) is called for
/// each ray that some share of the light comes through, in the order of their coming.
template <typename Packet, typename Tag, typename OnLight>
class RayBatch {
  public:
    RayBatch(Packet& packet, OnLight on_light) : packet_(packet), on_light_(on_light) {}
    void add(const Vec3f& p, const Tag& tag) {
        x_[count_] = p.x;
        y_[count_] = p.y;
        z_[count_] = p.z;
        tag_[count_++] = tag;
        if (count_ == RayScene::kPacketSize) flush();
    }
    void flush() {
        if (count_ == 0) return;
        packet_.visibility(x_.data(), y_.data(), z_.data(), count_, share_.data());
        for (int i = 0; i < count_; ++i) {
            if (share_[i] > 0.0f) on_light_(tag_[i], share_[i]);
        }
        traced += static_cast<std::uint64_t>(count_);
        count_ = 0;
    }
    std::uint64_t traced = 0;

  private:
    Packet& packet_;
    OnLight on_light_;
    std::array<float, RayScene::kPacketSize> x_, y_, z_, share_;
    std::array<Tag, RayScene::kPacketSize> tag_;
    int count_ = 0;
};

}  // namespace skybake
