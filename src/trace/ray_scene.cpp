#include "trace/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

#include "base/check.h"
#include "scene/find_crowns.h"

namespace skybake {

struct RayScene::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    float surface_offset = 1e-3f;
    std::unique_ptr<CrownVolume> crowns;  // null: none

    ~Embree() {
        crowns.reset();
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

namespace {

RTCIntersectContext coherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

void check_device(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error("Embree cannot build its hierarchy: error " + std::to_string(error));
}

RTCRay single_ray(const Vec3f& origin, const Vec3f& direction, float distance) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = 0.0f;
    ray.tfar = distance;
    ray.mask = ~0u;
    return ray;
}

}  // namespace

RayScene::RayScene(const Scene& scene) : RayScene(scene.triangles, crown_of_triangles(scene)) {
    if (scene.crowns.empty()) return;
    embree_->crowns = std::make_unique<CrownVolume>(embree_->device, scene);
    check_device(embree_->device);
}

RayScene::RayScene(std::span<const std::array<Vec3f, 3>> triangles) : RayScene(triangles, {}) {}

/// `crown_of` [triangle] or empty: what belongs to a crown is left out.
RayScene::RayScene(std::span<const std::array<Vec3f, 3>> triangles, const std::vector<std::uint32_t>& crown_of)
    : embree_(std::make_unique<Embree>()) {
    embree_->device = rtcNewDevice(nullptr);
    if (!embree_->device) throw std::runtime_error("Embree cannot start on this processor");
    embree_->scene = rtcNewScene(embree_->device);
    // Not RTC_SCENE_FLAG_ROBUST: it costs a quarter of the rays per second and changes 1e-5 of the light
    // (docs/decisions/0006-rays-without-the-robust-flag.md).
    rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_HIGH);

    if (!triangles.empty()) {
        RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const std::size_t count = triangles.size();
        auto* vertices = static_cast<Vec3f*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 3 * count));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
        if (!vertices || !indices) throw std::bad_alloc();
        std::memcpy(vertices, triangles.data(), triangles.size_bytes());
        for (std::size_t i = 0; i < count; ++i) {
            // A triangle with one corner has no area: no ray hits it, and those after it keep their numbers.
            const bool is_left_out = !crown_of.empty() && crown_of[i] != kNoCrown;
            for (std::size_t k = 0; k < 3; ++k)
                indices[3 * i + k] = static_cast<std::uint32_t>(3 * i + (is_left_out ? 0 : k));
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(embree_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(embree_->scene);
    check_device(embree_->device);

    float reach = 1.0f;
    for (const std::array<Vec3f, 3>& triangle : triangles) {
        for (const Vec3f& corner : triangle)
            reach = std::max({reach, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    }
    // 16 units in the last place of the farthest coordinate: a corner is off by half of one, a plane through three by a
    // few.
    embree_->surface_offset = std::max(1e-3f, 16.0f * reach * 0x1p-23f);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

bool RayScene::is_occluded(const Vec3f& origin, const Vec3f& direction, float distance) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = single_ray(origin, direction, distance);
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

float RayScene::visibility(const Vec3f& origin, const Vec3f& direction, float distance) const {
    if (is_occluded(origin, direction, distance)) return 0.0f;
    return embree_->crowns ? std::exp(-embree_->crowns->optical_depth(origin, direction, distance)) : 1.0f;
}

const CrownVolume* RayScene::crowns() const {
    return embree_->crowns.get();
}

std::optional<Hit> RayScene::first_hit(const Vec3f& origin, const Vec3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = single_ray(origin, direction, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const Vec3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    return Hit{query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v, glm::dot(normal, direction) > 0.0f};
}

float RayScene::surface_offset() const {
    return embree_->surface_offset;
}

const char* RayScene::isa() const {
    // Embree picks the widest instruction set that it was built for and that the processor has.
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        rtcGetDeviceProperty(embree_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) {
        return "avx512";
    }
    if (__builtin_cpu_supports("avx2")) return "avx2";
    if (__builtin_cpu_supports("avx")) return "avx";
    return "sse";
}

struct RayPacket {
    RTCRay16 rays;
    RTCIntersectContext context;

    RayPacket() : context(coherent_context()) {
        std::memset(static_cast<void*>(&rays), 0, sizeof(rays));
        std::fill_n(rays.mask, RayScene::kPacketSize, ~0u);
    }

    void set_origins(const float* x, const float* y, const float* z, int count) {
        SKYBAKE_DCHECK_LT(count, RayScene::kPacketSize + 1);
        const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(float);
        std::memcpy(rays.org_x, x, bytes);
        std::memcpy(rays.org_y, y, bytes);
        std::memcpy(rays.org_z, z, bytes);
    }

    /// Up to `reach` times each ray's direction.
    std::uint32_t occluded(RTCScene scene, float reach, int count) {
        alignas(64) static constexpr int kAllThenNone[2 * RayScene::kPacketSize] = {
            -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1,
            0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0};
        std::fill_n(rays.tfar, RayScene::kPacketSize, reach);
        alignas(64) int valid[RayScene::kPacketSize];
        std::memcpy(valid, kAllThenNone + RayScene::kPacketSize - count, sizeof(valid));
        rtcOccluded16(valid, scene, &context, &rays);
        std::uint32_t blocked = 0;
        for (int i = 0; i < count; ++i) blocked |= static_cast<std::uint32_t>(rays.tfar[i] < 0.0f) << i;
        return blocked;
    }
};

namespace {

void put_hidden(std::uint32_t blocked, int count, float* share) {
    for (int i = 0; i < count; ++i) share[i] = blocked >> i & 1u ? 0.0f : 1.0f;
}

}  // namespace

DirectionPacket::DirectionPacket(const RayScene& scene) : scene_(scene), rays_(std::make_unique<RayPacket>()) {}
DirectionPacket::~DirectionPacket() = default;

void DirectionPacket::set_direction(const Vec3f& direction, float distance) {
    distance_ = distance;
    std::fill_n(rays_->rays.dir_x, RayScene::kPacketSize, direction.x);
    std::fill_n(rays_->rays.dir_y, RayScene::kPacketSize, direction.y);
    std::fill_n(rays_->rays.dir_z, RayScene::kPacketSize, direction.z);
}

std::uint32_t DirectionPacket::occluded(const float* x, const float* y, const float* z, int count) {
    rays_->set_origins(x, y, z, count);
    return rays_->occluded(scene_.embree_->scene, distance_, count);
}

void DirectionPacket::visibility(const float* x, const float* y, const float* z, int count, float* share) {
    const std::uint32_t blocked = occluded(x, y, z, count);
    if (!scene_.crowns()) return put_hidden(blocked, count, share);
    transmittance(x, y, z, ~blocked, count, share);
    for (int i = 0; i < count; ++i) share[i] = blocked >> i & 1u ? 0.0f : share[i];
}

void DirectionPacket::transmittance(const float* x, const float* y, const float* z, std::uint32_t wanted, int count,
                                    float* share) {
    std::fill_n(share, count, 1.0f);
    if (!scene_.crowns()) return;
    float distance[RayScene::kPacketSize], depth[RayScene::kPacketSize];
    std::fill_n(distance, RayScene::kPacketSize, distance_);
    const RTCRay16& rays = rays_->rays;
    scene_.crowns()->optical_depth({x, y, z, rays.dir_x, rays.dir_y, rays.dir_z, distance}, wanted, count, depth);
    for (int i = 0; i < count; ++i) share[i] = depth[i] > 0.0f ? std::exp(-depth[i]) : 1.0f;
}

TargetPacket::TargetPacket(const RayScene& scene) : scene_(scene), rays_(std::make_unique<RayPacket>()) {}
TargetPacket::~TargetPacket() = default;

std::uint32_t TargetPacket::occluded(const float* x, const float* y, const float* z, int count) {
    rays_->set_origins(x, y, z, count);
    for (int i = 0; i < count; ++i) {
        rays_->rays.dir_x[i] = target_.x - x[i];
        rays_->rays.dir_y[i] = target_.y - y[i];
        rays_->rays.dir_z[i] = target_.z - z[i];
    }
    return rays_->occluded(scene_.embree_->scene, 1.0f, count);
}

void TargetPacket::visibility(const float* x, const float* y, const float* z, int count, float* share) {
    const std::uint32_t blocked = occluded(x, y, z, count);
    put_hidden(blocked, count, share);
    if (!scene_.crowns()) return;
    RTCRay16& rays = rays_->rays;
    float distance[RayScene::kPacketSize], depth[RayScene::kPacketSize];
    for (int i = 0; i < count; ++i) {
        distance[i] = glm::length(Vec3f(rays.dir_x[i], rays.dir_y[i], rays.dir_z[i]));
        rays.dir_x[i] /= distance[i];
        rays.dir_y[i] /= distance[i];
        rays.dir_z[i] /= distance[i];
    }
    scene_.crowns()->optical_depth({x, y, z, rays.dir_x, rays.dir_y, rays.dir_z, distance}, ~blocked, count, depth);
    for (int i = 0; i < count; ++i) share[i] *= std::exp(-depth[i]);
}

}  // namespace skybake
