#include "city/town/landmarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "city/town/houses.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

Vec3d lift(Vec2d p, double z) {
    return {p.x, p.y, z};
}

/// How walls and roofs of a solid look: one image every so many metres.
struct Skin {
    Picture picture = Picture::masonry;
    int variant = 0;
    double period_u = kMasonryPeriod;
    double period_v = kMasonryPeriod;
};

constexpr Skin kMasonry{Picture::masonry, 0, kMasonryPeriod, kMasonryPeriod};
constexpr Skin kTiles{Picture::tiles_first, 0, kTilePeriod, kTilePeriod};
constexpr Skin kCopper{Picture::copper, 0, kCopperPeriod, kCopperPeriod};

/// A face whose u runs level along its first edge and whose v runs up the face.
void add_face(ObjectBuilder& builder, const std::vector<Vec3d>& ring, SurfaceType type, const Skin& skin,
              const std::vector<std::vector<Vec3d>>& holes = {}) {
    const Vec3d along = glm::normalize(ring[1] - ring[0]);
    const Vec3d normal = glm::normalize(glm::cross(along, ring[2] - ring[0]));
    const Vec3d up = glm::cross(normal, along);
    builder.add(
        ring, holes,
        {type, id_of(skin.picture, skin.variant), {ring[0], along / skin.period_u, up / skin.period_v, Vec2d(0.0)}});
}

std::vector<Vec3d> at_height(const std::vector<Vec2d>& ring, double z) {
    std::vector<Vec3d> lifted;
    for (const Vec2d& p : ring) lifted.push_back(lift(p, z));
    return lifted;
}

std::vector<Vec3d> reversed(std::vector<Vec3d> ring) {
    std::reverse(ring.begin(), ring.end());
    return ring;
}

void add_wall_ring(ObjectBuilder& builder, const std::vector<Vec2d>& ring, double base, double top, const Skin& skin) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d a = ring[i];
        const Vec2d b = ring[(i + 1) % ring.size()];
        add_face(builder, {lift(a, base), lift(b, base), lift(b, top), lift(a, top)}, SurfaceType::wall, skin);
    }
}

void add_base(ObjectBuilder& builder, const std::vector<Vec2d>& ring, double base, const Skin& skin) {
    add_face(builder, reversed(at_height(ring, base)), SurfaceType::ground, skin);
}

/// A closed prism with a level top.
void add_prism(ObjectBuilder& builder, const std::vector<Vec2d>& ring, double base, double top, const Skin& walls,
               const Skin& roof) {
    add_base(builder, ring, base, walls);
    add_wall_ring(builder, ring, base, top, walls);
    add_face(builder, at_height(ring, top), SurfaceType::roof, roof);
    builder.close_shell(Shell::Kind::outer);
}

std::vector<Vec2d> rectangle(Vec2d origin, Vec2d u, double length, double width) {
    const Vec2d v = left_of(u);
    return {origin, origin + u * length, origin + u * length + v * width, origin + v * width};
}

std::vector<Vec2d> around(Vec2d centre, double radius, int sides, double turn) {
    std::vector<Vec2d> ring;
    for (int i = 0; i < sides; ++i) {
        const double a = turn + 2 * kPi * i / sides;
        ring.push_back(centre + Vec2d(std::cos(a), std::sin(a)) * radius);
    }
    return ring;
}

/// A pointed roof over a convex ring, with eaves `overhang` beyond it: soffits, then a triangle for each side.
void add_pointed_roof(ObjectBuilder& builder, const std::vector<Vec2d>& ring, double eave, double rise, double overhang,
                      const Skin& skin) {
    const Vec2d centre = middle(ring);
    std::vector<Vec2d> eaves;
    for (const Vec2d& p : ring) eaves.push_back(centre + (p - centre) * (1.0 + overhang / glm::length(p - centre)));
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::size_t next = (i + 1) % ring.size();
        if (overhang > 0) {
            add_face(builder,
                     {lift(eaves[i], eave), lift(ring[i], eave), lift(ring[next], eave), lift(eaves[next], eave)},
                     SurfaceType::ceiling, skin);
        }
        add_face(builder, {lift(eaves[i], eave), lift(eaves[next], eave), lift(centre, eave + rise)}, SurfaceType::roof,
                 skin);
    }
}

CityObject part_of(ObjectBuilder& builder, const std::string& parent) {
    builder.object.parent_id = parent;
    return builder.take();
}

CityObject whole(std::string id, std::string attributes) {
    CityObject object;
    object.id = std::move(id);
    object.type = ObjectType::building;
    object.type_name = "Building";
    object.attributes_json = std::move(attributes);
    object.where = "town: " + object.id;
    return object;
}

}  // namespace

std::vector<CityObject> build_church(std::uint64_t, const Cell& cell, const Relief& relief, bool is_first) {
    const std::string id = is_first ? "church" : cell.name + "-church";
    const double inside = depth_inside(cell.block.corners, middle(cell.block.corners));
    const double scale = std::clamp((inside - 1.0) / 22.0, 0.5, 1.0);
    const Vec2d u = glm::normalize(Vec2d(1.0, 0.16));
    const Vec2d v = left_of(u);
    const double tower = 8.0 * scale;
    const double nave = 25.0 * scale;
    const double width = 14.0 * scale;
    const double total = tower + nave + 0.5 * width;
    const Vec2d origin = middle(cell.block.corners) - u * (0.5 * total);
    const double floor = relief.ground(middle(cell.block.corners));
    const double base = floor - 2.0;
    const double eave = floor + 13.0 * scale;
    const Skin walls{Picture::church, 0, nave / std::max(1.0, std::round(nave / kChurchBay)), kChurchHeight * scale};
    const Skin plain{Picture::plaster_first, 1, kPlasterPeriod, kPlasterPeriod};
    std::vector<CityObject> objects = {whole(id, R"({"function":"church"})")};

    // Nave and apse: a gabled hall whose east end is half an octagon under a half pyramid.
    ObjectBuilder hall(id + "-nave", ObjectType::building_part, "BuildingPart");
    const double half = 0.5 * width;
    const double ridge = eave + 1.15 * half;
    const auto at = [&](double x, double y) { return origin + u * (tower + x) + v * y; };
    const double s = half * std::tan(kPi / 8);
    const std::vector<Vec2d> ring = {at(0, -half),       at(nave, -half),    at(nave + s, -half), at(nave + half, -s),
                                     at(nave + half, s), at(nave + s, half), at(nave, half),      at(0, half)};
    add_base(hall, ring, base, plain);
    for (const std::size_t i : {0u, 1u, 2u, 3u, 4u, 5u, 6u}) {
        Skin skin = walls;
        const double length = glm::length(ring[i + 1] - ring[i]);
        skin.period_u = length / std::max(1.0, std::round(length / kChurchBay));
        const Vec3d from = lift(ring[i], floor);
        hall.add({lift(ring[i], base), lift(ring[i + 1], base), lift(ring[i + 1], eave), lift(ring[i], eave)},
                 wall_finish(SurfaceType::wall, id_of(skin.picture), from, glm::normalize(ring[i + 1] - ring[i]),
                             1.0 / skin.period_u, 1.0 / skin.period_v));
    }
    add_face(
        hall,
        {lift(ring[7], base), lift(ring[0], base), lift(ring[0], eave), lift(at(0, 0), ridge), lift(ring[7], eave)},
        SurfaceType::wall, plain);
    const Vec3d west = lift(at(0, 0), ridge);
    const Vec3d east = lift(at(nave, 0), ridge);
    add_face(hall, {lift(ring[0], eave), lift(ring[1], eave), east, west}, SurfaceType::roof, kTiles);
    add_face(hall, {lift(ring[6], eave), lift(ring[7], eave), west, east}, SurfaceType::roof, kTiles);
    for (const std::size_t i : {1u, 2u, 3u, 4u, 5u})
        add_face(hall, {lift(ring[i], eave), lift(ring[i + 1], eave), east}, SurfaceType::roof, kTiles);
    hall.close_shell(Shell::Kind::outer);
    objects.push_back(part_of(hall, id));

    // Tower: square, then an octagonal storey, an onion and a lantern's spike, all one shell.
    ObjectBuilder spire(id + "-tower", ObjectType::building_part, "BuildingPart");
    const std::vector<Vec2d> foot = rectangle(origin - v * (0.5 * tower), u, tower, tower);
    const Vec2d centre = middle(foot);
    const double shaft = floor + 31.0 * scale;
    const double turn = std::atan2(u.y, u.x) + kPi / 8;
    add_base(spire, foot, base, plain);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d a = foot[i];
        const Vec2d b = foot[(i + 1) % 4];
        spire.add({lift(a, base), lift(b, base), lift(b, shaft), lift(a, shaft)},
                  wall_finish(SurfaceType::wall, id_of(Picture::church), lift(a, floor), (b - a) / tower, 1.0 / tower,
                              1.0 / (kChurchHeight * scale)));
    }
    const double h = tower / 8.0;
    const std::vector<std::pair<double, double>> profile = {{3.7, 0.0},  {3.7, 3.5},  {4.25, 4.3}, {4.35, 5.6},
                                                            {3.8, 7.0},  {2.6, 8.4},  {1.5, 9.8},  {1.1, 11.2},
                                                            {1.1, 13.4}, {1.5, 14.0}, {1.2, 15.0}, {0.5, 16.4}};
    add_face(spire, at_height(foot, shaft), SurfaceType::roof, kCopper,
             {reversed(at_height(around(centre, profile[0].first * h, 8, turn), shaft))});
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
        const std::vector<Vec3d> lower =
            at_height(around(centre, profile[k].first * h, 8, turn), shaft + profile[k].second * h);
        const std::vector<Vec3d> upper =
            at_height(around(centre, profile[k + 1].first * h, 8, turn), shaft + profile[k + 1].second * h);
        const bool is_wall = k == 0;
        for (std::size_t i = 0; i < 8; ++i) {
            const std::size_t next = (i + 1) % 8;
            add_face(spire, {lower[i], lower[next], upper[next], upper[i]},
                     is_wall ? SurfaceType::wall : SurfaceType::roof, is_wall ? plain : kCopper);
        }
    }
    const std::vector<Vec3d> last =
        at_height(around(centre, profile.back().first * h, 8, turn), shaft + profile.back().second * h);
    for (std::size_t i = 0; i < 8; ++i) {
        add_face(spire, {last[i], last[(i + 1) % 8], lift(centre, shaft + 20.5 * h)}, SurfaceType::roof, kCopper);
    }
    spire.close_shell(Shell::Kind::outer);
    objects.push_back(part_of(spire, id));
    return objects;
}

std::vector<CityObject> build_hilltop(std::uint64_t, const Relief& relief) {
    std::vector<CityObject> objects;
    const Vec2d hill = Relief::kHillMiddle;

    // The castle: a palace, a keep and a curtain wall along the plateau's rim, open towards the clock tower.
    objects.push_back(whole("castle", R"({"function":"castle"})"));
    {
        ObjectBuilder palace("castle-palace", ObjectType::building_part, "BuildingPart");
        FreeHouse house;
        house.u = glm::normalize(Vec2d(1.0, 0.35));
        house.origin = hill + Vec2d(-16.0, 5.0);
        house.length = 30.0;
        house.width = 11.0;
        house.facade = 1;
        house.floor = relief.ground(hill + Vec2d(0.0, 12.0));
        house.base = lowest_ground(relief, rectangle(house.origin, house.u, house.length, house.width)) - kFoundation;
        house.height = 10.6;
        add_free_house(palace, house);
        palace.close_shell(Shell::Kind::outer);
        objects.push_back(part_of(palace, "castle"));

        ObjectBuilder keep("castle-keep", ObjectType::building_part, "BuildingPart");
        const std::vector<Vec2d> round = around(hill + Vec2d(24.0, -8.0), 6.0, 12, 0.1);
        const double floor = relief.ground(middle(round));
        add_base(keep, round, floor - 2.0, kMasonry);
        add_wall_ring(keep, round, floor - 2.0, floor + 17.0, kMasonry);
        add_pointed_roof(keep, round, floor + 17.0, 9.0, 0.7, kTiles);
        keep.close_shell(Shell::Kind::outer);
        objects.push_back(part_of(keep, "castle"));

        // Curtain: straight lengths of wall, 1.6 m thick, mitred where they meet.
        ObjectBuilder curtain("castle-curtain", ObjectType::building_installation, "BuildingInstallation");
        constexpr int kLengths = 10;
        std::vector<Vec2d> outer;
        std::vector<Vec2d> inner;
        for (int i = 0; i <= kLengths; ++i) {
            const double a = -0.95 * kPi + 1.55 * kPi * i / kLengths + kPi;
            const Vec2d d{std::cos(a), std::sin(a)};
            const double r = Relief::hill_foot(hill + d) * Relief::kPlateau + 2.0;
            outer.push_back(hill + d * r);
            inner.push_back(hill + d * (r - 1.6));
        }
        for (std::size_t i = 0; i < kLengths; ++i) {
            const std::vector<Vec2d> length = {outer[i], outer[i + 1], inner[i + 1], inner[i]};
            add_prism(curtain, length, lowest_ground(relief, length) - kFoundation, relief.ground(hill) + 4.2, kMasonry,
                      kMasonry);
        }
        objects.push_back(part_of(curtain, "castle"));
    }

    // The clock tower stands at the edge of the plateau towards the town: shaft, wooden gallery under the eaves, steep
    // roof.
    ObjectBuilder clock("clock-tower", ObjectType::building, "Building");
    const Vec2d u = glm::normalize(Vec2d(1.0, -0.12));
    const Vec2d v = left_of(u);
    const Vec2d centre = hill + Vec2d(-10.0, -34.0);
    const auto square = [&](double side) { return rectangle(centre - (u + v) * (0.5 * side), u, side, side); };
    const double floor = relief.ground(centre);
    const double base = lowest_ground(relief, square(9.0)) - kFoundation;
    const double gallery = floor + 17.0;
    const std::vector<Vec2d> shaft = square(8.5);
    const std::vector<Vec2d> wide = square(10.5);
    add_base(clock, shaft, base, kMasonry);
    add_wall_ring(clock, shaft, base, floor + 8.5, kMasonry);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        clock.add({lift(shaft[i], floor + 8.5), lift(shaft[next], floor + 8.5), lift(shaft[next], gallery),
                   lift(shaft[i], gallery)},
                  wall_finish(SurfaceType::wall, id_of(Picture::clock), lift(shaft[i], floor + 8.5),
                              glm::normalize(shaft[next] - shaft[i]), 1.0 / 8.5, 1.0 / 8.5));
        add_face(
            clock,
            {lift(wide[i], gallery), lift(shaft[i], gallery), lift(shaft[next], gallery), lift(wide[next], gallery)},
            SurfaceType::ceiling, {Picture::tiles_first, 1, kTilePeriod, kTilePeriod});
        add_face(clock,
                 {lift(wide[i], gallery), lift(wide[next], gallery), lift(wide[next], gallery + 2.4),
                  lift(wide[i], gallery + 2.4)},
                 SurfaceType::wall, {Picture::tiles_first, 1, kTilePeriod, kTilePeriod});
    }
    add_pointed_roof(clock, wide, gallery + 2.4, 9.5, 0.5, kTiles);
    clock.close_shell(Shell::Kind::outer);
    clock.object.attributes_json = R"({"function":"clock tower","measuredHeight":28.9})";
    objects.push_back(clock.take());
    return objects;
}

namespace {

/// Where a bridge lies, and how high its deck is.
struct BridgeFrame {
    static constexpr double kReach = River::kBankOffset + 1.5;

    BridgeFrame(const River& river, int segment, const Relief& relief)
        : along(river.along(segment)),
          across(along.y, -along.x),
          centre(0.5 * (river.corner(segment) + river.corner(segment + 1))),
          west(relief.ground(centre - across * kReach) + 0.05),
          east(relief.ground(centre + across * kReach) + 0.05) {}

    double deck(double x) const {
        constexpr double kCamber = 0.9;
        const double t = (x + kReach) / (2 * kReach);
        return west + (east - west) * t + kCamber * 4 * t * (1 - t);
    }

    Vec2d along;
    Vec2d across;  // from the west bank to the east bank
    Vec2d centre;
    double west, east;  // heights of the deck's ends
};

}  // namespace

bool has_bridge(const Layout& layout, int segment) {
    return (layout.river.number_of(segment) % 4 + 4) % 4 == 1;
}

Vec3d on_bridge(const Layout& layout, int segment, const Relief& relief, double across, double along) {
    const BridgeFrame frame(layout.river, segment, relief);
    return lift(frame.centre + frame.across * across + frame.along * along, frame.deck(across));
}

CityObject build_bridge(const Layout& layout, int segment, const Relief& relief) {
    // Three arches in a long profile, drawn out over the width; parapets stand on the deck as shells of their own.
    const River& river = layout.river;
    ObjectBuilder bridge("bridge-" + signed_name('n', 's', river.number_of(segment)), ObjectType::bridge, "Bridge");
    const BridgeFrame frame(river, segment, relief);
    const Vec2d along = frame.along, across = frame.across, centre = frame.centre;
    constexpr double kReach = BridgeFrame::kReach;
    constexpr double kWidth = 9.0;
    const double water = relief.water(centre);
    const auto deck = [&](double x) { return frame.deck(x); };
    std::vector<Vec2d> below;  // (across, height), from west to east
    below.emplace_back(-kReach, water - 3.0);
    constexpr double kPier = 1.8;
    constexpr double kSpan = (2 * River::kBankOffset - 4.0 - 2 * kPier) / 3.0;
    constexpr int kSteps = 8;
    for (int arch = 0; arch < 3; ++arch) {
        const double from = -River::kBankOffset + 2.0 + arch * (kSpan + kPier);
        const double crown = deck(from + 0.5 * kSpan) - 1.0;
        below.emplace_back(from, water - 3.0);
        for (int k = 0; k <= kSteps; ++k) {
            const double a = kPi * k / kSteps;
            const double spring = water + 0.4;
            below.emplace_back(from + 0.5 * kSpan * (1.0 - std::cos(a)), spring + (crown - spring) * std::sin(a));
        }
        below.emplace_back(from + kSpan, water - 3.0);
    }
    below.emplace_back(kReach, water - 3.0);
    std::vector<Vec2d> above;  // from east to west
    constexpr int kDeckSteps = 6;
    for (int k = 0; k <= kDeckSteps; ++k) {
        const double x = kReach - 2 * kReach * k / kDeckSteps;
        above.emplace_back(x, deck(x));
    }
    std::vector<Vec2d> profile = below;
    profile.insert(profile.end(), above.begin(), above.end());
    const auto place = [&](Vec2d p, double side) {
        return lift(centre + across * p.x + along * (side * 0.5 * kWidth), p.y);
    };
    std::vector<Vec3d> south;
    std::vector<Vec3d> north;
    for (const Vec2d& p : profile) {
        south.push_back(place(p, -1.0));
        north.push_back(place(p, 1.0));
    }
    const auto side_finish = [&](const Vec3d& origin, Vec2d u) {
        return wall_finish(SurfaceType::wall, id_of(Picture::masonry), origin, u, 1.0 / kMasonryPeriod,
                           1.0 / kMasonryPeriod);
    };
    bridge.add(south, {}, side_finish(south[0], across));
    bridge.add(reversed(north), {}, side_finish(north[0], -across));
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const std::size_t next = (i + 1) % profile.size();
        const bool is_deck = i >= below.size() && next >= below.size();
        add_face(bridge, {south[next], south[i], north[i], north[next]},
                 is_deck ? SurfaceType::roof : SurfaceType::wall,
                 is_deck ? Skin{Picture::cobbles, 0, kCobblePeriod, kCobblePeriod} : kMasonry);
    }
    bridge.close_shell(Shell::Kind::outer);
    for (const double side : {-1.0, 1.0}) {
        for (int k = 0; k < kDeckSteps; ++k) {
            const Vec2d p = above[static_cast<std::size_t>(k + 1)];
            const Vec2d q = above[static_cast<std::size_t>(k)];
            const double inner = side > 0 ? 0.5 * kWidth - 0.4 : -0.5 * kWidth;
            const auto at = [&](Vec2d c, double y, double up) {
                return lift(centre + across * c.x + along * (inner + y), c.y + up);
            };
            const double low = -0.25;  // into the deck, so that no light passes
            const double high = 1.0;
            add_face(bridge, {at(p, 0, low), at(q, 0, low), at(q, 0, high), at(p, 0, high)}, SurfaceType::wall,
                     kMasonry);
            add_face(bridge, {at(q, 0.4, low), at(p, 0.4, low), at(p, 0.4, high), at(q, 0.4, high)}, SurfaceType::wall,
                     kMasonry);
            add_face(bridge, {at(p, 0, high), at(q, 0, high), at(q, 0.4, high), at(p, 0.4, high)}, SurfaceType::wall,
                     kMasonry);
            add_face(bridge, {at(p, 0.4, low), at(q, 0.4, low), at(q, 0, low), at(p, 0, low)}, SurfaceType::wall,
                     kMasonry);
            add_face(bridge, {at(p, 0.4, low), at(p, 0, low), at(p, 0, high), at(p, 0.4, high)}, SurfaceType::wall,
                     kMasonry);
            add_face(bridge, {at(q, 0, low), at(q, 0.4, low), at(q, 0.4, high), at(q, 0, high)}, SurfaceType::wall,
                     kMasonry);
            bridge.close_shell(Shell::Kind::outer);
        }
    }
    return bridge.take();
}

CityObject build_column(const Cell& square, const Relief& relief) {
    ObjectBuilder column("square-column", ObjectType::furniture, "CityFurniture");
    const Vec2d centre = middle(square.block.corners);
    const double floor = relief.ground(centre);
    const Skin stone = kMasonry;
    const std::vector<std::pair<double, double>> profile = {{2.6, -0.6}, {2.6, 0.5},  {1.5, 0.5}, {1.3, 2.4},
                                                            {0.55, 2.6}, {0.42, 9.0}, {0.9, 9.4}, {0.5, 9.8}};
    add_base(column, around(centre, profile[0].first, 8, 0.2), floor + profile[0].second, stone);
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
        const std::vector<Vec3d> lower = at_height(around(centre, profile[k].first, 8, 0.2), floor + profile[k].second);
        const std::vector<Vec3d> upper =
            at_height(around(centre, profile[k + 1].first, 8, 0.2), floor + profile[k + 1].second);
        for (std::size_t i = 0; i < 8; ++i) {
            const std::size_t next = (i + 1) % 8;
            add_face(column, {lower[i], lower[next], upper[next], upper[i]}, SurfaceType::wall, stone);
        }
    }
    const std::vector<Vec3d> last =
        at_height(around(centre, profile.back().first, 8, 0.2), floor + profile.back().second);
    for (std::size_t i = 0; i < 8; ++i) {
        add_face(column, {last[i], last[(i + 1) % 8], lift(centre, floor + 11.6)}, SurfaceType::wall, kCopper);
    }
    column.close_shell(Shell::Kind::outer);
    return column.take();
}

CityObject build_planned_tower(const Cell& site, const Relief& relief) {
    ObjectBuilder tower("planned-tower", ObjectType::building, "Building");
    constexpr double kSide = 24.0;
    constexpr double kHeight = 70.0;
    const Vec2d centre = middle(site.block.corners);
    const Vec2d u = glm::normalize(site.block.corner(1) - site.block.corner(0));
    const std::vector<Vec2d> ring = rectangle(centre - (u + left_of(u)) * (0.5 * kSide), u, kSide, kSide);
    const double floor = relief.ground(centre);
    const double base = lowest_ground(relief, ring) - kFoundation;
    const Skin glass{Picture::glass, 0, kGlassPeriod, kGlassPeriod};
    add_base(tower, ring, base, glass);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d a = ring[i];
        const Vec2d b = ring[(i + 1) % 4];
        tower.add({lift(a, base), lift(b, base), lift(b, floor + kHeight), lift(a, floor + kHeight)},
                  wall_finish(SurfaceType::wall, id_of(Picture::glass), lift(a, floor), (b - a) / kSide,
                              1.0 / kGlassPeriod, 1.0 / kGlassPeriod));
    }
    add_face(tower, at_height(ring, floor + kHeight), SurfaceType::roof,
             {Picture::gravel, 0, kCobblePeriod, kCobblePeriod});
    tower.close_shell(Shell::Kind::outer);
    tower.object.attributes_json = R"({"function":"planned","measuredHeight":70.0,"storeysAboveGround":23})";
    return tower.take();
}

}  // namespace skybake::town
