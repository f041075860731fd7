// A picture to paint on, measured in metres, that repeats without seams: what leaves on one side comes in on the other.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "city/town/town.h"

namespace skybake::town {

/// An sRGB-encoded colour, 0 … 1, from the usual 0 … 255.
constexpr Vec3f srgb(int r, int g, int b) {
    return {static_cast<float>(r) / 255.0f, static_cast<float>(g) / 255.0f, static_cast<float>(b) / 255.0f};
}

class Canvas {
  public:
    Canvas(int width, int height, double width_m, double height_m, Vec3f colour);

    /// Rectangle from (x0, y0) to (x1, y1), metres from the lower left; edges are antialiased by area.
    void rectangle(double x0, double y0, double x1, double y1, Vec3f colour, double opacity = 1.0);
    /// Any shape: `coverage` tells for a place in metres how much of it the colour covers, 0 … 1. Called for places in
    /// the box only.
    void shape(double x0, double y0, double x1, double y1, Vec3f colour,
               const std::function<double(double, double)>& coverage);
    /// Each pixel anew, from its place in metres and its colour.
    void each(const std::function<Vec3f(double, double, Vec3f)>& paint);

    double pixel_m() const { return width_m_ / width_; }
    NamedImage take(std::string name) const;

  private:
    Vec3f& at(int column, int row);
    int width_;
    int height_;
    double width_m_;
    double height_m_;
    std::vector<Vec3f> pixels_;
};

/// Smooth noise in -1 … 1 that repeats after `cells` lattice cells in x and y; x and y in cells.
double lattice_noise(std::uint64_t seed, double x, double y, int cells_x, int cells_y);
/// Four octaves of it, in -1 … 1.
double cloud(std::uint64_t seed, double x, double y, int cells_x, int cells_y);

/// The two nearest of jittered points, one a lattice cell, repeating like lattice_noise. Based on: S. Worley, "A
/// cellular texture basis function", SIGGRAPH 1996.
struct Stones {
    double nearest = 0.0;  // distances in cells
    double second = 0.0;
    std::uint64_t stone = 0;  // the nearest point's hash
};
Stones stones_at(std::uint64_t seed, double x, double y, int cells_x, int cells_y, double jitter);

}  // namespace skybake::town
