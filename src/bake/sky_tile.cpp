// Based on: Reichinger, Maierhofer, Tobler, 2006, §4.2 (light on a coarse lattice of 16 × 16 texels, refined by
// halving). Deviation: the hierarchy runs over each direction's visibility instead of over their sum
// (docs/decisions/0003-hierarchy-over-visibility.md).
#include "bake/sky_tile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "bake/visibility_grid.h"
#include "base/check.h"
#include "base/low_discrepancy.h"

// Each copy does the same operations in the same order, without fused multiply-add: the same bits on every processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SKYBAKE_WIDE_LOOP __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SKYBAKE_WIDE_LOOP
#endif

namespace skybake {

namespace {

constexpr int kPacket = RayScene::kPacketSize;
// Directions traced in full before a lattice is chosen: 1.6 % of the rays of 1024 directions.
constexpr std::size_t kPilots = 16;
// A texel is traced always when the pilots' errors there do not average out. What was filled from agreeing corners and
// is wrong is a missed feature: net two of them to one side. What was interpolated is wrong by chance, as often to
// either side: only a net beyond so many standard deviations (√n for n errors of ±1) is not.
constexpr float kAnchoredFills = 2.0f;
constexpr float kAnchoredDeviations = 3.0f;
// Tiles of one packet are traced in full: a lattice would save nothing.
constexpr int kSmallTile = kPacket;
// In dark tiles the tolerance is relative to this share of the unobstructed light, lest rays are spent on errors nobody
// sees.
constexpr float kDarkTile = 0.1f;
// Of those with the largest last cell that keep the tolerance in a tile, the one with the fewest packets is taken; the
// last resort is every texel.
constexpr std::array<Lattice, 9> kLattices{{{16, 4}, {8, 4}, {4, 4}, {16, 2}, {8, 2}, {4, 2}, {16, 1}, {8, 1}, {4, 1}}};
// Packets of scattered texels take longer than those of neighbours: a lattice must save so many.
constexpr double kScattered = 0.6;

/// acc[i] += w × v[i].
SKYBAKE_WIDE_LOOP void add_scaled(float* __restrict acc, const float* __restrict v, float w, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) acc[i] += w * v[i];
}

/// v[i] = visibility × max(0, n · d): what relief charts weigh a direction with.
SKYBAKE_WIDE_LOOP void apply_cosine(float* __restrict v, const float* __restrict nx, const float* __restrict ny,
                                    const float* __restrict nz, float dx, float dy, float dz, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const float cosine = nx[i] * dx + ny[i] * dy + nz[i] * dz;
        v[i] *= cosine > 0.0f ? cosine : 0.0f;
    }
}

/// One float a texel from one bit a texel.
SKYBAKE_WIDE_LOOP void expand_row(float* __restrict v, std::uint64_t bits, int width) {
    const std::uint32_t low = static_cast<std::uint32_t>(bits), high = static_cast<std::uint32_t>(bits >> 32);
    const int low_width = std::min(width, 32);
    for (int x = 0; x < low_width; ++x) v[x] = static_cast<float>(low >> x & 1u);
    for (int x = 32; x < width; ++x) v[x] = static_cast<float>(high >> (x - 32) & 1u);
}

/// Listed texels in blocks of 4 × 4, so that a packet's rays start side by side; traced for one direction after
/// another.
class PreparedTexels {
  public:
    PreparedTexels(const TilePoints& points, std::span<const std::uint64_t> listed, DirectionPacket& packet)
        : packet_(packet) {
        for (int row = 0; row < points.height; row += 4) {
            for (int column = 0; column < points.width; column += 4) {
                for (int r = row; r < std::min(row + 4, points.height); ++r) {
                    for (int c = column; c < std::min(column + 4, points.width); ++c) {
                        if (!(listed[r] >> c & 1)) continue;
                        const int texel = points.texel(c, r);
                        x_.push_back(points.x[texel]);
                        y_.push_back(points.y[texel]);
                        z_.push_back(points.z[texel]);
                        row_.push_back(static_cast<std::uint8_t>(r));
                        bit_.push_back(1ull << c);
                    }
                }
            }
        }
    }

    std::size_t size() const { return x_.size(); }

    /// Sets the bits of the texels that see the sky.
    void trace(std::span<std::uint64_t> visible) {
        for (std::size_t begin = 0; begin < size(); begin += kPacket) {
            const int count = static_cast<int>(std::min<std::size_t>(kPacket, size() - begin));
            std::uint32_t free = ~packet_.occluded(&x_[begin], &y_[begin], &z_[begin], count) & ((1u << count) - 1u);
            for (; free; free &= free - 1) {
                const std::size_t i = begin + static_cast<std::size_t>(std::countr_zero(free));
                visible[row_[i]] |= bit_[i];
            }
        }
    }

  private:
    DirectionPacket& packet_;
    std::vector<float> x_, y_, z_;
    std::vector<std::uint8_t> row_;
    std::vector<std::uint64_t> bit_;
};

/// Rays of one direction.
class RaySource final : public VisibilitySource {
  public:
    RaySource(const TilePoints& points, std::span<const std::uint64_t> first_look, DirectionPacket& packet)
        : points_(points), packet_(packet), first_look_(points, first_look, packet) {}

    std::size_t look(std::span<const std::uint64_t> wanted, std::span<std::uint64_t> visible) override {
        int count = 0;
        std::size_t traced = 0;
        // Cell after cell, so that a packet's rays start near each other.
        for (std::size_t first_row = 0; first_row < wanted.size(); first_row += TilePoints::kCell) {
            const std::size_t end_row = std::min(first_row + TilePoints::kCell, wanted.size());
            std::uint64_t any = 0;
            for (std::size_t row = first_row; row < end_row; ++row) {
                any |= wanted[row];
                visible[row] &= ~wanted[row];
            }
            for (std::uint64_t strip = (1ull << TilePoints::kCell) - 1; strip; strip <<= TilePoints::kCell) {
                if (!(any & strip)) continue;
                for (std::size_t row = first_row; row < end_row; ++row) {
                    for (std::uint64_t left = wanted[row] & strip; left; left &= left - 1) {
                        const int column = std::countr_zero(left);
                        const std::size_t texel =
                            static_cast<std::size_t>(points_.texel(column, static_cast<int>(row)));
                        x_[count] = points_.x[texel];
                        y_[count] = points_.y[texel];
                        z_[count] = points_.z[texel];
                        row_[count] = static_cast<std::uint8_t>(row);
                        column_[count] = static_cast<std::uint8_t>(column);
                        ++traced;
                        if (++count == kPacket) {
                            trace(count, visible);
                            count = 0;
                        }
                    }
                }
            }
        }
        if (count > 0) trace(count, visible);
        return traced;
    }

    std::size_t look_first(std::span<const std::uint64_t>, std::span<std::uint64_t> visible) override {
        first_look_.trace(visible);
        return first_look_.size();
    }

  private:
    void trace(int count, std::span<std::uint64_t> visible) {
        std::uint32_t free = ~packet_.occluded(x_.data(), y_.data(), z_.data(), count) & ((1u << count) - 1u);
        for (; free; free &= free - 1) {
            const int i = std::countr_zero(free);
            visible[row_[i]] |= 1ull << column_[i];
        }
    }

    const TilePoints& points_;
    DirectionPacket& packet_;
    PreparedTexels first_look_;
    alignas(64) std::array<float, kPacket> x_, y_, z_;
    std::array<std::uint8_t, kPacket> row_, column_;
};

/// The known answer of a pilot direction.
class PilotSource final : public VisibilitySource {
  public:
    explicit PilotSource(std::span<const std::uint64_t> truth) : truth_(truth) {}

    std::size_t look(std::span<const std::uint64_t> wanted, std::span<std::uint64_t> visible) override {
        std::size_t count = 0;
        for (std::size_t row = 0; row < wanted.size(); ++row) {
            visible[row] = (visible[row] & ~wanted[row]) | (truth_[row] & wanted[row]);
            count += static_cast<std::size_t>(std::popcount(wanted[row]));
        }
        packets_ += (count + kPacket - 1) / kPacket;
        return count;
    }

    /// Packets that rays would have taken.
    std::size_t packets() const { return packets_; }

  private:
    std::span<const std::uint64_t> truth_;
    std::size_t packets_ = 0;
};

/// Sums of light over the directions.
class Accumulator {
  public:
    Accumulator(const TilePoints& points, const DomeSamples& dome)
        : points_(points),
          dome_(dome),
          count_(static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height)),
          visibility_(count_),
          view_factor_(count_, 0.0f) {
        sums_.assign(3 * dome.weights.size(), std::vector<float>(count_, 0.0f));
        open_.assign(3 * dome.weights.size() + 1, Vec3d(0.0));
        if (points.normal.empty()) return;
        for (const Vec3f& n : points.normal) {
            nx_.push_back(n.x);
            ny_.push_back(n.y);
            nz_.push_back(n.z);
            axis_ += n;
        }
        axis_ = glm::normalize(axis_);
        float min_cosine = 1.0f;
        for (const Vec3f& n : points.normal) min_cosine = std::min(min_cosine, glm::dot(n, axis_));
        horizon_sine_ = std::sqrt(std::max(0.0f, 1.0f - min_cosine * min_cosine));
    }

    void add(std::size_t direction, std::span<const std::uint64_t> visible) {
        std::uint64_t any_visible = 0, any_hidden = 0;
        for (int row = 0; row < points_.height; ++row) {
            any_visible |= visible[row];
            any_hidden |= visible[row] ^ points_.covered[row];
        }
        if (!any_visible) return;
        const Vec3f& d = dome_.directions[direction];
        const bool is_relief = !nx_.empty();
        if (!any_hidden && (!is_relief || glm::dot(d, axis_) > horizon_sine_)) {
            // All texels see it, and none from behind: what it adds is one vector for all, and each texel's cosine
            // comes at the end.
            const Vec3d v = is_relief ? Vec3d(d) : Vec3d(1.0, 0.0, 0.0);
            open_.back() += static_cast<double>(dome_.view_factor_weight[direction]) * v;
            for (std::size_t k = 0; k < dome_.weights.size(); ++k) {
                for (int c = 0; c < 3; ++c)
                    open_[3 * k + static_cast<std::size_t>(c)] +=
                        static_cast<double>(dome_.weights[k][direction][c]) * v;
            }
            return;
        }
        for (int row = 0; row < points_.height; ++row)
            expand_row(&visibility_[static_cast<std::size_t>(points_.texel(0, row))], visible[row], points_.width);
        if (is_relief) {
            apply_cosine(visibility_.data(), nx_.data(), ny_.data(), nz_.data(), d.x, d.y, d.z, count_);
        }
        add_scaled(view_factor_.data(), visibility_.data(), dome_.view_factor_weight[direction], count_);
        for (std::size_t k = 0; k < dome_.weights.size(); ++k) {
            for (int c = 0; c < 3; ++c) {
                const float weight = dome_.weights[k][direction][c];
                if (weight != 0.0f)
                    add_scaled(sums_[3 * k + static_cast<std::size_t>(c)].data(), visibility_.data(), weight, count_);
            }
        }
    }

    TileLight light() && {
        TileLight light;
        light.sky.assign(dome_.weights.size(), std::vector<Rgb>(count_));
        for (std::size_t k = 0; k < dome_.weights.size(); ++k) {
            for (std::size_t i = 0; i < count_; ++i) {
                const Vec3d n = nx_.empty() ? Vec3d(1.0, 0.0, 0.0) : Vec3d(nx_[i], ny_[i], nz_[i]);
                for (int c = 0; c < 3; ++c) {
                    const std::size_t channel = 3 * k + static_cast<std::size_t>(c);
                    light.sky[k][i][c] =
                        static_cast<float>(static_cast<double>(sums_[channel][i]) + glm::dot(n, open_[channel]));
                }
            }
        }
        light.sky_view_factor = std::move(view_factor_);
        for (std::size_t i = 0; i < count_; ++i) {
            const Vec3d n = nx_.empty() ? Vec3d(1.0, 0.0, 0.0) : Vec3d(nx_[i], ny_[i], nz_[i]);
            light.sky_view_factor[i] += static_cast<float>(glm::dot(n, open_.back()));
        }
        return light;
    }

  private:
    const TilePoints& points_;
    const DomeSamples& dome_;
    std::size_t count_;
    std::vector<float> visibility_, view_factor_;
    std::vector<std::vector<float>> sums_;  // [3 instant + channel][texel]
    std::vector<Vec3d> open_;  // [3 instant + channel], and the view factor's: of directions that every texel sees
    // Relief: normals, their mean, and the sine of their largest angle to it.
    std::vector<float> nx_, ny_, nz_;
    Vec3f axis_{0.0f};
    float horizon_sine_ = 0.0f;
};

/// Thresholds of successive directions, spread evenly (base 3: the directions' own numbers go by base 2).
float threshold_of(std::size_t direction) {
    return static_cast<float>(radical_inverse(3, static_cast<std::uint32_t>(direction)));
}

/// What a lattice would have made of the pilot directions.
struct Trial {
    double squared_error = 0.0;           // predicted, of the visible share, mean over texels, for all directions
    double packets = 0.0;                 // a direction
    std::vector<std::uint64_t> anchored;  // texels whose errors do not average out
};

Trial try_lattice(const TilePoints& points, VisibilityGrid& grid, std::span<const std::vector<std::uint64_t>> pilots,
                  std::size_t texel_count, std::size_t direction_count) {
    Trial trial;
    trial.anchored.assign(points.covered.size(), 0);
    const std::size_t count = static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height);
    std::vector<float> fill_net(count, 0.0f), net(count, 0.0f), errors(count, 0.0f);  // of errors −1, 0, 1
    std::vector<std::uint64_t> visible(points.covered.size()), touched(points.covered.size(), 0);
    double square_sum = 0.0;  // Σ e² over pilots and texels, e in {−1, 0, 1}
    for (std::size_t p = 0; p < pilots.size(); ++p) {
        const std::vector<std::uint64_t>& truth = pilots[p];
        PilotSource source(truth);
        grid.solve(threshold_of(p), source, visible);
        trial.packets += static_cast<double>(source.packets());
        for (int row = 0; row < points.height; ++row) {
            for (std::uint64_t wrong = (visible[row] ^ truth[row]) & points.covered[row]; wrong; wrong &= wrong - 1) {
                const int column = std::countr_zero(wrong);
                const std::size_t texel = static_cast<std::size_t>(points.texel(column, row));
                const float error = visible[row] >> column & 1 ? 1.0f : -1.0f;
                (grid.interpolated()[row] >> column & 1 ? net : fill_net)[texel] += error;
                errors[texel] += 1.0f;
                square_sum += 1.0;
                touched[row] |= 1ull << column;
            }
        }
    }
    double bias_sum = 0.0;
    for (int row = 0; row < points.height; ++row) {
        for (std::uint64_t left = touched[row]; left; left &= left - 1) {
            const int column = std::countr_zero(left);
            const std::size_t texel = static_cast<std::size_t>(points.texel(column, row));
            const double sum = static_cast<double>(fill_net[texel] + net[texel]);
            bias_sum += sum * sum - static_cast<double>(errors[texel]);
            if (std::abs(fill_net[texel]) >= kAnchoredFills ||
                std::abs(net[texel]) > kAnchoredDeviations * std::sqrt(errors[texel])) {
                trial.anchored[row] |= 1ull << column;
            }
        }
    }
    // Mean squared error of N directions: the squared bias, of which (Σe)² − Σe² over n (n − 1) is an unbiased
    // estimate, and the variance Σe² / n, over N.
    const double n = static_cast<double>(pilots.size());
    trial.squared_error =
        (std::max(bias_sum, 0.0) / (n * (n - 1.0)) + square_sum / n / static_cast<double>(direction_count)) /
        static_cast<double>(texel_count);
    trial.packets /= n;
    return trial;
}

/// Texels that some pilot sees.
std::vector<std::uint64_t> seen_by(std::span<const std::vector<std::uint64_t>> pilots) {
    std::vector<std::uint64_t> seen(pilots.front().size(), 0);
    for (const std::vector<std::uint64_t>& pilot : pilots) {
        for (std::size_t row = 0; row < seen.size(); ++row) seen[row] |= pilot[row];
    }
    return seen;
}

/// The tile's features, without those that lie in the dark, such as inside a wall between two houses: no pilot sees
/// them, nor any texel beside them.
std::vector<std::uint64_t> features_in_light(const TilePoints& points, std::span<const std::uint64_t> seen) {
    std::vector<std::uint64_t> features(points.covered.size(), 0);
    for (std::size_t row = 0; row < seen.size(); ++row) {
        std::uint64_t near = seen[row];
        if (row > 0) near |= seen[row - 1];
        if (row + 1 < seen.size()) near |= seen[row + 1];
        features[row] = points.is_feature[row] & (near | near << 1 | near >> 1);
    }
    return features;
}

struct Choice {
    Lattice lattice;
    Trial trial;
};

/// None: full sampling is the cheapest way to keep the tolerance.
std::optional<Choice> choose_lattice(const TilePoints& points, std::span<const std::uint64_t> features,
                                     std::span<const std::uint64_t> seen, VisibilityGrid& grid,
                                     std::span<const std::vector<std::uint64_t>> pilots, std::size_t texel_count,
                                     std::size_t direction_count, double tolerance) {
    const std::vector<std::uint64_t> nothing(points.covered.size(), 0);
    std::optional<Choice> best;
    double fewest_packets = kScattered * static_cast<double>((texel_count + kPacket - 1) / kPacket);
    for (const Lattice& lattice : kLattices) {
        if (best && lattice.last_cell < best->lattice.last_cell) break;  // finer ones are dearer
        grid.set(lattice, features, seen, nothing);
        Trial trial = try_lattice(points, grid, pilots, texel_count, direction_count);
        if (std::any_of(trial.anchored.begin(), trial.anchored.end(), [](std::uint64_t row) { return row != 0; })) {
            std::vector<std::uint64_t> anchored = std::move(trial.anchored);
            grid.set(lattice, features, seen, anchored);
            trial = try_lattice(points, grid, pilots, texel_count, direction_count);
            trial.anchored = std::move(anchored);
        }
        if (trial.squared_error > tolerance * tolerance || trial.packets >= fewest_packets) continue;
        fewest_packets = trial.packets;
        best = Choice{lattice, std::move(trial)};
    }
    return best;
}

std::uint64_t fixed_point(double value) {
    return static_cast<std::uint64_t>(std::llround(value * 0x1p32));
}

}  // namespace

void TilePoints::extend() {
    // Wave after wave from the covered texels outwards.
    std::vector<std::uint16_t> source(x.size());
    std::vector<std::uint64_t> reached = covered;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column)
            source[static_cast<std::size_t>(texel(column, row))] = static_cast<std::uint16_t>(texel(column, row));
    }
    const std::uint64_t all = ~0ull >> (64 - width);
    while (std::any_of(reached.begin(), reached.end(), [&](std::uint64_t bits) { return bits != all; })) {
        const std::vector<std::uint64_t> before = reached;
        for (int row = 0; row < height; ++row) {
            for (std::uint64_t open = all & ~before[row]; open; open &= open - 1) {
                const int column = std::countr_zero(open);
                for (const Vec2i step : {Vec2i(-1, 0), Vec2i(1, 0), Vec2i(0, -1), Vec2i(0, 1), Vec2i(-1, -1),
                                         Vec2i(1, -1), Vec2i(-1, 1), Vec2i(1, 1)}) {
                    const int c = column + step.x, r = row + step.y;
                    if (c < 0 || r < 0 || c >= width || r >= height || !(before[r] >> c & 1)) continue;
                    const std::size_t from = source[static_cast<std::size_t>(texel(c, r))],
                                      to = static_cast<std::size_t>(texel(column, row));
                    source[to] = static_cast<std::uint16_t>(from);
                    copies.emplace_back(static_cast<std::uint16_t>(to), static_cast<std::uint16_t>(from));
                    x[to] = x[from];
                    y[to] = y[from];
                    z[to] = z[from];
                    reached[row] |= 1ull << column;
                    break;
                }
            }
        }
    }
}

void SkyTileStatistics::add(const SkyTileStatistics& other) {
    rays += other.rays;
    pairs += other.pairs;
    squared_error_sum += other.squared_error_sum;
    view_factor_sum += other.view_factor_sum;
    texels += other.texels;
}

TileLight light_tile(const TilePoints& points, const DomeSamples& dome, DirectionPacket& packet,
                     const SkyTileOptions& options, SkyTileStatistics& statistics) {
    SKYBAKE_CHECK_LE(points.width, TilePoints::kMaxTexels);
    SKYBAKE_CHECK_LE(points.height, TilePoints::kMaxTexels);
    PreparedTexels full(points, points.covered, packet);
    Accumulator sum(points, dome);
    std::vector<std::uint64_t> visible(points.covered.size());
    const std::size_t count = dome.size();
    statistics.pairs += count * full.size();
    statistics.texels += full.size();

    const auto trace_full = [&](std::size_t j) {
        packet.set_direction(dome.directions[j]);
        std::fill(visible.begin(), visible.end(), 0);
        full.trace(visible);
        statistics.rays += full.size();
        sum.add(j, visible);
    };

    if (!options.tolerance || full.size() <= static_cast<std::size_t>(kSmallTile) || count < 4 * kPilots) {
        for (std::size_t j = 0; j < count; ++j) trace_full(j);
        return std::move(sum).light();
    }

    // Pilots: evenly through the list, from low to high and all around.
    std::vector<std::size_t> pilot_index;
    std::vector<std::vector<std::uint64_t>> pilots;
    std::uint64_t visible_pairs = 0;
    for (std::size_t p = 0; p < kPilots; ++p) {
        pilot_index.push_back((2 * p + 1) * count / (2 * kPilots));
        trace_full(pilot_index.back());
        for (const std::uint64_t row : visible) visible_pairs += static_cast<std::uint64_t>(std::popcount(row));
        for (const auto& [to, from] : points.copies) {
            visible[to / points.width] |= (visible[from / points.width] >> (from % points.width) & 1)
                                          << (to % points.width);
        }
        pilots.push_back(visible);
    }
    const double mean_visibility = static_cast<double>(visible_pairs) / static_cast<double>(kPilots * full.size());

    const double tolerance =
        static_cast<double>(*options.tolerance) * std::max(mean_visibility, static_cast<double>(kDarkTile));
    const std::vector<std::uint64_t> seen = seen_by(pilots);
    const std::vector<std::uint64_t> features = features_in_light(points, seen);
    VisibilityGrid grid(points);
    const std::optional<Choice> choice =
        choose_lattice(points, features, seen, grid, pilots, full.size(), count, tolerance);
    if (choice) grid.set(choice->lattice, features, seen, choice->trial.anchored);

    RaySource rays(points, grid.first_look(), packet);
    std::size_t next_pilot = 0;
    for (std::size_t j = 0; j < count; ++j) {
        if (next_pilot < pilot_index.size() && pilot_index[next_pilot] == j) {
            ++next_pilot;
            continue;
        }
        if (!choice) {
            trace_full(j);
            continue;
        }
        packet.set_direction(dome.directions[j]);
        statistics.rays += grid.solve(threshold_of(j), rays, visible);
        sum.add(j, visible);
    }
    if (choice)
        statistics.squared_error_sum += fixed_point(choice->trial.squared_error * static_cast<double>(full.size()));
    statistics.view_factor_sum += fixed_point(mean_visibility * static_cast<double>(full.size()));
    return std::move(sum).light();
}

}  // namespace skybake
