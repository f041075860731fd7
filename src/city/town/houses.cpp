#include "city/town/houses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

constexpr double kOverhang = 0.4;
constexpr double kTopPlaster = 0.3;  // wall between the uppermost storey and the eave

struct Style {
    std::uint64_t seed = 0;
    std::uint64_t key = 0;
    int storeys = 4;
    int facade = 0;
    int tiles = 0;
    double slope = 0.9;
    double base = 0.0;   // absolute
    double floor = 0.0;  // absolute
    double eave = 0.0;   // absolute

    double wall_height() const { return eave - floor; }
};

Vec3d lift(Vec2d p, double z) {
    return {p.x, p.y, z};
}

/// A wall with windows: whole bays over its length, storeys from the floor up. The second bay of three is the one with
/// the door.
Finish facade_finish(const Style& style, Vec2d from, Vec2d to) {
    const double length = glm::length(to - from);
    const double bays = std::max(1.0, std::round(length / kBayWidth));
    Finish finish = wall_finish(SurfaceType::wall, id_of(Picture::facade_first, style.facade), lift(from, style.floor),
                                (to - from) / length, bays / (kFacadeBays * length), 1.0 / kFacadeHeight);
    if (bays < 2) finish.frame.offset.x = 1.0 / kFacadeBays;  // a single bay is the door's
    return finish;
}

Finish plaster_finish(const Style& style, Vec2d from, Vec2d to) {
    return wall_finish(SurfaceType::wall, id_of(Picture::plaster_first, style.facade), lift(from, style.floor),
                       glm::normalize(to - from), 1.0 / kPlasterPeriod, 1.0 / kPlasterPeriod);
}

Finish level_finish(SurfaceType type, const Style& style) {
    return {type, id_of(Picture::plaster_first, style.facade), ground_frame(kPlasterPeriod)};
}

void add_wall(ObjectBuilder& builder, const Style& style, Vec2d from, Vec2d to, const Finish& finish) {
    builder.add({lift(from, style.base), lift(to, style.base), lift(to, style.eave), lift(from, style.eave)}, finish);
}

void add_footprint(ObjectBuilder& builder, const Style& style, const std::vector<Vec2d>& ring) {
    std::vector<Vec3d> down;
    for (auto p = ring.rbegin(); p != ring.rend(); ++p) down.push_back(lift(*p, style.base));
    builder.add(down, {}, level_finish(SurfaceType::ground, style));
}

/// Dormers in a row over the plane's eave and chimneys near its ridge, wherever there is room.
void furnish(ObjectBuilder& builder, RoofPlane& plane, const Style& style, double length, double ridge_y,
             std::uint64_t side) {
    const std::uint64_t key = hash_combine(style.key, side);
    if (side < 2 && draw(style.seed, key, 60) < 0.72) {
        const bool is_gabled = draw(style.seed, style.key, 61) < 0.7;
        const DormerShape shape{1.3, 1.3, is_gabled ? 0.6 : 0.0};
        const int count = std::clamp(static_cast<int>(length / draw(style.seed, key, 62, 2.6, 4.4)), 1, 4);
        for (int i = 0; i < count; ++i) {
            add_dormer(builder, plane, length * (i + 0.5) / count, kOverhang + 0.75, shape, style.facade, style.tiles);
        }
    }
    const int chimneys = draw_index(style.seed, key, 63, 3);
    for (int i = 0; i < chimneys; ++i) {
        const auto number = static_cast<std::uint64_t>(i);
        const double x = draw(style.seed, hash_combine(key, number), 64, 0.7, std::max(0.8, length - 0.7));
        add_chimney(builder, plane, x, ridge_y - draw(style.seed, hash_combine(key, number), 65, 0.75, 1.3), 0.9, 0.6,
                    0.95, style.facade);
    }
}

/// Ridge along the street; a hip of `hip0` or `hip1` metres at either end, or a gable where it is 0.
void add_row_house(ObjectBuilder& builder, const Style& style, const std::vector<Vec2d>& ring, double hip0,
                   double hip1) {
    const double w = glm::length(ring[1] - ring[0]);
    const double d = glm::length(ring[3] - ring[0]);
    const Vec2d u = (ring[1] - ring[0]) / w;
    const Vec2d v = (ring[3] - ring[0]) / d;
    const auto at = [&](double x, double y, double z) { return lift(ring[0] + u * x + v * y, z); };
    const double o = kOverhang;
    const double e = style.eave;
    const double ridge = e + style.slope * (0.5 * d + o);
    const double b = style.base;
    add_footprint(builder, style, ring);
    add_wall(builder, style, ring[0], ring[1], facade_finish(style, ring[0], ring[1]));
    add_wall(builder, style, ring[2], ring[3], facade_finish(style, ring[2], ring[3]));
    builder.add({at(0, -o, e), at(0, 0, e), at(w, 0, e), at(w, -o, e)}, level_finish(SurfaceType::ceiling, style));
    builder.add({at(0, d, e), at(0, d + o, e), at(w, d + o, e), at(w, d, e)},
                level_finish(SurfaceType::ceiling, style));
    const Finish left = plaster_finish(style, ring[3], ring[0]);
    const Finish right = plaster_finish(style, ring[1], ring[2]);
    const auto hip_finish = [&](Vec3d origin, Vec2d along, double run) {
        const Vec2d inward = left_of(along);
        const double rise = ridge - e;
        return Finish{SurfaceType::roof,
                      id_of(Picture::tiles_first, style.tiles),
                      {origin, Vec3d(along, 0.0) / kTilePeriod,
                       Vec3d(inward * run, rise) / (std::hypot(run, rise) * kTilePeriod), Vec2d(0.0)}};
    };
    if (hip0 > 0) {
        builder.add({at(0, d, b), at(0, 0, b), at(0, 0, e), at(0, d, e)}, left);
        builder.add({at(0, d + o, e), at(0, d, e), at(0, 0, e), at(0, -o, e), at(hip0, 0.5 * d, ridge)},
                    hip_finish(at(0, d + o, e), -v, hip0));
    } else {
        builder.add(
            {at(0, d, b), at(0, 0, b), at(0, 0, e), at(0, -o, e), at(0, 0.5 * d, ridge), at(0, d + o, e), at(0, d, e)},
            left);
    }
    if (hip1 > 0) {
        builder.add({at(w, 0, b), at(w, d, b), at(w, d, e), at(w, 0, e)}, right);
        builder.add({at(w, -o, e), at(w, 0, e), at(w, d, e), at(w, d + o, e), at(w - hip1, 0.5 * d, ridge)},
                    hip_finish(at(w, -o, e), v, hip1));
    } else {
        builder.add(
            {at(w, 0, b), at(w, d, b), at(w, d, e), at(w, d + o, e), at(w, 0.5 * d, ridge), at(w, -o, e), at(w, 0, e)},
            right);
    }
    const double half = 0.5 * d + o;
    RoofPlane front{ring[0] - v * o, u, v, e, style.slope, {{0, 0}, {w, 0}, {w - hip1, half}, {hip0, half}}, {}};
    RoofPlane back{ring[2] + v * o, -u, -v, e, style.slope, {{0, 0}, {w, 0}, {w - hip0, half}, {hip1, half}}, {}};
    furnish(builder, front, style, w, half, 0);
    furnish(builder, back, style, w, half, 2);
    add_plane(builder, front, id_of(Picture::tiles_first, style.tiles), kTilePeriod);
    add_plane(builder, back, id_of(Picture::tiles_first, style.tiles), kTilePeriod);
}

/// Gable to the street: the gable above the eaves is a face of its own, plain, so that no window is cut by the slope.
void add_gable_house(ObjectBuilder& builder, const Style& style, const std::vector<Vec2d>& ring) {
    const double w = glm::length(ring[1] - ring[0]);
    const double d = glm::length(ring[3] - ring[0]);
    const Vec2d u = (ring[1] - ring[0]) / w;
    const Vec2d v = (ring[3] - ring[0]) / d;
    const auto at = [&](double x, double y, double z) { return lift(ring[0] + u * x + v * y, z); };
    const double e = style.eave;
    const double ridge = e + style.slope * 0.5 * w;
    add_footprint(builder, style, ring);
    add_wall(builder, style, ring[0], ring[1], facade_finish(style, ring[0], ring[1]));
    add_wall(builder, style, ring[1], ring[2], plaster_finish(style, ring[1], ring[2]));
    add_wall(builder, style, ring[2], ring[3], facade_finish(style, ring[2], ring[3]));
    add_wall(builder, style, ring[3], ring[0], plaster_finish(style, ring[3], ring[0]));
    builder.add({at(0, 0, e), at(w, 0, e), at(0.5 * w, 0, ridge)}, plaster_finish(style, ring[0], ring[1]));
    builder.add({at(w, d, e), at(0, d, e), at(0.5 * w, d, ridge)}, plaster_finish(style, ring[2], ring[3]));
    RoofPlane left{ring[3], -v, u, e, style.slope, {{0, 0}, {d, 0}, {d, 0.5 * w}, {0, 0.5 * w}}, {}};
    RoofPlane right{ring[1], v, -u, e, style.slope, {{0, 0}, {d, 0}, {d, 0.5 * w}, {0, 0.5 * w}}, {}};
    furnish(builder, left, style, d, 0.5 * w, 2);
    furnish(builder, right, style, d, 0.5 * w, 3);
    add_plane(builder, left, id_of(Picture::tiles_first, style.tiles), kTilePeriod);
    add_plane(builder, right, id_of(Picture::tiles_first, style.tiles), kTilePeriod);
}

/// Two wings of one depth and one pitch along the two streets; they meet in a hip at the corner and a valley in the
/// court.
void add_corner_house(ObjectBuilder& builder, const Style& style, const std::vector<Vec2d>& ring) {
    const Vec2d a = ring[0];
    const Vec2d p = ring[1];
    const Vec2d b = ring[2];
    const Vec2d b_in = ring[3];
    const Vec2d q = ring[4];
    const Vec2d a_in = ring[5];
    const Vec2d u1 = glm::normalize(p - a);
    const Vec2d u2 = glm::normalize(b - p);
    const Vec2d v1 = left_of(u1);
    const Vec2d v2 = left_of(u2);
    const double depth = glm::length(b_in - b);
    const double o = kOverhang;
    const double e = style.eave;
    const double half = 0.5 * depth + o;
    const double ridge = e + style.slope * half;
    const Vec2d p_out = crossing(a - v1 * o, u1, b - v2 * o, u2);
    const Vec2d q_out = crossing(a_in + v1 * o, u1, b_in + v2 * o, u2);
    const Vec2d m = 0.5 * (p + q);  // where the ridges meet
    const Vec2d r1 = a + v1 * (0.5 * depth);
    const Vec2d r2 = b + v2 * (0.5 * depth);
    const Vec2d a_out = a - v1 * o;
    const Vec2d b_out = b - v2 * o;
    const Vec2d a_back = a_in + v1 * o;
    const Vec2d b_back = b_in + v2 * o;

    add_footprint(builder, style, ring);
    add_wall(builder, style, a, p, facade_finish(style, a, p));
    add_wall(builder, style, p, b, facade_finish(style, p, b));
    add_wall(builder, style, b_in, q, plaster_finish(style, b_in, q));
    add_wall(builder, style, q, a_in, plaster_finish(style, q, a_in));
    builder.add({lift(b, style.base), lift(b_in, style.base), lift(b_in, e), lift(b_back, e), lift(r2, ridge),
                 lift(b_out, e), lift(b, e)},
                plaster_finish(style, b, b_in));
    builder.add({lift(a_in, style.base), lift(a, style.base), lift(a, e), lift(a_out, e), lift(r1, ridge),
                 lift(a_back, e), lift(a_in, e)},
                plaster_finish(style, a_in, a));
    const Finish soffit = level_finish(SurfaceType::ceiling, style);
    builder.add({lift(a_out, e), lift(a, e), lift(p, e), lift(p_out, e)}, soffit);
    builder.add({lift(p_out, e), lift(p, e), lift(b, e), lift(b_out, e)}, soffit);
    builder.add({lift(b_back, e), lift(b_in, e), lift(q, e), lift(q_out, e)}, soffit);
    builder.add({lift(q_out, e), lift(q, e), lift(a_in, e), lift(a_back, e)}, soffit);

    const auto plane_along = [&](Vec2d origin, Vec2d u, std::initializer_list<Vec2d> outline) {
        RoofPlane plane{origin, u, left_of(u), e, style.slope, {}, {}};
        for (const Vec2d& c : outline)
            plane.outline.emplace_back(glm::dot(c - origin, u), glm::dot(c - origin, plane.v));
        return plane;
    };
    std::array<RoofPlane, 4> planes = {
        plane_along(a_out, u1, {a_out, p_out, m, r1}), plane_along(p_out, u2, {p_out, b_out, r2, m}),
        plane_along(b_back, -u2, {b_back, q_out, m, r2}), plane_along(q_out, -u1, {q_out, a_back, r1, m})};
    furnish(builder, planes[0], style, glm::length(p - a), half, 0);
    furnish(builder, planes[1], style, glm::length(b - p), half, 1);
    for (const RoofPlane& plane : planes)
        add_plane(builder, plane, id_of(Picture::tiles_first, style.tiles), kTilePeriod);
}

int storeys_of(std::uint64_t seed, const Cell& cell, std::uint64_t key, bool is_corner) {
    // Higher towards the square, lower towards the fields; a corner house likes to stand out.
    const double lean = std::clamp(0.25 - glm::length(cell.site) / 2500.0, -0.35, 0.25) + (is_corner ? 0.12 : 0.0);
    const double lot = draw(seed, key, 50) + lean;
    return lot < 0.33 ? 3 : lot < 0.86 ? 4 : 5;
}

}  // namespace

double lowest_ground(const Relief& relief, const std::vector<Vec2d>& ring) {
    double lowest = relief.ground(ring[0]);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d next = ring[(i + 1) % ring.size()];
        lowest = std::min({lowest, relief.ground(next), relief.ground(0.5 * (ring[i] + next))});
    }
    return lowest;
}

CityObject build_house(std::uint64_t seed, const Cell& cell, const Lot& lot, const Relief& relief) {
    Style style;
    style.seed = seed;
    style.key = hash_combine(cell.key, static_cast<std::uint64_t>(lot.number) + 0x1000);
    style.storeys = storeys_of(seed, cell, style.key, lot.is_corner());
    style.facade = draw_index(seed, style.key, 51, kFacadeColours);
    style.tiles = draw_index(seed, style.key, 52, kRoofTiles);
    style.slope = draw(seed, style.key, 53, 0.78, 1.06);
    const Vec2d door = lot.is_corner() ? lot.ring[1] : 0.5 * (lot.ring[0] + lot.ring[1]);
    style.floor = relief.ground(door);
    style.base = lowest_ground(relief, lot.ring) - kFoundation;
    style.eave = style.floor + kGroundStorey + (style.storeys - 1) * kStorey + kTopPlaster;

    ObjectBuilder builder(fmt::format("{}-house-{:02}", cell.name, lot.number + 1), ObjectType::building, "Building");
    const char* roof = "gable";
    double ridge = 0.0;
    if (lot.is_corner()) {
        add_corner_house(builder, style, lot.ring);
        ridge = style.eave + style.slope * (0.5 * glm::length(lot.ring[3] - lot.ring[2]) + kOverhang);
    } else {
        const double w = glm::length(lot.ring[1] - lot.ring[0]);
        const double d = glm::length(lot.ring[3] - lot.ring[0]);
        const double kind = draw(seed, style.key, 54);
        if (w < 8.6 && kind < 0.3) {
            add_gable_house(builder, style, lot.ring);
            ridge = style.eave + style.slope * 0.5 * w;
        } else {
            const bool is_hipped = w > 9.0 && kind > 0.8;
            const double hip = is_hipped ? std::min(0.36 * w, 0.5 * d) : 0.0;
            if (is_hipped) roof = "hipped";
            add_row_house(builder, style, lot.ring, hip, hip);
            ridge = style.eave + style.slope * (0.5 * d + kOverhang);
        }
    }
    builder.close_shell(Shell::Kind::outer);
    builder.object.attributes_json =
        fmt::format(R"({{"storeysAboveGround":{},"roofType":"{}","measuredHeight":{:.2f}}})", style.storeys, roof,
                    ridge - style.floor);
    return builder.take();
}

void add_free_house(ObjectBuilder& builder, const FreeHouse& house) {
    const Vec2d u = house.u;
    const Vec2d v = left_of(u);
    const double l = house.length;
    const double w = house.width;
    const double o = house.overhang;
    Style style;
    style.facade = house.facade;
    style.tiles = house.tiles;
    style.base = house.base;
    style.floor = house.floor;
    style.eave = house.floor + house.height;
    SKYBAKE_CHECK_LE(w, l);
    const std::vector<Vec2d> ring = {house.origin, house.origin + u * l, house.origin + u * l + v * w,
                                     house.origin + v * w};
    const std::vector<Vec2d> eaves = {ring[0] - (u + v) * o, ring[1] + (u - v) * o, ring[2] + (u + v) * o,
                                      ring[3] + (v - u) * o};
    add_footprint(builder, style, ring);
    const double half = 0.5 * w + o;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        add_wall(builder, style, ring[i], ring[next], facade_finish(style, ring[i], ring[next]));
        builder.add({lift(eaves[i], style.eave), lift(ring[i], style.eave), lift(ring[next], style.eave),
                     lift(eaves[next], style.eave)},
                    level_finish(SurfaceType::ceiling, style));
        const Vec2d along = glm::normalize(ring[next] - ring[i]);
        const double length = glm::length(eaves[next] - eaves[i]);
        RoofPlane plane{
            eaves[i], along, left_of(along), style.eave, house.slope, {{0, 0}, {length, 0}, {length - half, half}}, {}};
        if (length - 2 * half > 1e-6) plane.outline.emplace_back(half, half);
        add_plane(builder, plane, id_of(Picture::tiles_first, style.tiles), kTilePeriod);
    }
}

}  // namespace skybake::town
