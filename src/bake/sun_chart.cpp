#include "bake/sun_chart.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bake/texel_points.h"
#include "sky/sun_disc.h"

namespace skybake {

namespace {

constexpr int kRowsPerTask = 32;
constexpr int kDiscSubsamples = 64;

// What neighbours must differ by, of all the light, to be an edge: a soft shadow needs no more samples than its steps
// show.
constexpr float kEdge = 0.02f;

template <typename OnLight>
RayBatch<DirectionPacket, std::size_t, OnLight> batch_of(DirectionPacket& packet, OnLight on_light) {
    return {packet, on_light};
}

class SunOnChart {
  public:
    SunOnChart(const Scene& scene, const Chart& chart, const ChartSamples& samples, const RayScene& rays,
               const SunBeam& sun)
        : samples_(samples),
          points_(scene, chart, samples, rays),
          rays_(rays),
          sun_(sun),
          count_(samples.position.size()),
          cosine_(count_, 0.0f) {
        for (std::size_t i = 0; i < count_; ++i) {
            if (samples.cover[i] == ChartSamples::Cover::none) continue;
            cosine_[i] = std::max(0.0f, glm::dot(points_.normal(i), sun.direction));
        }
    }

    std::vector<float> light(std::uint64_t& ray_count) {
        if (std::none_of(cosine_.begin(), cosine_.end(), [](float c) { return c > 0.0f; })) return cosine_;
        const bool is_disc = sun_.shape == SunShape::disc;
        const std::vector<Vec3f> coarse = sun_disc_directions(sun_, is_disc ? 5 : 1);
        const std::vector<Vec3f> fine = sun_disc_directions(sun_, is_disc ? kDiscSubsamples : 1);
        std::vector<float> free(count_, 0.0f);  // sum of the shares of light over the coarse directions
        for_rows([&](int row_begin, int row_end) { trace_coarse(coarse, row_begin, row_end, free); });
        std::vector<float> share(count_);
        const float all = static_cast<float>(coarse.size());
        for_rows([&](int row_begin, int row_end) { refine(fine, free, all, row_begin, row_end, share); });
        for (std::size_t i = 0; i < count_; ++i) share[i] *= cosine_[i];
        ray_count += ray_count_;
        return share;
    }

  private:
    template <typename Body>
    void for_rows(const Body& body) const {
        // Isolated: a thread that waits here must not begin another chart, whose time would be counted as the sun's.
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(0, samples_.size.y, kRowsPerTask,
                              [&](int row) { body(row, std::min(row + kRowsPerTask, samples_.size.y)); });
        });
    }

    void trace_coarse(const std::vector<Vec3f>& directions, int row_begin, int row_end, std::vector<float>& free) {
        DirectionPacket packet(rays_);
        RayBatch batch = batch_of(packet, [&](std::size_t i, float share) { free[i] += share; });
        for (const Vec3f& direction : directions) {
            packet.set_direction(direction);
            for (std::size_t i = samples_.index(0, row_begin); i < samples_.index(0, row_end); ++i) {
                if (cosine_[i] > 0.0f) batch.add(points_.lifted(i), i);
            }
            batch.flush();
        }
        ray_count_ += batch.traced;
    }

    bool has_edge(const std::vector<float>& free, float all, int column, int row) const {
        const float own = free[samples_.index(column, row)];
        if (own != 0.0f && own != all) return true;
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, samples_.size.y - 1); ++y) {
            for (int x = std::max(column - 1, 0); x <= std::min(column + 1, samples_.size.x - 1); ++x) {
                const std::size_t j = samples_.index(x, y);
                if (cosine_[j] > 0.0f && std::abs(free[j] - own) > kEdge * all) return true;
            }
        }
        return false;
    }

    void refine(const std::vector<Vec3f>& directions, const std::vector<float>& free, float all, int row_begin,
                int row_end, std::vector<float>& share) {
        DirectionPacket packet(rays_);
        std::vector<float> lit(samples_.index(0, row_end) - samples_.index(0, row_begin), 0.0f);
        std::vector<std::uint32_t> tried(lit.size(), 0);
        const std::size_t first = samples_.index(0, row_begin);
        RayBatch batch = batch_of(packet, [&](std::size_t i, float part) { lit[i - first] += part; });
        std::vector<std::pair<int, int>> edges;
        for (int row = row_begin; row < row_end; ++row) {
            for (int column = 0; column < samples_.size.x; ++column) {
                const std::size_t i = samples_.index(column, row);
                if (cosine_[i] <= 0.0f) continue;
                share[i] = free[i] / all;
                if (has_edge(free, all, column, row)) edges.emplace_back(column, row);
            }
        }
        const std::size_t pairs = std::max<std::size_t>(kSubsamples, directions.size());
        for (std::size_t s = 0; s < pairs; ++s) {
            packet.set_direction(directions[s % directions.size()]);
            // Neither the disc's radius (s) nor its angle (the low bits of s) goes along with the place in the texel.
            const int sub = static_cast<int>((s * 11 + s / kSubsamples * 5) % kSubsamples);
            for (const auto& [column, row] : edges) {
                const std::size_t i = samples_.index(column, row);
                const auto point = points_.subsample(column, row, sub);
                if (!point) continue;
                ++tried[i - first];
                batch.add(*point, i);
            }
            batch.flush();
        }
        for (const auto& [column, row] : edges) {
            const std::size_t i = samples_.index(column, row);
            // A texel of which no point lies inside keeps the answer of its own point.
            if (tried[i - first] > 0) share[i] = lit[i - first] / static_cast<float>(tried[i - first]);
        }
        ray_count_ += batch.traced;
    }

    const ChartSamples& samples_;
    TexelPoints points_;
    const RayScene& rays_;
    const SunBeam& sun_;
    std::size_t count_;
    std::vector<float> cosine_;
    std::atomic<std::uint64_t> ray_count_{0};
};

}  // namespace

std::vector<float> light_sun(const Scene& scene, const Chart& chart, const ChartSamples& samples, const RayScene& rays,
                             const SunBeam& sun, std::uint64_t& ray_count) {
    return SunOnChart(scene, chart, samples, rays, sun).light(ray_count);
}

}  // namespace skybake
