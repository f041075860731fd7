#include "city/town/canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/hash_rng.h"

namespace skybake::town {
namespace {

int wrapped(int i, int n) {
    return ((i % n) + n) % n;
}

std::uint64_t lattice_hash(int x, int y, int cells_x, int cells_y) {
    return mix64(static_cast<std::uint64_t>(wrapped(x, cells_x)) * 0x9e3779b97f4a7c15ULL +
                 static_cast<std::uint64_t>(wrapped(y, cells_y)) * 0xc2b2ae3d27d4eb4fULL);
}

/// Uniform in [0, 1) from one mixing of bits: a picture asks for tens of millions, which hash_rng's four would make
/// slow.
double quick_draw(std::uint64_t seed, std::uint64_t thing) {
    return static_cast<double>(mix64(thing + seed * 0x9e3779b97f4a7c15ULL) >> 40) * 0x1p-24;
}

}  // namespace

Canvas::Canvas(int width, int height, double width_m, double height_m, Vec3f colour)
    : width_(width),
      height_(height),
      width_m_(width_m),
      height_m_(height_m),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), colour) {}

Vec3f& Canvas::at(int column, int row) {
    const int from_top = height_ - 1 - wrapped(row, height_);
    return pixels_[static_cast<std::size_t>(from_top) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(wrapped(column, width_))];
}

void Canvas::rectangle(double x0, double y0, double x1, double y1, Vec3f colour, double opacity) {
    const double sx = width_ / width_m_;
    const double sy = height_ / height_m_;
    const auto overlap = [](double lo, double hi, int i) {
        return std::clamp(std::min(hi, i + 1.0) - std::max(lo, i * 1.0), 0.0, 1.0);
    };
    for (int row = static_cast<int>(std::floor(y0 * sy)); row < y1 * sy; ++row) {
        const double cover_y = overlap(y0 * sy, y1 * sy, row);
        for (int column = static_cast<int>(std::floor(x0 * sx)); column < x1 * sx; ++column) {
            const auto cover = static_cast<float>(opacity * cover_y * overlap(x0 * sx, x1 * sx, column));
            Vec3f& pixel = at(column, row);
            pixel += (colour - pixel) * cover;
        }
    }
}

void Canvas::shape(double x0, double y0, double x1, double y1, Vec3f colour,
                   const std::function<double(double, double)>& coverage) {
    const double px = width_m_ / width_;
    const double py = height_m_ / height_;
    for (int row = static_cast<int>(std::floor(y0 / py)); row * py < y1; ++row) {
        for (int column = static_cast<int>(std::floor(x0 / px)); column * px < x1; ++column) {
            double sum = 0.0;  // 4 × 4 places a pixel
            for (int k = 0; k < 16; ++k)
                sum += coverage((column + (k % 4 + 0.5) / 4) * px, (row + (k / 4 + 0.5) / 4) * py);
            Vec3f& pixel = at(column, row);
            pixel += (colour - pixel) * static_cast<float>(sum / 16.0);
        }
    }
}

void Canvas::each(const std::function<Vec3f(double, double, Vec3f)>& paint) {
    for (int row = 0; row < height_; ++row) {
        for (int column = 0; column < width_; ++column) {
            Vec3f& pixel = at(column, row);
            pixel = paint((column + 0.5) * width_m_ / width_, (row + 0.5) * height_m_ / height_, pixel);
        }
    }
}

NamedImage Canvas::take(std::string name) const {
    NamedImage image{std::move(name), width_, height_, {}};
    image.pixels.reserve(pixels_.size() * 3);
    for (const Vec3f& p : pixels_) {
        for (int c = 0; c < 3; ++c)
            image.pixels.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(p[c], 0.0f, 1.0f) * 255.0f)));
    }
    return image;
}

double lattice_noise(std::uint64_t seed, double x, double y, int cells_x, int cells_y) {
    const int ix = static_cast<int>(std::floor(x));
    const int iy = static_cast<int>(std::floor(y));
    const auto ease = [](double t) { return t * t * (3 - 2 * t); };
    const double u = ease(x - ix);
    const double v = ease(y - iy);
    const auto value = [&](int dx, int dy) {
        return 2.0 * quick_draw(seed, lattice_hash(ix + dx, iy + dy, cells_x, cells_y)) - 1.0;
    };
    return (value(0, 0) * (1 - u) + value(1, 0) * u) * (1 - v) + (value(0, 1) * (1 - u) + value(1, 1) * u) * v;
}

double cloud(std::uint64_t seed, double x, double y, int cells_x, int cells_y) {
    double sum = 0.0;
    double weight = 0.53;  // halves each time: the four add up to 1
    for (int octave = 0; octave < 4; ++octave, weight *= 0.5) {
        const int scale = 1 << octave;
        sum += weight * lattice_noise(seed + static_cast<std::uint64_t>(octave), x * scale, y * scale, cells_x * scale,
                                      cells_y * scale);
    }
    return sum;
}

Stones stones_at(std::uint64_t seed, double x, double y, int cells_x, int cells_y, double jitter) {
    Stones found{1e9, 1e9, 0};
    const int ix = static_cast<int>(std::floor(x));
    const int iy = static_cast<int>(std::floor(y));
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const std::uint64_t h = lattice_hash(ix + dx, iy + dy, cells_x, cells_y);
            const double px = ix + dx + 0.5 + jitter * (quick_draw(seed, h) - 0.5);
            const double py = iy + dy + 0.5 + jitter * (quick_draw(seed + 1, h) - 0.5);
            const double d = std::hypot(px - x, py - y);
            if (d < found.nearest) {
                found.second = std::exchange(found.nearest, d);
                found.stone = h;
            } else {
                found.second = std::min(found.second, d);
            }
        }
    }
    return found;
}

}  // namespace skybake::town
