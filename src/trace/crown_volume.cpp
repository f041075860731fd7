#include "trace/crown_volume.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <tuple>

#include "base/check.h"

namespace skybake {

namespace {

constexpr int kPacket = CrownVolume::kPacketSize;

// A ray through an edge between two triangles may meet both. Crossings of one crown in one direction that are nearer than
// this, metres and of the distance, are one.
constexpr float kSame = 1e-4f, kSameOfDistance = 4e-6f;

bool is_same(float a, float b) {
    return std::abs(a - b) <= kSame + kSameOfDistance * std::abs(a);
}

/// The crossings of one ray that were counted, as far as there is room: few rays cross more.
struct Counted {
    static constexpr std::size_t kRoom = 16;
    struct Crossing {
        float t;
        std::uint32_t crown;
        bool is_entry;
    };
    std::array<Crossing, kRoom> crossings;
    std::size_t size = 0;

    /// False when it was counted before.
    bool add(const Crossing& crossing) {
        for (std::size_t i = 0; i < size; ++i) {
            const Crossing& other = crossings[i];
            if (other.crown == crossing.crown && other.is_entry == crossing.is_entry && is_same(other.t, crossing.t))
                return false;
        }
        if (size < kRoom) crossings[size++] = crossing;
        return true;
    }
};

/// What the filter below fills in: Embree hands it each crossing, and it lets the ray go on.
struct CrownQuery {
    RTCIntersectContext embree;  // first: Embree's pointer to it is ours
    const Crown* crowns = nullptr;
    const std::uint32_t* crown_of = nullptr;  // [triangle of the hierarchy]
    float back = 0.0f;                        // rays start so far behind their origin, metres
    float distance[kPacket]{};                // how far the rays look, from their origin
    float depth[kPacket]{};
    std::array<Counted, kPacket> counted;
    std::vector<CrownCrossing>* crossings = nullptr;  // of a single ray
};

/// The sum of (exit − entry) over a body's surface is the way within it, in whatever order crossings come. Distances
/// are taken from the body's middle: as often in as out that changes nothing, and where a crossing is lost at an edge
/// between two triangles, the error is a part of this body and not of the way to it.
void on_crossing(const RTCFilterFunctionNArguments* args) {
    auto& query = *reinterpret_cast<CrownQuery*>(args->context);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        args->valid[i] = 0;
        const unsigned lane = RTCRayN_id(args->ray, n, i);
        const unsigned triangle = RTCHitN_primID(args->hit, n, i);
        const std::uint32_t crown_index = query.crown_of[triangle];
        const Crown& crown = query.crowns[crown_index];
        const Vec3f direction(RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                              RTCRayN_dir_z(args->ray, n, i));
        const Vec3f normal(RTCHitN_Ng_x(args->hit, n, i), RTCHitN_Ng_y(args->hit, n, i), RTCHitN_Ng_z(args->hit, n, i));
        const float t = RTCRayN_tfar(args->ray, n, i) - query.back;
        const bool is_entry = glm::dot(normal, direction) < 0.0f;
        if (!query.counted[lane].add({t, crown_index, is_entry})) continue;
        if (query.crossings) {
            query.crossings->push_back({t, triangle, RTCHitN_u(args->hit, n, i), RTCHitN_v(args->hit, n, i), is_entry,
                                        crown.extinction, crown.depth_per_crossing});
            continue;
        }
        const float end = query.distance[lane];
        if (crown.extinction > 0.0f) {
            const Vec3f start(RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i),
                              RTCRayN_org_z(args->ray, n, i));
            const float middle = glm::dot(crown.center - start, direction) - query.back;
            const float way = std::clamp(t, 0.0f, end) - std::clamp(middle, 0.0f, end);
            query.depth[lane] += (is_entry ? -way : way) * crown.extinction;
        } else if (t > 0.0f && t < end) {
            query.depth[lane] += crown.depth_per_crossing;
        }
    }
}

}  // namespace

struct CrownVolume::Embree {
    RTCScene scene = nullptr;
    std::vector<std::uint32_t> crown_of;     // [triangle of the hierarchy]
    std::vector<std::uint32_t> scene_index;  // [triangle of the hierarchy]: in Scene::triangles

    ~Embree() {
        if (scene) rtcReleaseScene(scene);
    }
};

CrownVolume::CrownVolume(void* device, const Scene& scene)
    : crowns_(scene.crowns), embree_(std::make_unique<Embree>()) {
    SKYBAKE_CHECK(!crowns_.empty());
    const auto embree_device = static_cast<RTCDevice>(device);
    for (std::size_t c = 0; c < crowns_.size(); ++c) {
        reach_ = std::max(reach_, 2.0f * crowns_[c].radius);
        for (std::uint32_t i = 0; i < crowns_[c].triangle_count; ++i) {
            embree_->crown_of.push_back(static_cast<std::uint32_t>(c));
            embree_->scene_index.push_back(crowns_[c].first_triangle + i);
        }
    }
    reach_ *= 1.001f;  // a little more, for rounding
    embree_->scene = rtcNewScene(embree_device);
    // Robust: a crossing that is lost at an edge counts. Not of high quality: that cuts triangles, and a crossing would
    // come once for each piece.
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(embree_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = embree_->crown_of.size();
    auto* vertices = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 3 * count));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
    if (!vertices || !indices) throw std::bad_alloc();
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) vertices[3 * i + k] = scene.triangles[embree_->scene_index[i]][k];
    }
    for (std::size_t i = 0; i < 3 * count; ++i) indices[i] = static_cast<std::uint32_t>(i);
    rtcSetGeometryOccludedFilterFunction(geometry, on_crossing);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(embree_->scene);
}

CrownVolume::~CrownVolume() = default;

void CrownVolume::optical_depth(const Rays& rays, std::uint32_t wanted, int count, float* depth) const {
    CrownQuery query;
    rtcInitIntersectContext(&query.embree);
    query.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    query.crowns = crowns_.data();
    query.crown_of = embree_->crown_of.data();
    query.back = reach_;
    alignas(64) int valid[kPacket];
    RTCRay16 packet;
    std::memset(static_cast<void*>(&packet), 0, sizeof(packet));
    for (int i = 0; i < kPacket; ++i) {
        valid[i] = i < count && (wanted >> i & 1u) ? -1 : 0;
        if (valid[i] == 0) continue;
        query.distance[i] = rays.distance[i];
        packet.dir_x[i] = rays.direction_x[i];
        packet.dir_y[i] = rays.direction_y[i];
        packet.dir_z[i] = rays.direction_z[i];
        packet.org_x[i] = rays.x[i] - reach_ * packet.dir_x[i];
        packet.org_y[i] = rays.y[i] - reach_ * packet.dir_y[i];
        packet.org_z[i] = rays.z[i] - reach_ * packet.dir_z[i];
        // To the end of a body that the ray ends in.
        packet.tfar[i] = rays.distance[i] + 2.0f * reach_;
        packet.mask[i] = ~0u;
        packet.id[i] = static_cast<unsigned>(i);
    }
    rtcOccluded16(valid, embree_->scene, &query.embree, &packet);
    for (int i = 0; i < count; ++i) depth[i] = std::max(0.0f, query.depth[i]);
}

float CrownVolume::optical_depth(const Vec3f& origin, const Vec3f& direction, float distance) const {
    float depth[kPacket];
    const Rays rays{&origin.x, &origin.y, &origin.z, &direction.x, &direction.y, &direction.z, &distance};
    optical_depth(rays, 1u, 1, depth);
    return depth[0];
}

void CrownVolume::crossings(const Vec3f& origin, const Vec3f& direction, float distance,
                            std::vector<CrownCrossing>& out) const {
    out.clear();
    CrownQuery query;
    rtcInitIntersectContext(&query.embree);
    query.crowns = crowns_.data();
    query.crown_of = embree_->crown_of.data();
    query.back = reach_;
    query.crossings = &out;
    RTCRay ray{};
    const Vec3f start = origin - reach_ * direction;
    ray.org_x = start.x;
    ray.org_y = start.y;
    ray.org_z = start.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = distance + reach_;
    ray.mask = ~0u;
    rtcOccluded1(embree_->scene, &query.embree, &ray);
    for (CrownCrossing& crossing : out) crossing.triangle = embree_->scene_index[crossing.triangle];
    std::sort(out.begin(), out.end(), [](const CrownCrossing& a, const CrownCrossing& b) {
        return std::tie(a.distance, a.triangle) < std::tie(b.distance, b.triangle);
    });
}

}  // namespace skybake
