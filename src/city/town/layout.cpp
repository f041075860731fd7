// Cells are those of a Voronoi diagram of jittered sites: streets that bend and meet in threes, as in towns that grew.
#include "city/town/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

constexpr double kSpacing = 58.0;  // between sites: blocks of 12 to 17 houses about a court of 20 to 30 m
constexpr double kRowSpacing = 0.88 * kSpacing;
constexpr double kMargin = 100.0;      // fields beyond the last houses
constexpr double kLeastReach = 395.0;  // holds the castle hill and its foot
constexpr double kQuay = 6.5;          // road along the river

struct Site {
    Vec2d at{0.0};
    std::uint64_t key = 0;
    int segment = 0;  // river segment, for sites beside the river
    int side = 0;     // +1 east of the river, -1 west; 0 elsewhere
    std::string name;
};

std::vector<Site> make_sites(std::uint64_t seed, const River& river, double reach) {
    std::vector<Site> sites;
    const auto rows = static_cast<std::int64_t>(reach / kRowSpacing) + 1;
    const auto columns = static_cast<std::int64_t>(reach / kSpacing) + 2;
    for (std::int64_t j = -rows; j <= rows; ++j) {
        for (std::int64_t i = -columns; i <= columns; ++i) {
            Site site;
            site.key = hash_combine(static_cast<std::uint64_t>(i) + 0x1000, static_cast<std::uint64_t>(j));
            const bool is_middle = i == 0 && j == 0;
            const double wander = is_middle ? 0.0 : 0.27 * kSpacing;
            site.at = Vec2d((static_cast<double>(i) + ((j & 1) != 0 ? 0.5 : 0.0)) * kSpacing,
                            static_cast<double>(j) * kRowSpacing) +
                      Vec2d(draw(seed, site.key, 10, -wander, wander), draw(seed, site.key, 11, -wander, wander));
            if (glm::length(site.at) > reach || river.distance_to(site.at) < River::kClearance) continue;
            site.name = signed_name('e', 'w', i) + signed_name('n', 's', j);
            sites.push_back(std::move(site));
        }
    }
    for (int s = 0; s < river.segment_count(); ++s) {
        for (const int side : {1, -1}) {
            const Vec2d along = river.along(s);
            Site site;
            site.at =
                0.5 * (river.corner(s) + river.corner(s + 1)) + Vec2d(along.y, -along.x) * (side * River::kBlockOffset);
            if (glm::length(site.at) > reach) continue;
            site.segment = s;
            site.side = side;
            site.key = hash_combine(0x717a17ULL + static_cast<std::uint64_t>(side + 1),
                                    static_cast<std::uint64_t>(river.number_of(s)));
            site.name =
                fmt::format("quay-{}-{}", side > 0 ? "east" : "west", signed_name('n', 's', river.number_of(s)));
            sites.push_back(std::move(site));
        }
    }
    std::sort(sites.begin(), sites.end(), [](const Site& a, const Site& b) {
        const double da = glm::dot(a.at, a.at);
        const double db = glm::dot(b.at, b.at);
        return da != db ? da < db : a.key < b.key;
    });
    return sites;
}

/// Sites in square buckets, to find neighbours.
class SiteGrid {
  public:
    SiteGrid(const std::vector<Site>& sites, double reach)
        : columns_(static_cast<std::size_t>(2 * reach / kBucket) + 3), reach_(reach), buckets_(columns_ * columns_) {
        for (std::size_t i = 0; i < sites.size(); ++i) {
            buckets_[bucket(sites[i].at.y) * columns_ + bucket(sites[i].at.x)].push_back(static_cast<int>(i));
        }
    }
    /// All within two to three buckets of p.
    std::vector<int> near(Vec2d p) const {
        std::vector<int> found;
        const std::size_t x = bucket(p.x);
        const std::size_t y = bucket(p.y);
        for (std::size_t j = y - std::min<std::size_t>(y, 2); j <= std::min(y + 2, columns_ - 1); ++j) {
            for (std::size_t i = x - std::min<std::size_t>(x, 2); i <= std::min(x + 2, columns_ - 1); ++i) {
                const std::vector<int>& b = buckets_[j * columns_ + i];
                found.insert(found.end(), b.begin(), b.end());
            }
        }
        return found;
    }

  private:
    static constexpr double kBucket = 75.0;  // two of them are beyond twice the radius of any inner cell
    std::size_t bucket(double v) const { return static_cast<std::size_t>(std::max(0.0, (v + reach_) / kBucket + 1.0)); }
    std::size_t columns_;
    double reach_;
    std::vector<std::vector<int>> buckets_;
};

/// The point at equal distance from three places; the same bits for any order of them.
Vec2d equidistant(std::array<Vec2d, 3> p) {
    std::sort(p.begin(), p.end(), [](const Vec2d& a, const Vec2d& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    const Vec2d b = p[1] - p[0];
    const Vec2d c = p[2] - p[0];
    const double bb = glm::dot(b, b);
    const double cc = glm::dot(c, c);
    return p[0] + Vec2d(c.y * bb - b.y * cc, b.x * cc - c.x * bb) / (2.0 * cross(b, c));
}

/// The cell of site s: bisectors with its neighbours, and the riverbank. Corners are computed from the three things
/// that meet there, so that all neighbours have the same bits. False when it is not closed by neighbours (at the rim).
bool make_land(const std::vector<Site>& sites, const SiteGrid& grid, const River& river, int s, ConvexPolygon& land) {
    const Site& self = sites[static_cast<std::size_t>(s)];
    constexpr int kOpen = -100;
    constexpr double kBox = 130.0;
    land.corners = {self.at + Vec2d(-kBox, -kBox), self.at + Vec2d(kBox, -kBox), self.at + Vec2d(kBox, kBox),
                    self.at + Vec2d(-kBox, kBox)};
    land.labels.assign(4, kOpen);
    if (self.side != 0) {
        const Vec2d along = river.along(self.segment);
        const Vec2d outward = Vec2d(along.y, -along.x) * static_cast<double>(self.side);
        cut(land, river.corner(self.segment) + outward * River::kBankOffset, outward, kRiverbank);
    }
    std::vector<std::pair<double, int>> neighbours;
    for (const int t : grid.near(self.at)) {
        const Site& other = sites[static_cast<std::size_t>(t)];
        if (t == s || (self.side != 0 && other.side == -self.side)) continue;
        neighbours.emplace_back(glm::length(other.at - self.at), t);
    }
    std::sort(neighbours.begin(), neighbours.end());
    for (const auto& [distance, t] : neighbours) {
        const Vec2d to = (sites[static_cast<std::size_t>(t)].at - self.at) / distance;
        cut(land, self.at + to * (0.5 * distance), -to, t);
    }
    for (const int label : land.labels) {
        if (label == kOpen) return false;
    }
    ConvexPolygon exact = land;
    for (std::size_t i = 0; i < land.size(); ++i) {
        const int before = land.labels[(i + land.size() - 1) % land.size()];
        const int after = land.labels[i];
        if (before == kRiverbank || after == kRiverbank) {
            const Site& other = sites[static_cast<std::size_t>(before == kRiverbank ? after : before)];
            if (other.side != self.side || std::abs(other.segment - self.segment) != 1)
                return false;  // the neighbour along the bank is missing
            exact.corners[i] =
                river.corner_beside(std::max(self.segment, other.segment), self.side * River::kBankOffset);
        } else {
            exact.corners[i] = equidistant(
                {self.at, sites[static_cast<std::size_t>(before)].at, sites[static_cast<std::size_t>(after)].at});
        }
    }
    land = std::move(exact);
    return true;
}

/// Which quarter a place belongs to. Streets between quarters are wide, so that wide streets run on through the town.
std::array<std::int64_t, 2> quarter_of(Vec2d p) {
    const double x = p.x + 28.0 * std::sin(p.y / 130.0) + 45.0;
    const double y = p.y + 30.0 * std::sin(p.x / 150.0 + 1.0) + 60.0;
    return {static_cast<std::int64_t>(std::floor(x / 235.0)), static_cast<std::int64_t>(std::floor(y / 205.0))};
}

/// From the middle of the street between two cells to the houses' fronts: lanes of 3.4 to 6 m, streets of 9 to 13 m
/// between quarters.
double half_street_between(std::uint64_t seed, const Cell& a, const Cell& b) {
    const std::uint64_t both = hash_combine(std::min(a.key, b.key), std::max(a.key, b.key));
    if (quarter_of(a.site) != quarter_of(b.site)) return draw(seed, both, 20, 4.5, 6.5);
    return draw(seed, both, 21, 1.7, 3.0);
}

bool has_houses(CellUse use) {
    return use == CellUse::block;
}

CellUse use_of(std::uint64_t seed, const Cell& cell, std::size_t index, Vec2d church, Vec2d tower_site) {
    if (index == 0) return CellUse::square;
    if (cell.site == church) return CellUse::church;
    if (cell.site == tower_site) return CellUse::tower_site;
    if (distance_to(cell.land, Relief::kHillMiddle) < Relief::kHillReach) return CellUse::hill;
    const double r = glm::length(cell.site);
    if (!cell.is_beside_river && r > 420.0) {
        const double lot = draw(seed, cell.key, 30);
        if (lot < 0.006) return CellUse::church;
        if (lot < 0.04) return CellUse::park;
    }
    return CellUse::block;
}

/// The free-standing site nearest to a place.
Vec2d nearest_site(const std::vector<Site>& sites, Vec2d place) {
    Vec2d best{0.0};
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t i = 1; i < sites.size(); ++i) {
        const double d = glm::length(sites[i].at - place);
        if (sites[i].side == 0 && d < nearest) {
            nearest = d;
            best = sites[i].at;
        }
    }
    return best;
}

void make_block(Cell& cell) {
    cell.block = cell.land;
    for (std::size_t i = 0; i < cell.land.size(); ++i) cell.block.labels[i] = static_cast<int>(i);
    for (std::size_t i = 0; i < cell.land.size(); ++i) {
        const Vec2d a = cell.land.corner(i);
        const Vec2d inward = left_of(glm::normalize(cell.land.corner(i + 1) - a));
        cut(cell.block, a + inward * cell.half_street[i], inward, static_cast<int>(i));
    }
    // The cut leaves no corner on the land's own edges, as every street is wider than nothing; but it may leave slivers
    // of edges.
}

/// Cells of all sites within `reach`; `room` is how many houses they hold.
Layout try_layout(std::uint64_t seed, double reach, std::uint32_t houses, bool& is_enough) {
    const double site_reach = std::max(reach + kMargin, kLeastReach) + 2.5 * kSpacing;
    Layout layout{River(seed, site_reach), {}, {}, 0.0, 0, 0};
    const std::vector<Site> sites = make_sites(seed, layout.river, site_reach);
    const SiteGrid grid(sites, site_reach);
    const Vec2d church = nearest_site(sites, {50.0, -46.0});
    const Vec2d tower_site = nearest_site(sites, {118.0, -30.0});
    for (std::size_t s = 0; s < sites.size(); ++s) {
        Cell cell;
        cell.name = sites[s].name;
        cell.key = sites[s].key;
        cell.site = sites[s].at;
        cell.is_beside_river = sites[s].side != 0;
        if (!make_land(sites, grid, layout.river, static_cast<int>(s), cell.land)) cell.land = {};
        layout.cells.push_back(std::move(cell));
    }
    for (std::size_t s = 0; s < layout.cells.size(); ++s) {
        if (layout.cells[s].land.size() > 0) layout.cells[s].use = use_of(seed, layout.cells[s], s, church, tower_site);
    }
    layout.houses_in.assign(layout.cells.size(), 0);
    std::uint32_t left = houses;
    double farthest = 0.0;
    bool is_first_church = true;
    for (std::size_t s = 0; s < layout.cells.size() && left > 0; ++s) {
        Cell& cell = layout.cells[s];
        const double r = glm::length(cell.site);
        if (r > reach) break;
        if (cell.land.size() == 0) continue;
        for (const int label : cell.land.labels) {
            cell.half_street.push_back(
                label == kRiverbank ? kQuay
                                    : half_street_between(seed, cell, layout.cells[static_cast<std::size_t>(label)]));
        }
        make_block(cell);
        farthest = r;
        if (cell.use == CellUse::church && !std::exchange(is_first_church, false)) --left;
        if (!has_houses(cell.use)) continue;
        divide_into_lots(seed, cell);
        layout.houses_in[s] = std::min(left, static_cast<std::uint32_t>(cell.lots.size()));
        left -= layout.houses_in[s];
    }
    is_enough = left == 0;
    // Land beyond the last house: fields, except for what belongs to the old centre whatever the number of houses.
    layout.reach = std::max(farthest + kMargin, kLeastReach);
    for (std::size_t s = 0; s < layout.cells.size(); ++s) {
        Cell& cell = layout.cells[s];
        const bool is_old_centre = cell.use == CellUse::hill || cell.site == church || cell.site == tower_site;
        if (is_old_centre || glm::length(cell.site) <= farthest) continue;
        cell.use = CellUse::field;
    }
    return layout;
}

}  // namespace

std::string signed_name(char positive, char negative, std::int64_t value) {
    return fmt::format("{}{}", value < 0 ? negative : positive, std::abs(value));
}

Layout lay_out(std::uint64_t seed, std::uint32_t houses) {
    // 13 houses a cell of kSpacing × kRowSpacing, and what the river and the hill take from a small town.
    double reach = std::sqrt(houses / 13.0 * kSpacing * kRowSpacing / kPi) * 1.1 + 120.0;
    for (;; reach *= 1.15) {
        bool is_enough = false;
        Layout layout = try_layout(seed, reach, houses, is_enough);
        if (!is_enough) continue;
        std::size_t drawn = 0;
        while (drawn < layout.cells.size() && glm::length(layout.cells[drawn].site) < layout.reach) ++drawn;
        layout.cells.resize(drawn);
        layout.houses_in.resize(drawn);
        for (Cell& cell : layout.cells) {
            SKYBAKE_CHECK(cell.land.size() >= 3);
            if (cell.half_street.empty() && cell.use != CellUse::field && cell.use != CellUse::hill) {
                cell.half_street.assign(cell.land.size(), 3.0);
                make_block(cell);
            }
        }
        layout.first_segment = layout.river.segment_count();
        for (int s = 0; s < layout.river.segment_count(); ++s) {
            const Vec2d middle_of_segment = 0.5 * (layout.river.corner(s) + layout.river.corner(s + 1));
            if (glm::length(middle_of_segment) > layout.reach) continue;
            layout.first_segment = std::min(layout.first_segment, s);
            layout.last_segment = s + 1;
        }
        return layout;
    }
}

}  // namespace skybake::town
