#include "bake/lamp_chart.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "bake/texel_points.h"

namespace skybake {

namespace {

constexpr int kTileTexels = 32;
// |E − mean of two opposite neighbours| over the largest of the three. The mean of a parabola over a texel is off its
// middle by a twelfth of that: 0.4 %.
constexpr float kBend = 0.05f;
// What neighbours' shares of a lamp's light must differ by to be a shadow's edge.
constexpr float kEdge = 0.02f;
// A lamp's edges count where it may give this much of a texel's light.
constexpr float kNotable = 0.01f;

/// One tile and, about it, a ring of the chart's texels that its edges are judged by.
class LampTile {
  public:
    LampTile(const ChartSamples& samples, const TexelPoints& points, const RayScene& rays,
             const LampChartOptions& options, const Vec2i& lo, const Vec2i& hi)
        : samples_(samples),
          points_(points),
          rays_(rays),
          options_(options),
          lo_(lo),
          hi_(hi),
          ring_lo_(glm::max(lo - 1, Vec2i(0))),
          ring_hi_(glm::min(hi + 1, samples.size)) {
        const Vec2i size = ring_hi_ - ring_lo_;
        width_ = size.x;
        const std::size_t count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
        point_.resize(count);
        normal_.resize(count);
        is_covered_.assign(count, 0);
        for_ring([&](int column, int row, std::size_t t) {
            const std::size_t i = samples_.index(column, row);
            if (samples_.cover[i] == ChartSamples::Cover::none) return;
            is_covered_[t] = 1;
            point_[t] = points_.lifted(i);
            normal_[t] = points_.normal(i);
        });
    }

    ReceiverPatch patch(const Chart& chart) const {
        ReceiverPatch patch{{}, chart.min_normal_cosine >= 1.0f, chart.normal, 0.0f};
        patch.plane_offset = std::numeric_limits<float>::max();
        // Subsamples lie up to a texel off their texel's point.
        const Vec3f reach = glm::abs(chart.u) + glm::abs(chart.v);
        for_ring([&](int, int, std::size_t t) {
            if (!is_covered_[t]) return;
            patch.box.extend(point_[t] - reach);
            patch.box.extend(point_[t] + reach);
            patch.plane_offset = std::min(patch.plane_offset, glm::dot(chart.normal, point_[t]));
        });
        return patch;
    }

    void light(const LampTree& tree, const std::vector<std::uint32_t>& relevant, std::vector<Rgb>& out,
               LampStatistics& statistics) {
        struct Shone {
            const Lamp* lamp;
            std::vector<float> lux;    // unobstructed
            std::vector<float> share;  // that comes through
        };
        TargetPacket packet(rays_);
        std::vector<Shone> shone;
        std::vector<float> total(point_.size(), 0.0f);
        for (const std::uint32_t l : relevant) {
            Shone one{&tree.lamps()[l], std::vector<float>(point_.size(), 0.0f), {}};
            one.share.assign(point_.size(), 0.0f);
            RayBatch<TargetPacket, std::size_t, SetShare> batch(packet, SetShare{one.share});
            packet.set_target(one.lamp->position);
            bool shines = false;
            for (std::size_t t = 0; t < point_.size(); ++t) {
                if (!is_covered_[t]) continue;
                one.lux[t] = lux_at(*one.lamp, point_[t], normal_[t]);
                if (!(one.lux[t] > 0.0f)) continue;
                batch.add(point_[t], t);
                shines = true;
            }
            batch.flush();
            statistics.rays += batch.traced;
            if (!shines) continue;
            for (std::size_t t = 0; t < point_.size(); ++t) total[t] += one.share[t] * one.lux[t];
            shone.push_back(std::move(one));
        }
        for (const Shone& one : shone) {
            packet.set_target(one.lamp->position);
            const Rgb colour = one.lamp->intensity / luminance(one.lamp->intensity);
            std::vector<Edge> edges;
            for (int row = lo_.y; row < hi_.y; ++row) {
                for (int column = lo_.x; column < hi_.x; ++column) {
                    const std::size_t t = at(column, row);
                    if (!is_covered_[t]) continue;
                    const float largest = largest_about(one.lux, column, row);
                    if (!(largest > 0.0f)) continue;
                    ++statistics.pairs;
                    if (is_refined(one.lux, one.share, total[t], largest, column, row)) {
                        edges.push_back({column, row, t, 0.0, 0});
                    } else {
                        out[samples_.index(column, row)] += one.share[t] * one.lux[t] * colour;
                    }
                }
            }
            statistics.refined += edges.size();
            refine(*one.lamp, packet, edges, statistics);
            for (const Edge& edge : edges) {
                // A texel of which no subsample lies inside keeps the answer of its own point.
                const double lux =
                    edge.tried > 0 ? edge.lux / edge.tried : static_cast<double>(one.share[edge.t] * one.lux[edge.t]);
                out[samples_.index(edge.column, edge.row)] += static_cast<float>(lux) * colour;
            }
        }
    }

  private:
    struct SetShare {
        std::vector<float>& shares;
        void operator()(std::size_t t, float share) const { shares[t] = share; }
    };
    struct Edge {
        int column, row;
        std::size_t t;
        double lux;
        int tried;
    };
    struct Subsample {
        std::size_t edge = 0;
        float lux = 0.0f;
    };
    struct AddLux {
        std::vector<Edge>& edges;
        void operator()(const Subsample& s, float share) const {
            edges[s.edge].lux += static_cast<double>(share * s.lux);
        }
    };

    /// On the surface below a point that was lifted off it.
    float lux_at(const Lamp& lamp, const Vec3f& lifted, const Vec3f& normal) const {
        return luminance(unobstructed_irradiance(lamp, lifted - rays_.surface_offset() * normal, normal));
    }

    std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row - ring_lo_.y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(column - ring_lo_.x);
    }

    template <typename Body>
    void for_ring(const Body& body) const {
        for (int row = ring_lo_.y; row < ring_hi_.y; ++row) {
            for (int column = ring_lo_.x; column < ring_hi_.x; ++column) body(column, row, at(column, row));
        }
    }

    /// Calls body(t) for the covered texels of the 3 × 3 neighbourhood.
    template <typename Body>
    void for_neighborhood(int column, int row, const Body& body) const {
        for (int y = std::max(row - 1, ring_lo_.y); y <= std::min(row + 1, ring_hi_.y - 1); ++y) {
            for (int x = std::max(column - 1, ring_lo_.x); x <= std::min(column + 1, ring_hi_.x - 1); ++x) {
                if (is_covered_[at(x, y)]) body(at(x, y));
            }
        }
    }

    float largest_about(const std::vector<float>& lux, int column, int row) const {
        float largest = 0.0f;
        for_neighborhood(column, row, [&](std::size_t t) { largest = std::max(largest, lux[t]); });
        return largest;
    }

    bool bends(const std::vector<float>& lux, int column, int row, const Vec2i& step) const {
        const Vec2i before = Vec2i(column, row) - step, after = Vec2i(column, row) + step;
        if (before.x < ring_lo_.x || before.y < ring_lo_.y || after.x >= ring_hi_.x || after.y >= ring_hi_.y)
            return false;
        const std::size_t a = at(before.x, before.y), b = at(after.x, after.y);
        if (!is_covered_[a] || !is_covered_[b]) return false;
        const float own = lux[at(column, row)];
        return std::abs(own - 0.5f * (lux[a] + lux[b])) > kBend * std::max({own, lux[a], lux[b]});
    }

    bool is_refined(const std::vector<float>& lux, const std::vector<float>& share, float total, float largest,
                    int column, int row) const {
        if (options_.sampling == LampSampling::full) return true;
        if (options_.sampling == LampSampling::single) return false;
        if (largest <= kNotable * std::max(total, options_.cutoff_lx)) return false;
        const float own = share[at(column, row)];
        bool is_edge = false, is_dark = own == 0.0f;
        for_neighborhood(column, row, [&](std::size_t t) {
            is_edge = is_edge || std::abs(share[t] - own) > kEdge;
            is_dark = is_dark && share[t] == 0.0f;
        });
        if (is_dark) return false;
        return is_edge || bends(lux, column, row, {1, 0}) || bends(lux, column, row, {0, 1});
    }

    void refine(const Lamp& lamp, TargetPacket& packet, std::vector<Edge>& edges, LampStatistics& statistics) const {
        RayBatch<TargetPacket, Subsample, AddLux> batch(packet, AddLux{edges});
        for (int sub = 0; sub < kSubsamples; ++sub) {
            for (std::size_t e = 0; e < edges.size(); ++e) {
                Edge& edge = edges[e];
                const auto point = points_.subsample(edge.column, edge.row, sub);
                if (!point) continue;
                ++edge.tried;
                const float lux = lux_at(lamp, *point, normal_[edge.t]);
                if (lux > 0.0f) batch.add(*point, {e, lux});
            }
        }
        batch.flush();
        statistics.rays += batch.traced;
    }

    const ChartSamples& samples_;
    const TexelPoints& points_;
    const RayScene& rays_;
    const LampChartOptions& options_;
    Vec2i lo_, hi_, ring_lo_, ring_hi_;
    int width_ = 0;
    std::vector<Vec3f> point_, normal_;  // of the tile and its ring
    std::vector<std::uint8_t> is_covered_;
};

}  // namespace

std::vector<Rgb> light_lamps(const Scene& scene, const Chart& chart, const ChartSamples& samples, const RayScene& rays,
                             const LampTree& lamps, const LampChartOptions& options, LampStatistics& statistics) {
    std::vector<Rgb> light(samples.position.size(), Rgb(0.0f));
    const TexelPoints points(scene, chart, samples, rays);
    const Vec2i tiles = (samples.size + kTileTexels - 1) / kTileTexels;
    std::vector<LampStatistics> parts(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y));
    // Isolated: a thread that waits here must not begin another chart, whose time would be counted as the lamps'.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(0, tiles.x * tiles.y, [&](int k) {
            const Vec2i lo = kTileTexels * Vec2i(k % tiles.x, k / tiles.x);
            LampTile tile(samples, points, rays, options, lo, glm::min(lo + kTileTexels, samples.size));
            const ReceiverPatch patch = tile.patch(chart);
            if (patch.box.is_empty()) return;
            const double cutoff = static_cast<double>(options.cutoff_lx);
            tile.light(lamps, lamps.relevant(patch, cutoff), light, parts[static_cast<std::size_t>(k)]);
        });
    });
    for (const LampStatistics& part : parts) statistics.add(part);
    return light;
}

}  // namespace skybake
