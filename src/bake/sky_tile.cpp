// Based on: Reichinger, Maierhofer, Tobler, 2006, §4.2 (light on a coarse lattice of 16 × 16 texels, refined by
// halving). Deviation: the hierarchy runs over each direction's visibility instead of over their sum
// (docs/decisions/0003-hierarchy-over-visibility.md).
#include "bake/sky_tile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "bake/shadow_projection.h"
#include "bake/sky_accumulator.h"
#include "bake/visibility_grid.h"
#include "base/check.h"
#include "base/low_discrepancy.h"

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
    crown_rays += other.crown_rays;
    pairs += other.pairs;
    squared_error_sum += other.squared_error_sum;
    view_factor_sum += other.view_factor_sum;
    texels += other.texels;
}

TileLight light_tile(const TilePoints& points, const SkyDirections& directions, const OccluderTree* occluders,
                     const CrownVolume* crowns, DirectionPacket& packet, const SkyTileOptions& options,
                     SkyTileStatistics& statistics) {
    SKYBAKE_CHECK_LE(points.width, TilePoints::kMaxSize);
    SKYBAKE_CHECK_LE(points.height, TilePoints::kMaxSize);
    const DomeSamples& dome = directions.dome;
    PreparedTexels full(points, points.covered, packet);
    SkyAccumulator sum(points, dome);
    std::vector<std::uint64_t> visible(points.covered.size());
    const std::size_t count = dome.size();
    std::optional<CrownShade> shade;
    if (crowns) shade.emplace(points, dome, *directions.cones, *crowns, packet);
    statistics.pairs += count * full.size();
    statistics.texels += full.size();

    const auto add_seen = [&](std::size_t j) {
        sum.add(j, visible);
        if (shade) statistics.crown_rays += shade->dim(j, visible, sum);
    };
    const auto trace_full = [&](std::size_t j) {
        packet.set_direction(dome.directions[j]);
        std::fill(visible.begin(), visible.end(), 0);
        full.trace(visible);
        statistics.rays += full.size();
        add_seen(j);
    };

    if (options.sampling == SkySampling::projected) {
        ShadowProjector projector(*occluders, points);
        for (std::size_t b = 0; b < directions.bundles.size(); ++b) {
            const std::span<const std::uint32_t> bundle = directions.bundles[b];
            projector.set_bundle(dome.directions, bundle);
            for (const std::uint32_t j : bundle) {
                if (projector.find_visible(dome.directions[j], visible)) {
                    add_seen(j);
                } else {
                    trace_full(j);
                }
            }
        }
        for (const std::uint32_t j : directions.not_bundled) trace_full(j);
        return std::move(sum).light();
    }
    if (options.sampling == SkySampling::full || full.size() <= static_cast<std::size_t>(kSmallTile) ||
        count < 4 * kPilots) {
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
        static_cast<double>(options.tolerance) * std::max(mean_visibility, static_cast<double>(kDarkTile));
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
        add_seen(j);
    }
    if (choice)
        statistics.squared_error_sum += fixed_point(choice->trial.squared_error * static_cast<double>(full.size()));
    statistics.view_factor_sum += fixed_point(mean_visibility * static_cast<double>(full.size()));
    return std::move(sum).light();
}

}  // namespace skybake
