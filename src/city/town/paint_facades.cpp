#include "city/town/paint_facades.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "city/town/canvas.h"
#include "city/town/styles.h"
#include "city/town/town_random.h"

namespace skybake::town {
namespace {

enum class Crown { straight, gable, arch, none };  // what stands over the first floor's windows

/// How the houses of one colour look.
struct Design {
    const char* name;
    Vec3f plaster;
    Vec3f trim;
    Crown crown;
    bool has_shutters;
    bool is_rusticated;  // grooves across the ground storey
    Vec3f wood;
};

const std::array<Design, kFacadeColours> kDesigns = {{
    {"ochre", srgb(214, 178, 112), srgb(236, 226, 204), Crown::gable, false, true, srgb(84, 58, 40)},
    {"cream", srgb(226, 214, 186), srgb(204, 186, 150), Crown::straight, false, true, srgb(52, 66, 52)},
    {"rose", srgb(214, 164, 144), srgb(238, 228, 214), Crown::arch, false, false, srgb(92, 60, 44)},
    {"green", srgb(176, 190, 156), srgb(234, 230, 214), Crown::none, true, false, srgb(70, 52, 40)},
    {"grey", srgb(192, 190, 184), srgb(224, 220, 210), Crown::straight, false, true, srgb(60, 48, 42)},
    {"yellow", srgb(232, 206, 132), srgb(244, 236, 216), Crown::gable, true, false, srgb(66, 78, 58)},
}};

const Vec3f kGlassDark = srgb(52, 60, 68);
const Vec3f kGlassSky = srgb(104, 122, 138);
const Vec3f kFrame = srgb(226, 222, 212);

void weather(Canvas& canvas, std::uint64_t seed, double width, double height, double strength) {
    const int columns = std::max(1, static_cast<int>(std::lround(width / 1.3)));
    const int rows = std::max(1, static_cast<int>(std::lround(height / 1.3)));
    canvas.each([&](double x, double y, Vec3f colour) {
        const double u = x / width * columns;
        const double v = y / height * rows;
        const double blotch = cloud(seed, u, v, columns, rows);
        const double streak = lattice_noise(seed + 9, u * 8, v * 0.5, columns * 8, std::max(1, rows / 2));
        return colour * static_cast<float>(1.0 + strength * (0.75 * blotch + 0.25 * streak));
    });
}

void arch(Canvas& canvas, double centre, double y0, double half, double spring, Vec3f colour) {
    canvas.shape(centre - half, y0, centre + half, spring + half, colour, [=](double x, double y) {
        return y < spring ? (std::abs(x - centre) <= half ? 1.0 : 0.0)
                          : (std::hypot(x - centre, y - spring) <= half ? 1.0 : 0.0);
    });
}

/// Panes behind a cross of wood; each storey and bay reflects a different bit of sky.
void window(Canvas& canvas, std::uint64_t thing, double x0, double y0, double x1, double y1) {
    canvas.rectangle(x0 - 0.03, y0, x1 + 0.03, y1 + 0.03, srgb(70, 66, 62));
    const auto shine = static_cast<float>(draw(thing, 1, 1, 0.15, 0.75));
    const Vec3f sky = kGlassDark + (kGlassSky - kGlassDark) * shine;
    for (int k = 0; k < 12; ++k) {
        const double a = y0 + (y1 - y0) * k / 12;
        const double b = y0 + (y1 - y0) * (k + 1) / 12;
        canvas.rectangle(x0, a, x1, b, kGlassDark + (sky - kGlassDark) * (static_cast<float>(k) / 11.0f));
    }
    if (draw(thing, 2, 1) < 0.5) {  // curtains
        canvas.rectangle(x0 + 0.05, y0, x0 + 0.22, y1, srgb(190, 186, 178), 0.55);
        canvas.rectangle(x1 - 0.22, y0, x1 - 0.05, y1, srgb(190, 186, 178), 0.55);
    }
    const double t = 0.05;
    const double middle = 0.5 * (x0 + x1);
    const double transom = y0 + 0.66 * (y1 - y0);
    canvas.rectangle(x0, y0, x0 + t, y1, kFrame);
    canvas.rectangle(x1 - t, y0, x1, y1, kFrame);
    canvas.rectangle(x0, y0, x1, y0 + t, kFrame);
    canvas.rectangle(x0, y1 - t, x1, y1, kFrame);
    canvas.rectangle(middle - 0.5 * t, y0, middle + 0.5 * t, y1, kFrame);
    canvas.rectangle(x0, transom - 0.5 * t, x1, transom + 0.5 * t, kFrame);
}

void upper_window(Canvas& canvas, const Design& design, std::uint64_t thing, double centre, double floor, int storey) {
    const double half = 0.52;
    const double sill = floor + 0.85;
    const double top = floor + (storey >= 4 ? 2.3 : 2.55);
    const Vec3f shadow = design.plaster * 0.72f;
    canvas.rectangle(centre - half - 0.16, sill - 0.05, centre + half + 0.16, top + 0.16, design.trim);
    window(canvas, thing, centre - half, sill, centre + half, top);
    canvas.rectangle(centre - half - 0.24, sill - 0.24, centre + half + 0.24, sill - 0.12, shadow, 0.6);
    canvas.rectangle(centre - half - 0.24, sill - 0.14, centre + half + 0.24, sill, design.trim * 0.96f);
    if (design.has_shutters) {
        const Vec3f green = srgb(82, 104, 76);
        for (const double side : {-1.0, 1.0}) {
            const double inner = centre + side * (half + 0.06);
            const double outer = inner + side * 0.46;
            const double lo = std::min(inner, outer);
            const double hi = std::max(inner, outer);
            canvas.rectangle(lo, sill, hi, top, green * 0.8f);
            for (double y = sill + 0.08; y < top - 0.1; y += 0.11)
                canvas.rectangle(lo + 0.05, y, hi - 0.05, y + 0.06, green);
        }
    }
    if (storey > 2) return;
    const double base = top + 0.22;
    switch (design.crown) {
        case Crown::straight:
            canvas.rectangle(centre - half - 0.28, base, centre + half + 0.28, base + 0.15, design.trim);
            canvas.rectangle(centre - half - 0.28, base - 0.05, centre + half + 0.28, base, shadow, 0.7);
            break;
        case Crown::gable:
            canvas.shape(centre - half - 0.32, base, centre + half + 0.32, base + 0.42, design.trim,
                         [=](double x, double y) {
                             return (y - base) < 0.40 * (1.0 - std::abs(x - centre) / (half + 0.32)) ? 1.0 : 0.0;
                         });
            canvas.rectangle(centre - half - 0.3, base - 0.05, centre + half + 0.3, base, shadow, 0.7);
            break;
        case Crown::arch: {
            const double radius = 0.95;
            canvas.shape(
                centre - half - 0.3, base, centre + half + 0.3, base + 0.45, design.trim,
                [=](double x, double y) { return std::hypot(x - centre, y - (base - 0.55)) < radius ? 1.0 : 0.0; });
            canvas.rectangle(centre - half - 0.28, base - 0.05, centre + half + 0.28, base, shadow, 0.7);
            break;
        }
        case Crown::none:
            break;
    }
}

void shop(Canvas& canvas, const Design& design, std::uint64_t thing, double centre) {
    arch(canvas, centre, 0.0, 1.06, 2.15, design.trim);
    arch(canvas, centre, 0.42, 0.92, 2.15, design.wood);
    arch(canvas, centre, 0.55, 0.83, 2.15,
         kGlassDark + (kGlassSky - kGlassDark) * static_cast<float>(draw(thing, 3, 1, 0.1, 0.5)));
    canvas.rectangle(centre - 0.03, 0.55, centre + 0.03, 2.95, design.wood);
    canvas.rectangle(centre - 0.85, 2.1, centre + 0.85, 2.18, design.wood);
    // Goods behind the pane, as blurred colours.
    for (int k = 0; k < 6; ++k) {
        const auto n = static_cast<std::uint64_t>(k);
        const double x = centre - 0.75 + 0.25 * k;
        const Vec3f colour =
            srgb(90 + draw_index(thing, n, 4, 80), 70 + draw_index(thing, n, 5, 60), 60 + draw_index(thing, n, 6, 50));
        canvas.rectangle(x + 0.03, 0.58, x + 0.2, 0.58 + draw(thing, n, 7, 0.25, 0.8), colour, 0.55);
    }
}

void door(Canvas& canvas, const Design& design, double centre) {
    arch(canvas, centre, 0.0, 0.98, 2.25, design.trim * 0.94f);
    arch(canvas, centre, 0.0, 0.76, 2.25, design.wood * 0.75f);
    arch(canvas, centre, 2.3, 0.66, 2.25, kGlassDark);
    for (const double x : {centre - 0.66, centre + 0.08}) {
        for (const double y : {0.2, 1.0, 1.65}) canvas.rectangle(x, y, x + 0.58, y + 0.55, design.wood * 1.15f);
    }
    canvas.rectangle(centre - 0.76, 2.2, centre + 0.76, 2.32, design.wood);
    canvas.rectangle(centre - 0.015, 0.0, centre + 0.015, 2.2, design.wood * 0.5f);
}

}  // namespace

NamedImage paint_facade(std::uint64_t seed, int colour) {
    const Design& design = kDesigns[static_cast<std::size_t>(colour)];
    const double width = kFacadeBays * kBayWidth;
    const std::uint64_t key = hash_combine(seed, static_cast<std::uint64_t>(colour));
    Canvas canvas(512, 1024, width, kFacadeHeight, design.plaster);
    const Vec3f groove = design.plaster * 0.8f;
    if (design.is_rusticated) {
        const Vec3f ground_colour = design.plaster * 0.94f;
        canvas.rectangle(0, 0, width, kGroundStorey - 0.3, ground_colour);
        for (double y = 0.7; y < kGroundStorey - 0.4; y += 0.42) {
            canvas.rectangle(0, y, width, y + 0.045, groove);
            const double shift = std::fmod(std::round(y / 0.42), 2.0) * 0.65;
            for (int k = 0; k < 6; ++k) canvas.rectangle(k * 1.3 + shift, y, k * 1.3 + shift + 0.04, y + 0.42, groove);
        }
    }
    canvas.rectangle(0, 0, width, 0.55, srgb(150, 142, 130));
    canvas.rectangle(0, 0.53, width, 0.58, srgb(120, 114, 104));
    shop(canvas, design, hash_combine(key, 1), 0.5 * kBayWidth);
    door(canvas, design, 1.5 * kBayWidth);
    shop(canvas, design, hash_combine(key, 2), 2.5 * kBayWidth);
    for (int storey = 1; storey <= 4; ++storey) {
        const double floor = kGroundStorey + (storey - 1) * kStorey;
        for (int bay = 0; bay < kFacadeBays; ++bay) {
            const std::uint64_t thing = hash_combine(key, static_cast<std::uint64_t>(storey * 8 + bay + 16));
            upper_window(canvas, design, thing, (bay + 0.5) * kBayWidth, floor, storey);
        }
        const bool is_first = storey == 1;
        if (is_first || design.is_rusticated) {
            const double h = is_first ? 0.22 : 0.12;
            canvas.rectangle(0, floor - 0.06 - h, width, floor - h, design.plaster * 0.74f, 0.7);
            canvas.rectangle(0, floor - h, width, floor, design.trim);
        }
    }
    weather(canvas, key, width, kFacadeHeight, 0.09);
    return canvas.take(fmt::format("facade_{}.png", design.name));
}

NamedImage paint_plaster(std::uint64_t seed, int colour) {
    const Design& design = kDesigns[static_cast<std::size_t>(colour)];
    const std::uint64_t key = hash_combine(seed, static_cast<std::uint64_t>(colour) + 100);
    Canvas canvas(256, 256, kPlasterPeriod, kPlasterPeriod, design.plaster);
    weather(canvas, key, kPlasterPeriod, kPlasterPeriod, 0.13);
    return canvas.take(fmt::format("plaster_{}.png", design.name));
}

NamedImage paint_church(std::uint64_t seed) {
    const Vec3f plaster = srgb(232, 210, 150);
    const Vec3f trim = srgb(240, 234, 220);
    Canvas canvas(256, 1024, kChurchBay, kChurchHeight, plaster);
    canvas.rectangle(-0.45, 0, 0.45, kChurchHeight, trim);  // a pilaster, half on either side of the seam
    canvas.rectangle(-0.55, 12.0, 0.55, 12.5, trim * 0.92f);
    canvas.rectangle(0, 0, kChurchBay, 1.0, srgb(158, 150, 138));
    canvas.rectangle(0, 0.97, kChurchBay, 1.03, srgb(120, 114, 104));
    const double centre = 0.5 * kChurchBay;
    arch(canvas, centre, 3.0, 1.05, 9.3, trim);
    arch(canvas, centre, 3.3, 0.8, 9.3, srgb(48, 54, 62));
    for (int k = -1; k <= 1; ++k)
        canvas.rectangle(centre + 0.4 * k - 0.02, 3.3, centre + 0.4 * k + 0.02, 9.9, srgb(112, 108, 100));
    for (double y = 3.9; y < 10.0; y += 0.6)
        canvas.rectangle(centre - 0.78, y, centre + 0.78, y + 0.035, srgb(112, 108, 100));
    canvas.rectangle(centre - 1.2, 2.75, centre + 1.2, 3.0, trim * 0.95f);
    canvas.rectangle(0, 12.5, kChurchBay, 13.0, trim);
    canvas.rectangle(0, 15.6, kChurchBay, 16.0, trim * 0.97f);
    weather(canvas, seed, kChurchBay, kChurchHeight, 0.08);
    return canvas.take("church.png");
}

NamedImage paint_clock(std::uint64_t seed) {
    constexpr double kSide = 8.5;
    const double c = 0.5 * kSide;
    Canvas canvas(512, 512, kSide, kSide, srgb(226, 216, 196));
    weather(canvas, seed, kSide, kSide, 0.1);
    const auto disc = [&](double radius, Vec3f colour) {
        canvas.shape(c - radius, c - radius, c + radius, c + radius, colour,
                     [=](double x, double y) { return std::hypot(x - c, y - c) <= radius ? 1.0 : 0.0; });
    };
    disc(3.1, srgb(92, 70, 44));
    disc(2.95, srgb(238, 234, 222));
    disc(2.2, srgb(228, 222, 206));
    const auto bar = [&](double angle, double from, double to, double half, Vec3f colour) {
        const double dx = std::sin(angle);
        const double dy = std::cos(angle);
        canvas.shape(c - 3, c - 3, c + 3, c + 3, colour, [=](double x, double y) {
            const double along = (x - c) * dx + (y - c) * dy;
            return along >= from && along <= to && std::abs((x - c) * dy - (y - c) * dx) <= half ? 1.0 : 0.0;
        });
    };
    const Vec3f ink = srgb(46, 40, 36);
    for (int k = 0; k < 12; ++k) bar(2 * kPi * k / 12, 2.32, 2.8, k % 3 == 0 ? 0.12 : 0.07, ink);
    const Vec3f gold = srgb(150, 112, 44);
    bar(2 * kPi * 10.15 / 12, -0.4, 2.5, 0.1, gold);  // ten past ten; in Graz the long hand shows the hours
    bar(2 * kPi * 2.0 / 12, -0.4, 1.7, 0.12, gold);
    disc(0.25, gold);
    return canvas.take("clock.png");
}

NamedImage paint_glass(std::uint64_t seed) {
    Canvas canvas(256, 256, kGlassPeriod, kGlassPeriod, srgb(150, 152, 154));
    for (int bay = 0; bay < 2; ++bay) {
        for (int storey = 0; storey < 2; ++storey) {
            const std::uint64_t thing = hash_combine(seed, static_cast<std::uint64_t>(bay * 2 + storey));
            const double x = bay * 3.0;
            const double y = storey * 3.0;
            const Vec3f pane = kGlassDark + (kGlassSky - kGlassDark) * static_cast<float>(draw(thing, 1, 1, 0.3, 0.9));
            canvas.rectangle(x + 0.12, y + 0.75, x + 1.46, y + 2.85, pane);
            canvas.rectangle(x + 1.54, y + 0.75, x + 2.88, y + 2.85, pane * 0.94f);
            canvas.rectangle(x, y + 0.0, x + 3.0, y + 0.06, srgb(110, 112, 114));
        }
    }
    weather(canvas, seed, kGlassPeriod, kGlassPeriod, 0.04);
    return canvas.take("glass.png");
}

}  // namespace skybake::town
