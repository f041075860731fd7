#include "study/sky_shares.h"

#include <tbb/parallel_for.h>

#include "base/error.h"
#include "sky/cie_sky.h"
#include "sky/dome_sampling.h"
#include "study/packets.h"

namespace skybake {

SkyShares sky_shares(std::span<const Sample> samples, const Vec3d& scene_origin, const RayScene& rays, int directions,
                     const YearLight* year, Progress& progress) {
    std::vector<Daylight> skies{{"overcast", cie_1994_sky(Cie1994Type::overcast, {0, 0, 1}), {}}};
    if (year) skies.push_back({"year", year->sky, {}});
    const DomeSampler sampler(skies);
    const double open_lx = static_cast<double>(luminance(horizontal_diffuse(skies[0].sky).illuminance));

    const std::vector<NormalGroup> groups = normal_groups(samples);

    SkyShares shares;
    shares.sky_view_factor.resize(samples.size());
    shares.sky_component_pct.resize(samples.size());
    if (year) shares.sky_irradiation_kwh_m2.resize(samples.size());
    std::vector<std::uint64_t> group_rays(groups.size());
    progress.begin("sky", samples.size());
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        const auto& normal = groups[g].normal;  // no structured binding: clang 14 lets no inner lambda use one
        const auto& ranges = groups[g].ranges;
        const DomeSamples dome = sampler.sample(normal, directions);
        tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t r) {
            if (progress.stop_requested()) return;
            const PacketOrigins origins = packet_origins(samples, ranges[r], scene_origin, rays.surface_offset());
            DirectionPacket packet(rays);
            double view_factor[RayScene::kPacketSize] = {}, overcast[RayScene::kPacketSize] = {},
                   energy[RayScene::kPacketSize] = {};
            for (std::size_t j = 0; j < dome.size(); ++j) {
                packet.set_direction(dome.directions[j]);
                const std::uint32_t blocked = packet.occluded(origins.x, origins.y, origins.z, origins.count);
                for (int i = 0; i < origins.count; ++i) {
                    if (blocked >> i & 1u) continue;
                    view_factor[i] += static_cast<double>(dome.view_factor_weight[j]);
                    overcast[i] += static_cast<double>(luminance(dome.weights[0][j]));
                    if (year) energy[i] += static_cast<double>(luminance(dome.weights[1][j]));
                }
            }
            for (int i = 0; i < origins.count; ++i) {
                const std::size_t s = ranges[r].begin + static_cast<std::size_t>(i);
                shares.sky_view_factor[s] = static_cast<float>(view_factor[i]);
                shares.sky_component_pct[s] = static_cast<float>(100.0 * overcast[i] / open_lx);
                if (year) shares.sky_irradiation_kwh_m2[s] = static_cast<float>(energy[i]);
            }
            progress.advance(static_cast<std::uint64_t>(origins.count));
        });
        for (const PacketRange& range : ranges) group_rays[g] += dome.size() * (range.end - range.begin);
    });
    if (progress.stop_requested()) throw Interrupted();
    for (const std::uint64_t n : group_rays) shares.rays += n;
    return shares;
}

}  // namespace skybake
