#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/photon_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "light/photon_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace skybake {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMaxLanes = PatchArrays::kPadding;
using Lanes = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<Lanes>;

// Photons arrived on the same side: less than 25° between the normals. On the same plane: less than 2 cm, and a tenth
// of their distance, for kerbs and what is not quite flat.
constexpr float kSameSideCosine = 0.9063f;
constexpr float kOffPlane = 0.02f, kOffPlaneSlope = 0.1f;

struct Vectors {
    V x, y, z;
};

HWY_INLINE Vectors set(const Vec3f& v) {
    const Lanes tag;
    return {hn::Set(tag, v.x), hn::Set(tag, v.y), hn::Set(tag, v.z)};
}

HWY_INLINE V dot(const Vectors& a, const Vectors& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

bool is_within(const Vec2f& offset, const SurfaceLimits& limit) {
    for (std::size_t k = 0; k < limit.size(); ++k) {
        if (glm::dot(offset, surface_direction(k)) > limit[k]) return false;
    }
    return true;
}

void FindPhotonsWithin(const PatchArrays& patch, const PhotonQuery& query, const SurfaceAxes& axes, float radius,
                       std::vector<NearPhoton>& found) {
    const Lanes tag;
    const std::size_t width = hn::Lanes(tag), count = patch.photon.size();
    const Vectors position = set(query.position), normal = set(query.normal), u = set(axes.u), v = set(axes.v);
    const V reach = hn::Set(tag, radius), root = hn::Set(tag, 0.70710678118654752f);
    const V side = hn::Set(tag, kSameSideCosine), plane = hn::Set(tag, kOffPlane), slope = hn::Set(tag, kOffPlaneSlope);
    const bool is_circle = query.metric == SurfaceMetric::circle;
    const bool is_limited =
        std::any_of(query.limit.begin(), query.limit.end(), [](float l) { return std::isfinite(l); });
    found.clear();
    for (std::size_t begin = 0; begin < count; begin += width) {
        const std::size_t n = std::min(width, count - begin);
        const auto load = [&](std::span<const float> array) { return hn::LoadU(tag, array.data() + begin); };
        const Vectors off{hn::Sub(load(patch.x), position.x), hn::Sub(load(patch.y), position.y),
                          hn::Sub(load(patch.z), position.z)};
        const V along_u = dot(off, u), along_v = dot(off, v);
        const V a = hn::Abs(along_u), b = hn::Abs(along_v);
        const V distance = is_circle ? hn::Sqrt(hn::Add(hn::Mul(a, a), hn::Mul(b, b)))
                                     : hn::Max(hn::Max(a, b), hn::Mul(hn::Add(a, b), root));
        const auto near = hn::Lt(distance, reach);
        const auto on_plane = hn::Le(hn::Abs(dot(off, normal)), hn::Add(plane, hn::Mul(slope, distance)));
        const Vectors photon_normal{load(patch.normal_x), load(patch.normal_y), load(patch.normal_z)};
        const auto on_side = hn::Ge(dot(photon_normal, normal), side);
        const auto counts = hn::And(hn::And(near, on_plane), hn::And(on_side, hn::FirstN(tag, n)));
        if (hn::AllFalse(tag, counts)) continue;
        alignas(64) std::array<float, kMaxLanes> d, offset_u, offset_v;
        hn::Store(distance, tag, d.data());
        hn::Store(along_u, tag, offset_u.data());
        hn::Store(along_v, tag, offset_v.data());
        alignas(64) std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(tag, counts, bits.data());
        for (unsigned rest = bits[0] | unsigned{bits[1]} << 8; rest != 0; rest &= rest - 1) {
            const std::size_t lane = static_cast<std::size_t>(std::countr_zero(rest));
            const NearPhoton photon{d[lane], {offset_u[lane], offset_v[lane]}, patch.photon[begin + lane]};
            if (!is_limited || is_within(photon.offset, query.limit)) found.push_back(photon);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace skybake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skybake {

HWY_EXPORT(FindPhotonsWithin);

void find_photons_within(const PatchArrays& patch, const PhotonQuery& query, const SurfaceAxes& axes, float radius,
                         std::vector<NearPhoton>& found) {
    HWY_DYNAMIC_DISPATCH(FindPhotonsWithin)(patch, query, axes, radius, found);
}

}  // namespace skybake
#endif
