#include "bake/indirect_chart.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>

#include "base/error.h"

namespace skybake {

namespace {

constexpr int kCell = 16;  // texels between nodes
// Corners may differ by this many tolerances: what is linear between them is interpolated without error, and the centre
// tells what is not. Box town at 0.25 m, tolerance 1 %: a span of 1 gathers at 63 % of the texels for an error of 0.25
// % of the light, a span of 4 at 42 % for 0.64 %.
constexpr float kCornerSpan = 4.0f;

/// One cell of the lattice with its border: texels (column, row) to (column + width, row + height) inclusive.
class IndirectCell {
  public:
    IndirectCell(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                 const IndirectEstimator& estimator, std::span<const float> other_light_lx, float tolerance)
        : scene_(scene),
          chart_(chart),
          samples_(samples),
          estimator_(estimator),
          other_light_lx_(other_light_lx),
          tolerance_(tolerance) {
        if (const PhotonGatherer* photons = std::get_if<PhotonGatherer>(&estimator)) search_.emplace(photons->map());
    }

    /// Fills `light` of the texels that the cell owns: those on its left and upper border, and at the chart's end also
    /// the others.
    void run(int column, int row, std::vector<IndirectLight>& light) {
        column_ = column;
        row_ = row;
        const int width = std::min(kCell, samples_.size.x - 1 - column);
        const int height = std::min(kCell, samples_.size.y - 1 - row);
        values_.fill(std::nullopt);
        if (tolerance_ > 0.0f) refine(0, 0, width, height);
        const int own_width = column + width == samples_.size.x - 1 ? width + 1 : width;
        const int own_height = row + height == samples_.size.y - 1 ? height + 1 : height;
        for (int y = 0; y < own_height; ++y) {
            for (int x = 0; x < own_width; ++x) {
                if (!is_covered(x, y)) continue;
                light[samples_.index(column + x, row + y)] = value(x, y);
                ++statistics.texels;
            }
        }
    }

    IndirectStatistics statistics;

  private:
    using Corners = std::array<IndirectLight, 4>;

    static std::size_t place(int x, int y) { return static_cast<std::size_t>(y * (kCell + 1) + x); }
    std::size_t texel(int x, int y) const { return samples_.index(column_ + x, row_ + y); }
    bool is_covered(int x, int y) const { return samples_.cover[texel(x, y)] != ChartSamples::Cover::none; }

    IndirectLight estimate(const ReceiverPoint& point) {
        if (const PhotonGatherer* photons = std::get_if<PhotonGatherer>(&estimator_))
            return photons->light(point, *search_, statistics.rays);
        return std::get<PathReference>(estimator_).light(point);
    }

    IndirectLight value(int x, int y) {
        std::optional<IndirectLight>& value = values_[place(x, y)];
        if (!value) {
            const std::size_t i = texel(x, y);
            const Vec3f normal =
                chart_.min_normal_cosine >= 1.0f ? chart_.normal : shading_normal(scene_, chart_, samples_.triangle[i]);
            value = estimate({samples_.position[i], normal});
            ++statistics.evaluated;
        }
        return *value;
    }

    void refine(int x0, int y0, int x1, int y1) {
        const bool is_whole = [&] {
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    if (!is_covered(x, y)) return false;
                }
            }
            return true;
        }();
        if (is_whole) {
            const Corners corner{value(x0, y0), value(x1, y0), value(x0, y1), value(x1, y1)};
            if (x1 - x0 <= 1 && y1 - y0 <= 1) return;
            if (is_smooth(corner, x0, y0, x1, y1)) {
                interpolate(corner, x0, y0, x1, y1);
                return;
            }
        } else if (x1 - x0 <= 1 && y1 - y0 <= 1) {
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    if (is_covered(x, y)) value(x, y);
                }
            }
            return;
        }
        const int xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
        const bool splits_x = x1 - x0 > 1, splits_y = y1 - y0 > 1;
        for (int part = 0; part < (splits_y ? 2 : 1); ++part) {
            const int top = part == 0 ? y0 : ym, bottom = splits_y && part == 0 ? ym : y1;
            refine(x0, top, splits_x ? xm : x1, bottom);
            if (splits_x) refine(xm, top, x1, bottom);
        }
    }

    bool is_smooth(const Corners& corner, int x0, int y0, int x1, int y1) {
        float lo = luminance(corner[0].irradiance), hi = lo, other = 0.0f;
        for (const IndirectLight& c : corner) {
            lo = std::min(lo, luminance(c.irradiance));
            hi = std::max(hi, luminance(c.irradiance));
        }
        for (const auto& [x, y] : {std::pair(x0, y0), std::pair(x1, y0), std::pair(x0, y1), std::pair(x1, y1)})
            other += 0.25f * other_light_lx_[texel(x, y)];
        const float allowed = tolerance_ * (other + 0.5f * (lo + hi));
        if (hi - lo > kCornerSpan * allowed) return false;
        const int xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
        const IndirectLight expected = interpolated(corner, x0, y0, x1, y1, xm, ym);
        return std::abs(luminance(value(xm, ym).irradiance) - luminance(expected.irradiance)) <= allowed;
    }

    static IndirectLight interpolated(const Corners& corner, int x0, int y0, int x1, int y1, int x, int y) {
        const float fx = x1 > x0 ? static_cast<float>(x - x0) / static_cast<float>(x1 - x0) : 0.0f;
        const float fy = y1 > y0 ? static_cast<float>(y - y0) / static_cast<float>(y1 - y0) : 0.0f;
        const auto mix = [&](const auto& of) {
            return (1.0f - fy) * ((1.0f - fx) * of(corner[0]) + fx * of(corner[1])) +
                   fy * ((1.0f - fx) * of(corner[2]) + fx * of(corner[3]));
        };
        return {mix([](const IndirectLight& light) { return light.irradiance; }),
                mix([](const IndirectLight& light) { return light.standard_error_lx; }),
                mix([](const IndirectLight& light) { return light.leak_lx; })};
    }

    /// What is known already, from this cell or the one beside it, stays.
    void interpolate(const Corners& corner, int x0, int y0, int x1, int y1) {
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                std::optional<IndirectLight>& value = values_[place(x, y)];
                if (!value) value = interpolated(corner, x0, y0, x1, y1, x, y);
            }
        }
    }

    const Scene& scene_;
    const Chart& chart_;
    const ChartSamples& samples_;
    const IndirectEstimator& estimator_;
    std::span<const float> other_light_lx_;
    float tolerance_;
    int column_ = 0, row_ = 0;
    std::array<std::optional<IndirectLight>, (kCell + 1) * (kCell + 1)> values_;
    std::optional<PhotonSearch> search_;  // for photons
};

}  // namespace

std::vector<IndirectLight> light_indirect(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                          const IndirectEstimator& estimator, std::span<const float> other_light_lx,
                                          float tolerance, const Progress& progress, IndirectStatistics& statistics) {
    std::vector<IndirectLight> light(samples.position.size());
    // Each cell owns its left and upper border; a chart of one texel a side is one cell.
    const auto cells = [](int size) { return std::max(1, (size - 1 + kCell - 1) / kCell); };
    const int columns = cells(samples.size.x), rows = cells(samples.size.y);
    std::mutex mutex;
    tbb::parallel_for(0, rows, [&](int row) {
        IndirectCell cell(scene, chart, samples, estimator, other_light_lx, tolerance);
        for (int column = 0; column < columns; ++column) {
            if (progress.stop_requested()) throw Interrupted();
            cell.run(column * kCell, row * kCell, light);
        }
        const std::lock_guard lock(mutex);
        statistics.evaluated += cell.statistics.evaluated;
        statistics.texels += cell.statistics.texels;
        statistics.rays += cell.statistics.rays;
    });
    return light;
}

}  // namespace skybake
