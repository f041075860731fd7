#include "study/packets.h"

#include <map>
#include <tuple>

namespace skybake {

std::vector<PacketRange> packet_ranges(std::span<const Sample> samples) {
    std::vector<PacketRange> ranges;
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
        const bool continues = !ranges.empty() && i - ranges.back().begin < RayScene::kPacketSize &&
                               samples[ranges.back().begin].normal == samples[i].normal;
        if (!continues) ranges.push_back({i, i});
        ranges.back().end = i + 1;
    }
    return ranges;
}

std::vector<NormalGroup> normal_groups(std::span<const Sample> samples) {
    const auto less = [](const Vec3f& a, const Vec3f& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::map<Vec3f, std::vector<PacketRange>, decltype(less)> by_normal(less);
    for (const PacketRange& range : packet_ranges(samples)) by_normal[samples[range.begin].normal].push_back(range);
    std::vector<NormalGroup> groups;
    for (auto& [normal, ranges] : by_normal) groups.push_back({normal, std::move(ranges)});
    return groups;
}

PacketOrigins packet_origins(std::span<const Sample> samples, PacketRange range, const Vec3d& scene_origin,
                             float surface_offset) {
    PacketOrigins origins;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const Vec3f p = Vec3f(samples[i].position - scene_origin) + surface_offset * samples[i].normal;
        origins.x[origins.count] = p.x;
        origins.y[origins.count] = p.y;
        origins.z[origins.count] = p.z;
        ++origins.count;
    }
    return origins;
}

}  // namespace skybake
