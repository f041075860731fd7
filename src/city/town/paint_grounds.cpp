#include "city/town/paint_grounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "city/town/canvas.h"
#include "city/town/styles.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

constexpr int kPixels = 512;

Vec3f times(Vec3f colour, double factor) {
    return colour * static_cast<float>(factor);
}
Vec3f blend(Vec3f a, Vec3f b, double t) {
    return a + (b - a) * static_cast<float>(std::clamp(t, 0.0, 1.0));
}
double step_between(double lo, double hi, double v) {
    const double t = std::clamp((v - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Stones in level courses with joints staggered at random: `rows` courses in the picture's height, about `across`
/// stones in each. Returns the distance to the nearest joint in metres and the stone's hash.
struct Course {
    double to_joint = 0.0;
    std::uint64_t stone = 0;
};
Course course_at(std::uint64_t seed, double x, double y, double period, int rows, int across) {
    const double height = period / rows;
    const int row = std::min(rows - 1, static_cast<int>(y / height));
    const double pitch = period / across;
    const auto joint = [&](int k) {  // place of joint k of this row
        const int wrapped = ((k % across) + across) % across;
        const auto thing = hash_combine(static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(wrapped));
        return (k + draw(seed, thing, 1, -0.28, 0.28) + (row % 2 == 0 ? 0.0 : 0.5)) * pitch;
    };
    int k = static_cast<int>(std::floor(x / pitch)) - 2;
    while (joint(k + 1) <= x) ++k;
    const double across_joint = std::min(x - joint(k), joint(k + 1) - x);
    const double in_row = y - row * height;
    const int wrapped = ((k % across) + across) % across;
    return {std::min(across_joint, std::min(in_row, height - in_row)),
            hash_combine(static_cast<std::uint64_t>(row) + 77, static_cast<std::uint64_t>(wrapped))};
}

}  // namespace

NamedImage paint_tiles(std::uint64_t seed, int kind) {
    struct Clay {
        const char* name;
        Vec3f colour;
        double spread;
        double moss;
    };
    static const std::array<Clay, kRoofTiles> kClays = {{{"red", srgb(180, 98, 70), 0.16, 0.10},
                                                         {"brown", srgb(158, 98, 76), 0.20, 0.22},
                                                         {"old", srgb(170, 112, 88), 0.26, 0.38}}};
    const Clay& clay = kClays[static_cast<std::size_t>(kind)];
    const std::uint64_t key = hash_combine(seed, static_cast<std::uint64_t>(kind));
    // Plain tiles ("beaver tails"): round lower ends, each row half a tile aside.
    constexpr int kRows = 18;
    constexpr int kColumns = 16;
    const double tile = kTilePeriod / kColumns;
    const double course = kTilePeriod / kRows;
    Canvas canvas(kPixels, kPixels, kTilePeriod, kTilePeriod, clay.colour);
    canvas.each([&](double x, double y, Vec3f) {
        // A tile hangs from its own row's top over the row below: the pixel shows this row's tile, or between two round
        // ends the one below.
        int row = static_cast<int>(y / course);
        double v = y / course - row;  // 0 at the row's lower edge
        const auto column_of = [&](int r) { return static_cast<int>(std::floor(x / tile + (r % 2 == 0 ? 0.0 : 0.5))); };
        const auto across_of = [&](int r) {
            const double u = x / tile + (r % 2 == 0 ? 0.0 : 0.5);
            return u - std::floor(u) - 0.5;
        };
        double across = across_of(row);
        const double end =
            0.42 * (1.0 - std::sqrt(std::max(0.0, 1.0 - 4.0 * across * across)));  // the round end's height here
        double edge = v - end;
        if (edge < 0) {
            row = (row + kRows - 1) % kRows;
            across = across_of(row);
            v += 1.0;
            edge = 1.0;
        }
        const auto thing = hash_combine(static_cast<std::uint64_t>(row),
                                        static_cast<std::uint64_t>((column_of(row) + kColumns) % kColumns));
        Vec3f colour = times(clay.colour, 1.0 + clay.spread * draw(key, thing, 1, -1.0, 1.0));
        colour = blend(colour, srgb(118, 92, 80), 0.5 * step_between(0.82, 1.0, draw(key, thing, 2)));
        const double moss = cloud(key + 3, x / kTilePeriod * 5, y / kTilePeriod * 5, 5, 5);
        colour = blend(colour, srgb(104, 96, 78), clay.moss * step_between(-0.1, 0.7, moss));
        const double lip = 1.0 - 0.30 * (1.0 - step_between(0.0, 0.16, edge));        // shade at the round end
        const double side = 1.0 - 0.22 * step_between(0.42, 0.5, std::abs(across));   // joint between tiles
        const double under = 1.0 - 0.20 * step_between(0.75, 1.0, std::min(v, 1.0));  // under the row above
        const double grain = 1.0 + 0.05 * cloud(key + 5, x / kTilePeriod * 40, y / kTilePeriod * 40, 40, 40);
        return times(colour, lip * side * under * grain);
    });
    return canvas.take(fmt::format("tiles_{}.png", clay.name));
}

NamedImage paint_cobbles(std::uint64_t seed) {
    constexpr int kCells = 30;  // stones of 13 cm
    Canvas canvas(kPixels, kPixels, kCobblePeriod, kCobblePeriod, srgb(128, 124, 118));
    canvas.each([&](double x, double y, Vec3f base) {
        const double u = x / kCobblePeriod;
        const double v = y / kCobblePeriod;
        const Stones s = stones_at(seed, u * kCells, v * kCells, kCells, kCells, 0.55);
        const double joint = step_between(0.05, 0.2, s.second - s.nearest);
        Vec3f colour = times(base, 1.0 + 0.17 * draw(seed, s.stone, 5, -1.0, 1.0));
        colour = blend(colour, srgb(140, 126, 110), 0.6 * draw(seed, s.stone, 6));
        colour = times(colour, 1.06 - 0.35 * s.nearest * s.nearest);  // a little domed
        colour = blend(srgb(86, 82, 76), colour, joint);
        return times(colour, 1.0 + 0.12 * cloud(seed + 4, u * 4, v * 4, 4, 4));
    });
    return canvas.take("cobbles.png");
}

NamedImage paint_slabs(std::uint64_t seed) {
    Canvas canvas(kPixels, kPixels, kCobblePeriod, kCobblePeriod, srgb(146, 140, 131));
    canvas.each([&](double x, double y, Vec3f base) {
        const Course c = course_at(seed, x, y, kCobblePeriod, 8, 5);
        Vec3f colour = times(base, 1.0 + 0.12 * draw(seed, c.stone, 2, -1.0, 1.0));
        colour = blend(colour, srgb(152, 138, 120), 0.5 * draw(seed, c.stone, 3));
        colour = blend(srgb(98, 94, 88), colour, step_between(0.006, 0.022, c.to_joint));
        return times(colour, 1.0 + 0.10 * cloud(seed + 4, x / kCobblePeriod * 6, y / kCobblePeriod * 6, 6, 6));
    });
    return canvas.take("slabs.png");
}

NamedImage paint_gravel(std::uint64_t seed) {
    constexpr int kCells = 90;
    Canvas canvas(kPixels, kPixels, kCobblePeriod, kCobblePeriod, srgb(146, 136, 120));
    canvas.each([&](double x, double y, Vec3f base) {
        const double u = x / kCobblePeriod;
        const double v = y / kCobblePeriod;
        const Stones s = stones_at(seed, u * kCells, v * kCells, kCells, kCells, 0.9);
        const double worn = cloud(seed + 4, u * 5, v * 5, 5, 5);
        return times(
            base, (1.0 + 0.16 * draw(seed, s.stone, 5, -1.0, 1.0)) * (1.04 - 0.18 * s.nearest) * (1.0 + 0.14 * worn));
    });
    return canvas.take("gravel.png");
}

NamedImage paint_grass(std::uint64_t seed) {
    Canvas canvas(kPixels, kPixels, kGrassPeriod, kGrassPeriod, srgb(92, 112, 56));
    canvas.each([&](double x, double y, Vec3f base) {
        const double u = x / kGrassPeriod;
        const double v = y / kGrassPeriod;
        const double patch = cloud(seed, u * 5, v * 5, 5, 5);
        const double tuft = cloud(seed + 5, u * 32, v * 32, 32, 32);
        const double blade = lattice_noise(seed + 9, u * 256, v * 170, 256, 170);
        const Vec3f colour = blend(base, srgb(116, 120, 66), 0.22 * step_between(-0.3, 0.7, patch));
        return times(colour, 1.0 + 0.16 * tuft + 0.13 * blade);
    });
    return canvas.take("grass.png");
}

NamedImage paint_water(std::uint64_t seed) {
    Canvas canvas(kPixels, kPixels, kWaterPeriod, kWaterPeriod, srgb(66, 86, 82));
    canvas.each([&](double x, double y, Vec3f base) {
        const double u = x / kWaterPeriod;
        const double v = y / kWaterPeriod;
        const double bend = 0.35 * cloud(seed, u * 3, v * 3, 3, 3);
        const double ripple = cloud(seed + 3, u * 16 + bend, v * 7, 16, 7);
        return blend(times(base, 1.0 + 0.16 * ripple), srgb(104, 122, 120), 0.5 * step_between(0.25, 0.7, ripple));
    });
    return canvas.take("water.png");
}

NamedImage paint_masonry(std::uint64_t seed) {
    Canvas canvas(kPixels, kPixels, kMasonryPeriod, kMasonryPeriod, srgb(162, 150, 130));
    canvas.each([&](double x, double y, Vec3f base) {
        const double wave = 0.03 * cloud(seed + 8, x / kMasonryPeriod * 6, y / kMasonryPeriod * 6, 6, 6);
        const double yy = std::fmod(y + wave + kMasonryPeriod, kMasonryPeriod);
        const Course c = course_at(seed, x, yy, kMasonryPeriod, 12, 7);
        Vec3f colour = times(base, 1.0 + 0.17 * draw(seed, c.stone, 2, -1.0, 1.0));
        colour = blend(colour, srgb(138, 132, 124), draw(seed, c.stone, 3));
        colour = blend(srgb(126, 118, 104), colour, step_between(0.008, 0.035, c.to_joint));
        return times(colour, 1.0 + 0.16 * cloud(seed + 4, x / kMasonryPeriod * 10, y / kMasonryPeriod * 10, 10, 10));
    });
    return canvas.take("masonry.png");
}

NamedImage paint_copper(std::uint64_t seed) {
    Canvas canvas(256, 256, kCopperPeriod, kCopperPeriod, srgb(112, 156, 134));
    canvas.each([&](double x, double y, Vec3f base) {
        const double u = x / kCopperPeriod;
        const double v = y / kCopperPeriod;
        const double streak = cloud(seed, u * 12, v * 2, 12, 2);
        const double seam = std::abs(std::fmod(x, 0.6) - 0.3);
        const Vec3f colour = blend(base, srgb(92, 104, 86), 0.8 * step_between(0.1, 0.8, streak));
        return times(colour, seam < 0.02 ? 0.78 : seam < 0.04 ? 1.12 : 1.0);
    });
    return canvas.take("copper.png");
}

}  // namespace skybake::town
