#include "city/town/street_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "city/town/landmarks.h"
#include "city/town/object_builder.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

constexpr double kSpacing = 25.0;
constexpr double kLeastStreet = 10.0;  // shorter ones have light from their ends
constexpr double kLaneHalfWidth = 4.0;

/// What hangs over a lane, over a street or a quay, and what stands on squares and bridges.
struct Kind {
    double height_m, flux_lm, kelvin;
};
constexpr Kind kLane{4.8, 1100.0, 2700.0};
constexpr Kind kStreet{6.0, 2600.0, 3000.0};
constexpr Kind kSquare{4.5, 2200.0, 2700.0};
constexpr Kind kBridge{4.2, 1400.0, 2200.0};

class Placer {
  public:
    Placer(std::uint64_t seed, const Relief& relief) : seed_(seed), relief_(relief) {}

    void stand(const std::string& id, Vec2d p, const Kind& kind) { put(id, {p.x, p.y, relief_.ground(p)}, kind); }
    void put(const std::string& id, const Vec3d& foot, const Kind& kind) {
        // Not two lamps are quite alike: dirt and age.
        const double flux = kind.flux_lm * draw(seed_, hash_of(id), 40, 0.9, 1.1);
        const Vec3d place = kTownOrigin + foot + Vec3d(0.0, 0.0, kind.height_m);
        lamps.push_back({id, glm::round(place * 1000.0) / 1000.0, std::round(flux), kind.kelvin});
    }
    /// Evenly from a to b, about kSpacing apart.
    void along(const std::string& id, Vec2d a, Vec2d b, const Kind& kind) {
        const double length = glm::length(b - a);
        if (length < kLeastStreet) return;
        const int count = std::max(1, static_cast<int>(std::lround(length / kSpacing)));
        for (int k = 0; k < count; ++k) stand(fmt::format("{}-{}", id, k), a + (b - a) * ((k + 0.5) / count), kind);
    }

    std::vector<StreetLamp> lamps;

  private:
    std::uint64_t seed_;
    const Relief& relief_;
};

bool is_built(const Layout& layout, std::size_t cell) {
    const CellUse use = layout.cells[cell].use;
    return layout.houses_in[cell] > 0 || use == CellUse::square || use == CellUse::church;
}

void light_streets(Placer& placer, const Layout& layout, std::size_t index) {
    const Cell& cell = layout.cells[index];
    for (std::size_t e = 0; e < cell.land.size() && !cell.half_street.empty(); ++e) {
        const Vec2d a = cell.land.corner(e), b = cell.land.corner(e + 1);
        const std::string id = fmt::format("lamp-{}-{}", cell.name, e);
        const int label = cell.land.labels[e];
        if (label == kRiverbank) {
            constexpr double kFromBank = 1.2;
            const Vec2d inward = left_of(glm::normalize(b - a));
            if (is_built(layout, index)) placer.along(id, a + kFromBank * inward, b + kFromBank * inward, kStreet);
            continue;
        }
        const auto other = static_cast<std::size_t>(label);
        // The neighbour of the lower number lights both halves; towards open land there is half a street alone, whose
        // lamps stand at its outer edge.
        const bool is_whole = other < layout.cells.size() && !layout.cells[other].half_street.empty();
        if (is_whole && other < index) continue;
        if (!is_built(layout, index) && !(is_whole && is_built(layout, other))) continue;
        placer.along(id, a, b, cell.half_street[e] < kLaneHalfWidth ? kLane : kStreet);
    }
}

void light_square(Placer& placer, const Cell& cell) {
    constexpr double kInset = 7.0;
    ConvexPolygon ring = cell.block;
    for (std::size_t i = 0; i < cell.block.size(); ++i) {
        const Vec2d a = cell.block.corner(i), b = cell.block.corner(i + 1);
        if (glm::length(b - a) < 1e-6) continue;
        const Vec2d inward = left_of(glm::normalize(b - a));
        cut(ring, a + kInset * inward, inward, ring.labels.front());
    }
    for (std::size_t i = 0; i < ring.size(); ++i)
        placer.along(fmt::format("lamp-{}-square-{}", cell.name, i), ring.corner(i), ring.corner(i + 1), kSquare);
}

}  // namespace

std::vector<StreetLamp> place_lamps(std::uint64_t seed, const Layout& layout, const Relief& relief) {
    Placer placer(seed, relief);
    for (std::size_t c = 0; c < layout.cells.size(); ++c) {
        light_streets(placer, layout, c);
        if (layout.cells[c].use == CellUse::square) light_square(placer, layout.cells[c]);
    }
    for (int s = layout.first_segment; s < layout.last_segment; ++s) {
        if (!has_bridge(layout, s)) continue;
        const std::string name = signed_name('n', 's', layout.river.number_of(s));
        constexpr double kThird = 8.0, kBesideParapet = 3.6;
        placer.put("lamp-bridge-" + name + "-west", on_bridge(layout, s, relief, -kThird, -kBesideParapet), kBridge);
        placer.put("lamp-bridge-" + name + "-east", on_bridge(layout, s, relief, kThird, kBesideParapet), kBridge);
    }
    return std::move(placer.lamps);
}

}  // namespace skybake::town
