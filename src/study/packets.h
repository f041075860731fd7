// Samples that are traced together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "study/receivers.h"
#include "trace/ray_scene.h"

namespace skybake {

/// A run of at most 16 neighbouring samples with one normal.
struct PacketRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// Cuts the samples, in their order, into packets.
std::vector<PacketRange> packet_ranges(std::span<const Sample> samples);

/// Packets of one normal, which share their directions to the sky.
struct NormalGroup {
    Vec3f normal{0, 0, 1};
    std::vector<PacketRange> ranges;
};
/// The packets of packet_ranges by their normals, in the order of the normals' coordinates.
std::vector<NormalGroup> normal_groups(std::span<const Sample> samples);

/// The ray origins of a packet in a scene's frame, lifted off the surface.
struct PacketOrigins {
    float x[RayScene::kPacketSize], y[RayScene::kPacketSize], z[RayScene::kPacketSize];
    int count = 0;
    std::uint32_t all() const { return (1u << count) - 1u; }
};
PacketOrigins packet_origins(std::span<const Sample> samples, PacketRange range, const Vec3d& scene_origin,
                             float surface_offset);

}  // namespace skybake
