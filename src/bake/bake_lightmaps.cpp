#include "bake/bake_lightmaps.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <tuple>

#include "atlas/chart_samples.h"
#include "bake/finish_chart.h"
#include "bake/indirect_chart.h"
#include "bake/indirect_report.h"
#include "bake/projection_tile.h"
#include "bake/shadow_projection.h"
#include "bake/sky_tile.h"
#include "bake/sun_chart.h"
#include "base/check.h"
#include "base/error.h"
#include "sky/dome_sampling.h"

namespace skybake {

namespace {

// A texel is a feature where geometry stands within this many texels of its point: a chimney's foot, a dormer's wall,
// an eave. Box town at 0.25 m, tolerance 1 %: reach 0 gives 8 % of the rays, error 1.3 % of the mean, worst texel 44 %;
// 0.75 gives 14 %, 0.37 %, 8 %; 1.5 gives 15 %, 0.36 %, 6.5 %.
constexpr float kFeatureReach = 0.75f;
// Height above the surface at which features are looked for, in texels of the chart: what stands lower casts no shadow
// worth a texel.
constexpr float kFeatureHeight = 0.1f;

using Clock = std::chrono::steady_clock;

/// Processor time of a stage, summed over the threads.
class StageClock {
  public:
    template <typename Body>
    auto measure(const Body& body) {
        const auto begin = Clock::now();
        struct AddOnExit {
            StageClock& clock;
            Clock::time_point begin;
            ~AddOnExit() {
                clock.nanoseconds_ +=
                    std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
            }
        } add{*this, begin};
        return body();
    }
    double seconds() const { return static_cast<double>(nanoseconds_.load()) * 1e-9; }

  private:
    std::atomic<std::int64_t> nanoseconds_{0};
};

/// Charts that share their directions: equal normal, equal bend.
struct ChartGroup {
    std::vector<ChartId> charts;
    std::uint64_t texels = 0;
};

std::vector<ChartGroup> group_by_normal(const Atlas& atlas) {
    std::vector<ChartId> order(atlas.charts.size());
    for (std::size_t c = 0; c < order.size(); ++c) order[c] = ChartId(c);
    const auto key = [&](ChartId id) {
        const Chart& chart = atlas.charts[id.index()];
        return std::tuple(chart.normal.x, chart.normal.y, chart.normal.z, chart.min_normal_cosine);
    };
    std::stable_sort(order.begin(), order.end(), [&](ChartId a, ChartId b) { return key(a) < key(b); });
    std::vector<ChartGroup> groups;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || key(order[i]) != key(order[i - 1])) groups.emplace_back();
        const Vec2i size = atlas.charts[order[i].index()].size;
        groups.back().charts.push_back(order[i]);
        groups.back().texels += static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    }
    // Large ones first: the last task to finish is a small one.
    std::stable_sort(groups.begin(), groups.end(),
                     [](const ChartGroup& a, const ChartGroup& b) { return a.texels > b.texels; });
    return groups;
}

class Baker {
  public:
    Baker(const Scene& scene, const Atlas& atlas, const RayScene& rays, std::span<const Daylight> instants,
          const BakeOptions& options, Progress& progress)
        : scene_(scene),
          atlas_(atlas),
          rays_(rays),
          options_(options),
          progress_(progress),
          sampler_(instants),
          lamps_(options_.lamps) {
        if (options.sampling == SkySampling::projected) occluders_.emplace(scene);
        lightmaps_.pages.resize(atlas.pages.size());
        for (std::size_t p = 0; p < atlas.pages.size(); ++p) {
            const std::size_t count = texels_of(atlas.pages[p]);
            LightmapPage& page = lightmaps_.pages[p];
            page.width = atlas.pages[p].width;
            page.height = atlas.pages[p].height;
            page.state.assign(count, TexelState::empty);
            page.chart.assign(count, ChartId());
            page.sky_view_factor.assign(count, 0.0f);
            page.lamps.assign(options.lamps.empty() ? 0 : count, Rgb(0.0f));
        }
        const bool has_paths = options.bounces && std::holds_alternative<PathOptions>(*options.bounces);
        for (const Daylight& daylight : instants) {
            BakedInstant& instant = lightmaps_.instants.emplace_back(BakedInstant{daylight, {}});
            for (const AtlasPage& page : atlas.pages) {
                instant.pages.push_back({std::vector<Rgb>(texels_of(page), Rgb(0.0f)),
                                         std::vector<float>(texels_of(page), 0.0f),
                                         std::vector<Rgb>(options.bounces ? texels_of(page) : 0, Rgb(0.0f)),
                                         std::vector<float>(has_paths ? texels_of(page) : 0, 0.0f),
                                         std::vector<float>(options.keeps_leaks ? texels_of(page) : 0, 0.0f)});
            }
        }
    }

    Lightmaps bake(BakeReport& report) {
        const auto begin = Clock::now();
        progress_.begin("sun and sky", atlas_.texel_count());
        const std::vector<ChartGroup> groups = group_by_normal(atlas_);
        tbb::parallel_for(
            std::size_t{0}, groups.size(), [&](std::size_t g) { light_group(groups[g]); }, tbb::simple_partitioner());
        const double wall = std::chrono::duration<double>(Clock::now() - begin).count();
        if (options_.bounces) {
            for (std::size_t k = 0; k < lightmaps_.instants.size(); ++k) light_bounces(k, report);
        }
        const auto join_begin = Clock::now();
        join_seams(atlas_, lightmaps_);
        light_hidden_edges(atlas_, lightmaps_);
        if (options_.bounces) report.indirect = indirect_noise(lightmaps_);
        if (options_.keeps_leaks) {
            const int nearest = std::get<BouncePhotons>(*options_.bounces).gather.nearest;
            report.leaks = find_leaks(atlas_, lightmaps_, nearest, options_.tolerance);
        }
        const double join = std::chrono::duration<double>(Clock::now() - join_begin).count();

        // The stages run interleaved on all threads: each gets its share of the wall clock.
        const double busy =
            sky_clock_.seconds() + sun_clock_.seconds() + lamp_clock_.seconds() + finish_clock_.seconds();
        const double scale = busy > 0.0 ? wall / busy : 0.0;
        report.seconds.sky = scale * sky_clock_.seconds();
        report.seconds.sun = scale * sun_clock_.seconds();
        report.seconds.lamps = scale * lamp_clock_.seconds();
        report.seconds.finish = scale * finish_clock_.seconds() + join;
        report.rays.sky = statistics_.rays + statistics_.crown_rays;
        report.rays.sun = sun_rays_;
        report.rays.lamp = lamp_statistics_.rays;
        report.lamps = options_.lamps.size();
        if (lamp_statistics_.pairs > 0)
            report.lamps_refined_fraction =
                static_cast<double>(lamp_statistics_.refined) / static_cast<double>(lamp_statistics_.pairs);
        report.rays.feeler = feature_rays_ + buried_rays_ + indirect_statistics_.rays;
        if (indirect_statistics_.texels > 0)
            report.indirect_evaluated_fraction =
                static_cast<double>(indirect_statistics_.evaluated) / static_cast<double>(indirect_statistics_.texels);
        report.rays_per_second =
            report.seconds.sky > 0.0 ? static_cast<double>(statistics_.rays) / report.seconds.sky : 0.0;
        report.evaluated_fraction = statistics_.pairs > 0
                                        ? static_cast<double>(statistics_.rays) / static_cast<double>(statistics_.pairs)
                                        : 1.0;
        if (statistics_.view_factor_sum > 0) {
            const double n = static_cast<double>(statistics_.texels);
            report.predicted_rmse_over_mean =
                std::sqrt(static_cast<double>(statistics_.squared_error_sum) * 0x1p-32 / n) /
                (static_cast<double>(statistics_.view_factor_sum) * 0x1p-32 / n);
        }
        return std::move(lightmaps_);
    }

  private:
    static std::size_t texels_of(const AtlasPage& page) {
        return static_cast<std::size_t>(page.width) * static_cast<std::size_t>(page.height);
    }

    /// Reflected light of one instant on all charts, which have their direct light already.
    void light_bounces(std::size_t instant, BakeReport& report) {
        const LightSources sources{lightmaps_.instants[instant].daylight, options_.lamps};
        if (const PathOptions* paths = std::get_if<PathOptions>(&*options_.bounces)) {
            gather(instant, PathReference(sources, scene_, rays_, *paths), report);
            return;
        }
        const BouncePhotons& bounces = std::get<BouncePhotons>(*options_.bounces);
        const auto begin = Clock::now();
        PhotonRun run = trace_photons(sources, scene_, rays_, bounces.photons, progress_);
        report.rays.photon += run.ledger.rays;
        report.photons.emitted += run.ledger.emitted;
        report.photons.absorbed += run.ledger.absorbed;
        report.photons.escaped += run.ledger.escaped;
        report.photons.at_limit += run.ledger.at_limit;
        report.photons.stored += run.photons.size();
        const PhotonMap map(std::move(run.photons));
        report.seconds.photons += std::chrono::duration<double>(Clock::now() - begin).count();
        gather(instant, PhotonGatherer(map, rays_, surface_area(scene_), bounces.gather), report);
    }

    void gather(std::size_t instant, const IndirectEstimator& estimator, BakeReport& report) {
        const auto begin = Clock::now();
        progress_.begin("reflected light", atlas_.texel_count());
        tbb::parallel_for(
            std::size_t{0}, atlas_.charts.size(),
            [&](std::size_t c) { gather_chart(atlas_.charts[c], instant, estimator); }, tbb::simple_partitioner());
        report.seconds.gather += std::chrono::duration<double>(Clock::now() - begin).count();
    }

    void gather_chart(const Chart& chart, std::size_t instant, const IndirectEstimator& estimator) {
        const ChartSamples samples = sample_chart(scene_, chart);
        const std::size_t page = chart.page.index();
        const std::size_t width = static_cast<std::size_t>(lightmaps_.pages[page].width);
        std::vector<float> direct_lx(samples.position.size());
        for (int row = 0; row < chart.size.y; ++row) {
            for (int column = 0; column < chart.size.x; ++column) {
                const std::size_t p = static_cast<std::size_t>(chart.position.y + row) * width +
                                      static_cast<std::size_t>(chart.position.x + column);
                // The layer's reflected light is still 0.
                direct_lx[samples.index(column, row)] = luminance(total_irradiance(lightmaps_, instant, page, p));
            }
        }
        const float tolerance = options_.sampling == SkySampling::full ? 0.0f : options_.tolerance;
        IndirectStatistics statistics;
        const std::vector<IndirectLight> light =
            light_indirect(scene_, chart, samples, estimator, direct_lx, tolerance, progress_, statistics);
        write_indirect(chart, light, lightmaps_.pages[page], lightmaps_.instants[instant].pages[page]);
        progress_.advance(samples.position.size());
        const std::lock_guard lock(statistics_mutex_);
        indirect_statistics_.evaluated += statistics.evaluated;
        indirect_statistics_.texels += statistics.texels;
        indirect_statistics_.rays += statistics.rays;
    }

    void light_group(const ChartGroup& group) {
        if (progress_.stop_requested()) throw Interrupted();
        const Chart& first = atlas_.charts[group.charts.front().index()];
        const SkyDirections directions = sky_clock_.measure([&] { return directions_for(first); });
        tbb::parallel_for(
            std::size_t{0}, group.charts.size(), [&](std::size_t i) { light_chart(group.charts[i], directions); },
            tbb::simple_partitioner());
    }

    SkyDirections directions_for(const Chart& chart) const {
        DomeSamples dome = chart.min_normal_cosine >= 1.0f
                               ? sampler_.sample(chart.normal, options_.sky_samples)
                               : sampler_.sample_relief(chart.normal, chart.min_normal_cosine, options_.sky_samples);
        std::vector<std::uint32_t> bundled, others;
        for (std::uint32_t j = 0; j < dome.size(); ++j) {
            const bool is_projected =
                options_.sampling == SkySampling::projected && can_project(chart.normal, dome.directions[j]);
            (is_projected ? bundled : others).push_back(j);
        }
        NeighbourRuns bundles(dome.directions, bundled, ShadowProjector::kBundle);
        std::optional<DirectionCones> cones;
        if (rays_.crowns()) cones.emplace(dome);
        return {std::move(dome), std::move(bundles), std::move(others), std::move(cones)};
    }

    void light_chart(ChartId id, const SkyDirections& directions) {
        const Chart& chart = atlas_.charts[id.index()];
        const ChartSamples samples = finish_clock_.measure([&] { return sample_chart(scene_, chart); });
        ChartLight light;
        const std::size_t count = samples.position.size();
        light.sky.assign(lightmaps_.instants.size(), std::vector<Rgb>(count, Rgb(0.0f)));
        light.sky_view_factor.assign(count, 0.0f);
        const int columns = tiles_in(chart.size.x), rows = tiles_in(chart.size.y);
        tbb::parallel_for(
            0, columns * rows,
            [&](int tile) {
                if (progress_.stop_requested()) throw Interrupted();
                sky_clock_.measure(
                    [&] { light_sky_tile(chart, samples, directions, tile % columns, tile / columns, light); });
            },
            tbb::simple_partitioner());

        for (const BakedInstant& instant : lightmaps_.instants) {
            const SunBeam& sun = instant.daylight.sun;
            std::uint64_t ray_count = 0;
            if (sun.shape == SunShape::none || luminance(sun.normal_illuminance) <= 0.0f) {
                light.sun_cosine.emplace_back(count, 0.0f);
            } else {
                light.sun_cosine.push_back(
                    sun_clock_.measure([&] { return light_sun(scene_, chart, samples, rays_, sun, ray_count); }));
            }
            sun_rays_ += ray_count;
        }
        if (!options_.lamps.empty()) lamp_clock_.measure([&] { light_by_lamps(chart, samples, light); });
        finish_clock_.measure([&] {
            std::uint64_t ray_count = 0;
            const std::vector<std::uint8_t> buried =
                find_buried(scene_, chart, samples, light, directions.dome, rays_, ray_count);
            buried_rays_ += ray_count;
            std::vector<LightmapLayer*> layers;
            for (BakedInstant& instant : lightmaps_.instants) layers.push_back(&instant.pages[chart.page.index()]);
            write_chart(id, chart, samples, buried, light, lightmaps_.pages[chart.page.index()], layers);
        });
        progress_.advance(count);
    }

    void light_by_lamps(const Chart& chart, const ChartSamples& samples, ChartLight& light) {
        LampStatistics statistics;
        light.lamps = light_lamps(scene_, chart, samples, rays_, lamps_, options_.lamp_sampling, statistics);
        const std::lock_guard lock(statistics_mutex_);
        lamp_statistics_.add(statistics);
    }

    int tiles_in(int size) const {
        const int largest =
            options_.sampling == SkySampling::projected ? ProjectionTile::kMaxSize : TilePoints::kMaxTexels;
        return (size + largest - 1) / largest;
    }

    void light_sky_tile(const Chart& chart, const ChartSamples& samples, const SkyDirections& directions,
                        int tile_column, int tile_row, ChartLight& light) {
        // Tiles of about equal size: a strip of one texel would cost as much overhead as a whole tile.
        const auto cut = [this](int size, int index) {
            return static_cast<int>(static_cast<std::int64_t>(size) * index / tiles_in(size));
        };
        const int column0 = cut(chart.size.x, tile_column), column1 = cut(chart.size.x, tile_column + 1);
        const int row0 = cut(chart.size.y, tile_row), row1 = cut(chart.size.y, tile_row + 1);
        const int columns = column1 - column0, rows = row1 - row0;
        const auto whole_cells = [](int texels) {
            return std::max((texels - 1 + TilePoints::kCell - 1) / TilePoints::kCell, 1) * TilePoints::kCell + 1;
        };
        TilePoints points;
        const bool is_hierarchical = options_.sampling == SkySampling::hierarchical;
        points.width = is_hierarchical ? whole_cells(columns) : columns;
        points.height = is_hierarchical ? whole_cells(rows) : rows;
        points.frame = {chart.origin + static_cast<float>(column0) * chart.u + static_cast<float>(row0) * chart.v,
                        chart.u, chart.v, chart.normal};
        const std::size_t count = static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height);
        points.x.resize(count);
        points.y.resize(count);
        points.z.resize(count);
        points.covered.assign(static_cast<std::size_t>(points.height), 0);
        points.is_feature.assign(static_cast<std::size_t>(points.height), 0);
        const bool is_relief = chart.min_normal_cosine < 1.0f;
        if (is_relief) points.normal.assign(count, chart.normal);
        points.triangle.assign(count, 0);
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const std::size_t i = samples.index(column0 + column, row0 + row);
                if (samples.cover[i] == ChartSamples::Cover::none) continue;
                const std::size_t t = static_cast<std::size_t>(points.texel(column, row));
                const Vec3f normal = is_relief ? shading_normal(scene_, chart, samples.triangle[i]) : chart.normal;
                const Vec3f p = samples.position[i] + rays_.surface_offset() * normal;
                points.x[t] = p.x;
                points.y[t] = p.y;
                points.z[t] = p.z;
                if (is_relief) points.normal[t] = normal;
                points.triangle[t] = samples.triangle[i];
                points.covered[row] |= 1ull << column;
            }
        }
        if (std::all_of(points.covered.begin(), points.covered.end(), [](std::uint64_t row) { return row == 0; }))
            return;
        DirectionPacket packet(rays_);
        if (is_hierarchical) {
            find_features(chart, points, packet);
            points.extend();
        }
        SkyTileStatistics statistics;
        const TileLight tile = light_tile(points, directions, occluders_ ? &*occluders_ : nullptr, rays_.crowns(),
                                          packet, {options_.sampling, options_.tolerance}, statistics);
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const std::size_t i = samples.index(column0 + column, row0 + row);
                const std::size_t t = static_cast<std::size_t>(points.texel(column, row));
                light.sky_view_factor[i] = tile.sky_view_factor[t];
                for (std::size_t k = 0; k < light.sky.size(); ++k) light.sky[k][i] = tile.sky[k][t];
            }
        }
        const std::lock_guard lock(statistics_mutex_);
        statistics_.add(statistics);
    }

    /// Looks along the surface from each texel to its four sides.
    void find_features(const Chart& chart, TilePoints& points, DirectionPacket& packet) {
        const float texel = std::max(glm::length(chart.u), glm::length(chart.v));
        // Above the slopes of a relief chart, which are not features.
        const float c = chart.min_normal_cosine;
        const float slope = std::sqrt(std::max(0.0f, 1.0f - c * c)) / c;
        const Vec3f lift = texel * (kFeatureHeight + kFeatureReach * slope) * chart.normal;
        for (const Vec3f& side : {chart.u, -chart.u, chart.v, -chart.v}) {
            packet.set_direction(glm::normalize(side), kFeatureReach * texel);
            alignas(64) std::array<float, RayScene::kPacketSize> x, y, z;
            for (int row = 0; row < points.height; ++row) {
                for (int begin = 0; begin < points.width; begin += RayScene::kPacketSize) {
                    const int n = std::min(RayScene::kPacketSize, points.width - begin);
                    const std::uint64_t covered = points.covered[row] >> begin & ((1ull << n) - 1);
                    if (!covered) continue;
                    for (int i = 0; i < n; ++i) {
                        const std::size_t t = static_cast<std::size_t>(points.texel(begin + i, row));
                        x[i] = points.x[t] + lift.x;
                        y[i] = points.y[t] + lift.y;
                        z[i] = points.z[t] + lift.z;
                    }
                    points.is_feature[row] |= (packet.occluded(x.data(), y.data(), z.data(), n) & covered) << begin;
                    feature_rays_ += static_cast<std::uint64_t>(n);
                }
            }
        }
    }

    const Scene& scene_;
    const Atlas& atlas_;
    const RayScene& rays_;
    BakeOptions options_;
    Progress& progress_;
    DomeSampler sampler_;
    LampTree lamps_;                         // over options_.lamps
    std::optional<OccluderTree> occluders_;  // for SkySampling::projected
    Lightmaps lightmaps_;
    std::mutex statistics_mutex_;
    SkyTileStatistics statistics_;
    IndirectStatistics indirect_statistics_;
    LampStatistics lamp_statistics_;
    StageClock sky_clock_, sun_clock_, lamp_clock_, finish_clock_;
    std::atomic<std::uint64_t> sun_rays_{0}, feature_rays_{0}, buried_rays_{0};
};

}  // namespace

Lightmaps bake_lightmaps(const Scene& scene, const Atlas& atlas, const RayScene& rays,
                         std::span<const Daylight> instants, const BakeOptions& options, Progress& progress,
                         BakeReport& report) {
    return Baker(scene, atlas, rays, instants, options, progress).bake(report);
}

}  // namespace skybake
