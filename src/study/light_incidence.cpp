#include "study/light_incidence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "study/packets.h"

namespace skybake {
namespace {
constexpr double kTurnDeg = 5.0;
constexpr double kUprightEnough = 1e-3;  // a normal whose horizontal part is shorter has no azimuth
}  // namespace

LightIncidence light_incidence(std::span<const Sample> samples, const Vec3d& scene_origin, const RayScene& rays,
                               double swivel_deg, Progress& progress) {
    const std::vector<PacketRange> ranges = packet_ranges(samples);
    LightIncidence result;
    result.angle_deg.assign(samples.size(), 90.0f);
    std::atomic<std::uint64_t> count{0};
    progress.begin("light incidence", samples.size());
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t r) {
        if (progress.stop_requested()) return;
        const PacketOrigins origins = packet_origins(samples, ranges[r], scene_origin, rays.surface_offset());
        const Vec3d normal(samples[ranges[r].begin].normal);
        const bool has_azimuth = std::hypot(normal.x, normal.y) > kUprightEnough;
        const double azimuth = std::atan2(normal.x, normal.y);
        const double swivel = has_azimuth ? swivel_deg : 180.0;
        DirectionPacket packet(rays);
        std::uint64_t traced = 0;
        std::array<int, RayScene::kPacketSize> lowest;
        lowest.fill(90);
        for (double turn = -swivel; turn <= swivel; turn += kTurnDeg) {
            std::uint32_t open = origins.all();
            for (int elevation = 89; elevation >= 0 && open; --elevation) {
                const double a = azimuth + radians_from_degrees(turn), e = radians_from_degrees(elevation);
                const Vec3d direction(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
                if (glm::dot(direction, normal) <= 0.0) continue;  // a roof's own slope does not count
                packet.set_direction(Vec3f(direction));
                open &= ~packet.occluded(origins.x, origins.y, origins.z, origins.count);
                traced += static_cast<std::uint64_t>(origins.count);
                for (int i = 0; i < origins.count; ++i) {
                    if (open >> i & 1u) lowest[i] = std::min(lowest[i], elevation);
                }
            }
        }
        for (int i = 0; i < origins.count; ++i)
            result.angle_deg[ranges[r].begin + static_cast<std::size_t>(i)] = static_cast<float>(lowest[i]);
        count += traced;
        progress.advance(static_cast<std::uint64_t>(origins.count));
    });
    if (progress.stop_requested()) throw Interrupted();
    result.rays = count;
    return result;
}

}  // namespace skybake
