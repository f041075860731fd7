#include "city/extrude.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>

namespace skybake {
namespace {

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x * b.y - a.y * b.x;
}

/// Twice the area, positive where the ring runs counter-clockwise.
double signed_area(std::span<const Vec2d> ring) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    return sum;
}

bool is_convex(std::span<const Vec2d> ring) {
    const double sign = signed_area(ring);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d& a = ring[i];
        const Vec2d& b = ring[(i + 1) % ring.size()];
        const Vec2d& c = ring[(i + 2) % ring.size()];
        if (cross(b - a, c - b) * sign <= 0.0) return false;
    }
    return true;
}

class Extruder {
  public:
    Extruder(const Footprint& footprint, Geometry& geometry) : footprint_(footprint), geometry_(geometry) {
        for (std::size_t r = 0; r < footprint.rings.size(); ++r) {
            std::vector<Vec2d> ring = footprint.rings[r];
            if ((signed_area(ring) > 0.0) != (r == 0)) std::reverse(ring.begin(), ring.end());
            rings_.push_back(std::move(ring));
        }
    }

    void run() {
        const RoofShape roof = fits(footprint_.roof, footprint_) ? footprint_.roof : RoofShape::flat;
        const double wall_top = roof == RoofShape::flat ? footprint_.ridge_m : footprint_.eaves_m;
        Shell shell;
        shell.kind = Shell::Kind::outer;
        shell.surface_begin = static_cast<std::uint32_t>(geometry_.surfaces.size());
        if (roof == RoofShape::gabled || roof == RoofShape::hipped) lay_ridge(roof);
        for (const std::vector<Vec2d>& ring : rings_) {
            low_.push_back(add_ring(ring, footprint_.base_m));
            high_.push_back(add_ring(ring, wall_top));
        }
        add_underside();
        add_walls(roof);
        add_roof(roof);
        shell.surface_end = static_cast<std::uint32_t>(geometry_.surfaces.size());
        geometry_.shells.push_back(shell);
    }

  private:
    double length(const Vec2d& v) const { return glm::length(v * footprint_.metres_per_unit); }

    std::uint32_t add_vertex(const Vec2d& p, double z) {
        geometry_.vertices.emplace_back(p, z);
        return static_cast<std::uint32_t>(geometry_.vertices.size() - 1);
    }
    std::vector<std::uint32_t> add_ring(std::span<const Vec2d> ring, double z) {
        std::vector<std::uint32_t> numbers;
        for (const Vec2d& p : ring) numbers.push_back(add_vertex(p, z));
        return numbers;
    }

    void begin_face(SurfaceType type) {
        Surface surface;
        surface.type = type;
        surface.ring_begin = static_cast<std::uint32_t>(geometry_.ring_first.size() - 1);
        surface.source_index = static_cast<std::uint32_t>(geometry_.surfaces.size());
        geometry_.surfaces.push_back(surface);
    }
    void add_face_ring(std::span<const std::uint32_t> ring) {
        geometry_.corners.insert(geometry_.corners.end(), ring.begin(), ring.end());
        geometry_.ring_first.push_back(static_cast<std::uint32_t>(geometry_.corners.size()));
        geometry_.surfaces.back().ring_end = static_cast<std::uint32_t>(geometry_.ring_first.size() - 1);
    }
    void add_face(SurfaceType type, std::initializer_list<std::uint32_t> ring) {
        begin_face(type);
        add_face_ring(std::span(ring.begin(), ring.size()));
    }

    /// Turns the four corners so that the ridge runs along sides 0-1 and 2-3, and places its ends.
    void lay_ridge(RoofShape roof) {
        std::vector<Vec2d>& p = rings_[0];
        const bool is_first_longer =
            length(p[1] - p[0]) + length(p[3] - p[2]) >= length(p[2] - p[1]) + length(p[0] - p[3]);
        if (is_first_longer == (footprint_.is_ridge_across && roof == RoofShape::gabled))
            std::rotate(p.begin(), p.begin() + 1, p.end());
        Vec2d begin = (p[3] + p[0]) * 0.5, end = (p[1] + p[2]) * 0.5;
        if (roof == RoofShape::hipped) {
            // Half the width from each end: the hips are as steep as the long sides. A square's meet in the middle,
            // almost.
            const double width = (length(p[0] - p[3]) + length(p[2] - p[1])) * 0.5;
            const double share = std::min(0.5 * width / std::max(length(end - begin), 1e-9), 0.49);
            const Vec2d along = end - begin;
            begin += share * along;
            end -= share * along;
        }
        ridge_ = {add_vertex(begin, footprint_.ridge_m), add_vertex(end, footprint_.ridge_m)};
    }

    void add_underside() {
        begin_face(SurfaceType::ground);
        for (std::vector<std::uint32_t> ring : low_) {
            std::reverse(ring.begin(), ring.end());
            add_face_ring(ring);
        }
    }

    void add_walls(RoofShape roof) {
        for (std::size_t r = 0; r < low_.size(); ++r) {
            const std::vector<std::uint32_t>&low = low_[r], &high = high_[r];
            for (std::size_t i = 0; i < low.size(); ++i) {
                const std::size_t j = (i + 1) % low.size();
                if (roof == RoofShape::gabled && i % 2 == 1) {
                    add_face(SurfaceType::wall, {low[i], low[j], high[j], ridge_[i == 1 ? 1 : 0], high[i]});
                } else {
                    add_face(SurfaceType::wall, {low[i], low[j], high[j], high[i]});
                }
            }
        }
    }

    void add_roof(RoofShape roof) {
        const std::vector<std::uint32_t>& t = high_[0];
        switch (roof) {
            case RoofShape::flat:
                begin_face(SurfaceType::roof);
                for (const std::vector<std::uint32_t>& ring : high_) add_face_ring(ring);
                return;
            case RoofShape::hipped:
                add_face(SurfaceType::roof, {t[1], t[2], ridge_[1]});
                add_face(SurfaceType::roof, {t[3], t[0], ridge_[0]});
                [[fallthrough]];
            case RoofShape::gabled:
                add_face(SurfaceType::roof, {t[0], t[1], ridge_[1], ridge_[0]});
                add_face(SurfaceType::roof, {t[2], t[3], ridge_[0], ridge_[1]});
                return;
            case RoofShape::pyramidal: {
                Vec2d middle(0.0);
                for (const Vec2d& p : rings_[0]) middle += p - rings_[0][0];
                const std::uint32_t top =
                    add_vertex(rings_[0][0] + middle / static_cast<double>(rings_[0].size()), footprint_.ridge_m);
                for (std::size_t i = 0; i < t.size(); ++i)
                    add_face(SurfaceType::roof, {t[i], t[(i + 1) % t.size()], top});
                return;
            }
        }
    }

    const Footprint& footprint_;
    Geometry& geometry_;
    std::vector<std::vector<Vec2d>> rings_;  // the outer one counter-clockwise, holes clockwise
    std::vector<std::vector<std::uint32_t>> low_, high_;
    std::array<std::uint32_t, 2> ridge_{};
};

}  // namespace

bool fits(RoofShape shape, const Footprint& footprint) {
    if (shape == RoofShape::flat) return true;
    if (footprint.rings.size() != 1 || !is_convex(footprint.rings[0])) return false;
    return shape == RoofShape::pyramidal || footprint.rings[0].size() == 4;
}

void extrude(const Footprint& footprint, Geometry& geometry) {
    Extruder(footprint, geometry).run();
}

}  // namespace skybake
