#include "bake/finish_chart.h"

#include <algorithm>
#include <cmath>

namespace skybake {

namespace {

constexpr int kNearLit = 3;  // texels: what bilinear lookup and one mip level can reach
constexpr std::size_t kBuriedRays = 8;
constexpr int kBackFacesNeeded = 5;
// Light that comes through the cracks between ground and wall of a real city does not make a place to stand.
constexpr float kDarkViewFactor = 0.03f;
constexpr int kFillRings = 6;  // gutter, block padding, and what lies under a wall's foot

/// Calls body(index, x, y) for the 3 × 3 neighbourhood inside the grid, the centre left out.
template <typename Body>
void for_neighbors(int column, int row, int width, int height, const Body& body) {
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, height - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, width - 1); ++x) {
            if (x != column || y != row)
                body(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        }
    }
}

/// The chart's rectangle with its gutter, up to the next block of four.
struct ChartPatch {
    ChartPatch(const Chart& chart, const LightmapPage& page)
        : first(chart.position - kGutter),
          page_width(static_cast<std::size_t>(page.width)),
          width(std::min((chart.size.x + 2 * kGutter + 3) / 4 * 4, page.width - first.x)),
          height(std::min((chart.size.y + 2 * kGutter + 3) / 4 * 4, page.height - first.y)),
          is_filled(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

    std::size_t page_index(int column, int row) const {
        return static_cast<std::size_t>(first.y + row) * page_width + static_cast<std::size_t>(first.x + column);
    }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
    }

    /// Ring by ring, calls average(p, sources) for each texel p of the page that is not filled yet and has neighbours
    /// `sources` that are.
    template <typename Average>
    void fill_outwards(const Average& average) {
        std::vector<std::size_t> sources;
        for (int ring = 0; ring < kFillRings; ++ring) {
            std::vector<std::uint8_t> next = is_filled;
            for (int row = 0; row < height; ++row) {
                for (int column = 0; column < width; ++column) {
                    if (is_filled[index(column, row)]) continue;
                    sources.clear();
                    for_neighbors(column, row, width, height, [&](std::size_t j) {
                        if (is_filled[j])
                            sources.push_back(page_index(static_cast<int>(j % static_cast<std::size_t>(width)),
                                                         static_cast<int>(j / static_cast<std::size_t>(width))));
                    });
                    if (sources.empty()) continue;
                    average(page_index(column, row), std::span<const std::size_t>(sources));
                    next[index(column, row)] = 1;
                }
            }
            if (next == is_filled) break;
            is_filled = std::move(next);
        }
    }

    Vec2i first;  // on the page
    std::size_t page_width;
    int width, height;
    std::vector<std::uint8_t> is_filled;
};

/// The mean of the layer's values at `sources`.
template <typename T>
T mean_at(const std::vector<T>& values, std::span<const std::size_t> sources) {
    T sum(0.0f);
    for (const std::size_t source : sources) sum += values[source];
    return (1.0f / static_cast<float>(sources.size())) * sum;
}

}  // namespace

std::vector<std::uint8_t> find_buried(const Scene& scene, const Chart& chart, const ChartSamples& samples,
                                      const ChartLight& light, const DomeSamples& dome, const RayScene& rays,
                                      std::uint64_t& ray_count) {
    const int width = samples.size.x, height = samples.size.y;
    std::vector<std::uint8_t> buried(samples.cover.size(), 0);
    if (dome.size() == 0) return buried;
    // Lit texels, and what is not covered: the border.
    std::vector<std::uint8_t> near(buried.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
        near[i] = light.sky_view_factor[i] > kDarkViewFactor || samples.cover[i] == ChartSamples::Cover::none;
    }
    for (int ring = 0; ring < kNearLit; ++ring) {
        std::vector<std::uint8_t> wider = near;
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                std::uint8_t& own = wider[samples.index(column, row)];
                if (row == 0 || column == 0 || row == height - 1 || column == width - 1) own = 1;
                for_neighbors(column, row, width, height, [&](std::size_t j) { own |= near[j]; });
            }
        }
        near = std::move(wider);
    }
    for (std::size_t i = 0; i < buried.size(); ++i) {
        if (samples.cover[i] == ChartSamples::Cover::none || light.sky_view_factor[i] > kDarkViewFactor || !near[i])
            continue;
        const Vec3f origin =
            samples.position[i] + rays.surface_offset() * shading_normal(scene, chart, samples.triangle[i]);
        int back_faces = 0;
        for (std::size_t s = 0; s < kBuriedRays; ++s) {
            const auto hit = rays.first_hit(origin, dome.directions[(2 * s + 1) * dome.size() / (2 * kBuriedRays)]);
            back_faces += hit && hit->is_back_face;
        }
        ray_count += kBuriedRays;
        buried[i] = back_faces >= kBackFacesNeeded;
    }
    return buried;
}

void write_chart(ChartId id, const Chart& chart, const ChartSamples& samples, std::span<const std::uint8_t> buried,
                 const ChartLight& light, LightmapPage& page, std::span<LightmapLayer* const> layers) {
    ChartPatch patch(chart, page);
    for (int row = 0; row < chart.size.y; ++row) {
        for (int column = 0; column < chart.size.x; ++column) {
            const std::size_t i = samples.index(column, row);
            if (samples.cover[i] == ChartSamples::Cover::none) continue;
            const std::size_t p = patch.page_index(column + kGutter, row + kGutter);
            page.chart[p] = id;
            page.state[p] = buried[i] ? TexelState::buried : TexelState::chart;
            page.sky_view_factor[p] = light.sky_view_factor[i];
            if (!light.lamps.empty()) page.lamps[p] = light.lamps[i];
            for (std::size_t k = 0; k < layers.size(); ++k) {
                layers[k]->sky[p] = light.sky[k][i];
                layers[k]->sun_cosine[p] = light.sun_cosine[k][i];
            }
            patch.is_filled[patch.index(column + kGutter, row + kGutter)] = !buried[i];
        }
    }
    patch.fill_outwards([&](std::size_t p, std::span<const std::size_t> sources) {
        page.chart[p] = id;
        if (page.state[p] == TexelState::empty) page.state[p] = TexelState::gutter;
        page.sky_view_factor[p] = mean_at(page.sky_view_factor, sources);
        if (!page.lamps.empty()) page.lamps[p] = mean_at(page.lamps, sources);
        for (LightmapLayer* layer : layers) {
            layer->sky[p] = mean_at(layer->sky, sources);
            layer->sun_cosine[p] = mean_at(layer->sun_cosine, sources);
        }
    });
}

void write_indirect(const Chart& chart, std::span<const IndirectLight> light, const LightmapPage& page,
                    LightmapLayer& layer) {
    ChartPatch patch(chart, page);
    for (int row = 0; row < chart.size.y; ++row) {
        for (int column = 0; column < chart.size.x; ++column) {
            const std::size_t p = patch.page_index(column + kGutter, row + kGutter);
            if (page.state[p] != TexelState::chart) continue;
            const IndirectLight& texel = light[static_cast<std::size_t>(row) * static_cast<std::size_t>(chart.size.x) +
                                               static_cast<std::size_t>(column)];
            layer.indirect[p] = texel.irradiance;
            if (!layer.indirect_error.empty()) layer.indirect_error[p] = texel.standard_error_lx;
            if (!layer.leak.empty()) layer.leak[p] = texel.leak_lx;
            patch.is_filled[patch.index(column + kGutter, row + kGutter)] = 1;
        }
    }
    patch.fill_outwards([&](std::size_t p, std::span<const std::size_t> sources) {
        layer.indirect[p] = mean_at(layer.indirect, sources);
    });
}

void join_seams(const Atlas& atlas, Lightmaps& lightmaps) {
    const auto texel_of = [](const LightmapPage& page, int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(page.width) + static_cast<std::size_t>(column);
    };
    for (const Seam& seam : atlas.seams) {
        if (!seam.is_smooth) continue;
        const Chart& a = atlas.charts[seam.a.index()];
        const Chart& b = atlas.charts[seam.b.index()];
        LightmapPage& page_a = lightmaps.pages[a.page.index()];
        const LightmapPage& page_b = lightmaps.pages[b.page.index()];
        const Vec2f begin = texel_coordinate(a, seam.begin), end = texel_coordinate(a, seam.end);
        // Every gutter texel whose centre lies within 1.5 texels of the edge: what bilinear lookup along it can touch.
        const Vec2f lo = glm::min(begin, end) - 1.5f, hi = glm::max(begin, end) + 1.5f;
        const int column_end = std::min(a.size.x + kGutter, static_cast<int>(std::ceil(hi.x))),
                  row_end = std::min(a.size.y + kGutter, static_cast<int>(std::ceil(hi.y)));
        for (int row = std::max(-kGutter, static_cast<int>(std::floor(lo.y))); row < row_end; ++row) {
            for (int column = std::max(-kGutter, static_cast<int>(std::floor(lo.x))); column < column_end; ++column) {
                const std::size_t p = texel_of(page_a, a.position.x + column, a.position.y + row);
                if (page_a.state[p] != TexelState::gutter) continue;
                const Vec2f center(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f);
                const Vec2f along = end - begin;
                const float length2 = glm::dot(along, along);
                const float t =
                    length2 > 0.0f ? std::clamp(glm::dot(center - begin, along) / length2, 0.0f, 1.0f) : 0.0f;
                const Vec2f off = center - (begin + t * along);
                if (glm::dot(off, off) > 1.5f * 1.5f) continue;
                // The point of a's plane in b's texels; bilinear over those of b's texels that have light.
                const Vec2f there = texel_coordinate(b, a.origin + center.x * a.u + center.y * a.v) - 0.5f;
                const int x0 = static_cast<int>(std::floor(there.x)), y0 = static_cast<int>(std::floor(there.y));
                float weight_sum = 0.0f, view_factor = 0.0f;
                std::vector<std::pair<std::size_t, float>> sources;
                for (int k = 0; k < 4; ++k) {
                    const int x = x0 + (k & 1), y = y0 + (k >> 1);
                    if (x < 0 || y < 0 || x >= b.size.x || y >= b.size.y) continue;
                    const std::size_t q = texel_of(page_b, b.position.x + x, b.position.y + y);
                    if (page_b.state[q] != TexelState::chart && page_b.state[q] != TexelState::buried) continue;
                    const float fx = there.x - static_cast<float>(x0), fy = there.y - static_cast<float>(y0);
                    const float weight = (k & 1 ? fx : 1.0f - fx) * (k >> 1 ? fy : 1.0f - fy);
                    weight_sum += weight;
                    view_factor += weight * page_b.sky_view_factor[q];
                    sources.emplace_back(q, weight);
                }
                if (weight_sum < 0.1f) continue;
                page_a.sky_view_factor[p] = view_factor / weight_sum;
                if (!page_a.lamps.empty()) {
                    Rgb lamps(0.0f);
                    for (const auto& [q, weight] : sources) lamps += weight * page_b.lamps[q];
                    page_a.lamps[p] = lamps / weight_sum;
                }
                for (BakedInstant& instant : lightmaps.instants) {
                    const LightmapLayer& from = instant.pages[b.page.index()];
                    Rgb sky(0.0f);
                    float sun = 0.0f;
                    for (const auto& [q, weight] : sources) {
                        sky += weight * from.sky[q];
                        sun += weight * from.sun_cosine[q];
                    }
                    LightmapLayer& to = instant.pages[a.page.index()];
                    to.sky[p] = sky / weight_sum;
                    to.sun_cosine[p] = sun / weight_sum;
                    if (to.indirect.empty()) continue;
                    Rgb indirect(0.0f);
                    for (const auto& [q, weight] : sources) indirect += weight * from.indirect[q];
                    to.indirect[p] = indirect / weight_sum;
                }
            }
        }
    }
}

void light_hidden_edges(const Atlas& atlas, Lightmaps& lightmaps) {
    for (const Seam& seam : atlas.seams) {
        if (seam.is_smooth) continue;
        const Chart& a = atlas.charts[seam.a.index()];
        const Chart& b = atlas.charts[seam.b.index()];
        LightmapPage& page_a = lightmaps.pages[a.page.index()];
        const LightmapPage& page_b = lightmaps.pages[b.page.index()];
        const Vec2f a0 = texel_coordinate(a, seam.begin), a1 = texel_coordinate(a, seam.end);
        const Vec2f b0 = texel_coordinate(b, seam.begin), b1 = texel_coordinate(b, seam.end);
        const int steps = std::max(1, static_cast<int>(std::ceil(2.0f * glm::length(a1 - a0))));
        for (int step = 0; step <= steps; ++step) {
            const float t = static_cast<float>(step) / static_cast<float>(steps);
            const Vec2f at_b = b0 + t * (b1 - b0), at_a = a0 + t * (a1 - a0);
            const int bx = std::clamp(static_cast<int>(std::floor(at_b.x)), 0, b.size.x - 1),
                      by = std::clamp(static_cast<int>(std::floor(at_b.y)), 0, b.size.y - 1);
            const std::size_t q = static_cast<std::size_t>(b.position.y + by) * static_cast<std::size_t>(page_b.width) +
                                  static_cast<std::size_t>(b.position.x + bx);
            if (page_b.state[q] != TexelState::chart || page_b.sky_view_factor[q] <= kDarkViewFactor) continue;
            const int ax = static_cast<int>(std::floor(at_a.x)), ay = static_cast<int>(std::floor(at_a.y));
            for (int y = std::max(ay - 1, -kGutter); y <= std::min(ay + 1, a.size.y + kGutter - 1); ++y) {
                for (int x = std::max(ax - 1, -kGutter); x <= std::min(ax + 1, a.size.x + kGutter - 1); ++x) {
                    const std::size_t p =
                        static_cast<std::size_t>(a.position.y + y) * static_cast<std::size_t>(page_a.width) +
                        static_cast<std::size_t>(a.position.x + x);
                    if (page_a.state[p] == TexelState::chart || page_a.sky_view_factor[p] > kDarkViewFactor) continue;
                    if (page_a.state[p] == TexelState::empty) {
                        page_a.state[p] = TexelState::gutter;
                        page_a.chart[p] = seam.a;
                    }
                    page_a.sky_view_factor[p] = page_b.sky_view_factor[q];
                    if (!page_a.lamps.empty()) page_a.lamps[p] = page_b.lamps[q];
                    for (BakedInstant& instant : lightmaps.instants) {
                        const LightmapLayer& from = instant.pages[b.page.index()];
                        LightmapLayer& to = instant.pages[a.page.index()];
                        to.sky[p] = from.sky[q];
                        to.sun_cosine[p] = from.sun_cosine[q];
                        if (!to.indirect.empty()) to.indirect[p] = from.indirect[q];
                    }
                }
            }
        }
    }
}

}  // namespace skybake
