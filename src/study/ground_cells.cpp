#include "study/ground_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"

namespace skybake {
namespace {

/// Cells of the lattice are visited in blocks of 4 × 4, so that a packet holds neighbours.
constexpr int kBlock = 4;

template <typename Visit>
void for_blocks(const GroundHeights& ground, const Visit& visit) {
    for (int block_row = 0; block_row < ground.rows; block_row += kBlock) {
        for (int block_column = 0; block_column < ground.columns; block_column += kBlock) {
            for (int r = block_row; r < std::min(block_row + kBlock, ground.rows); ++r) {
                for (int c = block_column; c < std::min(block_column + kBlock, ground.columns); ++c) visit(c, r);
            }
        }
    }
}

void begin_receiver(ReceiverSet& set, ReceiverKind kind, const std::string& id) {
    Receiver receiver;
    receiver.id = id;
    receiver.kind = kind;
    receiver.sample_begin = receiver.sample_end = static_cast<std::uint32_t>(set.samples.size());
    set.receivers.push_back(std::move(receiver));
}

/// Samples on the cells of the lattice for which `is_wanted(centre)` and which have ground.
template <typename IsWanted>
void add_lattice(ReceiverSet& set, const GroundHeights& ground, const ReceiverOptions& options,
                 const IsWanted& is_wanted) {
    const double cell = options.cell_m;
    for_blocks(ground, [&](int c, int r) {
        const double z = ground.height_m[static_cast<std::size_t>(r) * ground.columns + c];
        const Vec2d centre((static_cast<double>(ground.first_column + c) + 0.5) * cell,
                           (static_cast<double>(ground.first_row + r) + 0.5) * cell);
        if (std::isnan(z) || !is_wanted(centre)) return;
        Sample sample;
        sample.position = {centre, z + options.height_m};
        sample.area_m2 = static_cast<float>(cell * cell);
        sample.corner = Vec3f(-0.5 * cell, -0.5 * cell, 0.0);
        sample.u = Vec3f(cell, 0.0, 0.0);
        sample.v = Vec3f(0.0, cell, 0.0);
        sample.receiver = static_cast<std::uint32_t>(set.receivers.size() - 1);
        set.samples.push_back(sample);
    });
    set.receivers.back().sample_end = static_cast<std::uint32_t>(set.samples.size());
}

bool contains(const AreaPolygon& polygon, const Vec2d& p) {
    bool is_inside = false;
    for (const std::vector<Vec2d>& ring : polygon.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            if ((ring[i].y > p.y) != (ring[j].y > p.y) &&
                p.x < ring[i].x + (p.y - ring[i].y) / (ring[j].y - ring[i].y) * (ring[j].x - ring[i].x))
                is_inside = !is_inside;
        }
    }
    return is_inside;
}

}  // namespace

GroundHeights ground_heights(const Scene& scene, double cell_m, const Vec2d& lo, const Vec2d& hi) {
    GroundHeights ground;
    ground.first_column = static_cast<std::int64_t>(std::floor(lo.x / cell_m));
    ground.first_row = static_cast<std::int64_t>(std::floor(lo.y / cell_m));
    ground.columns = static_cast<int>(static_cast<std::int64_t>(std::ceil(hi.x / cell_m)) - ground.first_column);
    ground.rows = static_cast<int>(static_cast<std::int64_t>(std::ceil(hi.y / cell_m)) - ground.first_row);
    ground.height_m.assign(static_cast<std::size_t>(ground.columns) * ground.rows,
                           std::numeric_limits<double>::quiet_NaN());
    for (const Face& face : scene.faces) {
        if (!is_ground(scene.objects[face.object].type)) continue;
        for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
            std::array<Vec3d, 3> p;
            Box3d box;
            for (int k = 0; k < 3; ++k) {
                p[k] = Vec3d(scene.triangles[face.first_triangle + t][k]) + scene.origin;
                box.extend(p[k]);
            }
            const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
            if (area == 0.0) continue;
            const auto clamped = [](double cell, std::int64_t first, int count) {
                return static_cast<int>(std::clamp(cell - static_cast<double>(first), 0.0, static_cast<double>(count)));
            };
            const int c0 = clamped(std::floor(box.lo.x / cell_m), ground.first_column, ground.columns);
            const int c1 = clamped(std::ceil(box.hi.x / cell_m), ground.first_column, ground.columns);
            const int r0 = clamped(std::floor(box.lo.y / cell_m), ground.first_row, ground.rows);
            const int r1 = clamped(std::ceil(box.hi.y / cell_m), ground.first_row, ground.rows);
            for (int r = r0; r < r1; ++r) {
                for (int c = c0; c < c1; ++c) {
                    const double x = (static_cast<double>(ground.first_column + c) + 0.5) * cell_m;
                    const double y = (static_cast<double>(ground.first_row + r) + 0.5) * cell_m;
                    const double b1 = ((x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (y - p[0].y)) / area;
                    const double b2 = ((p[1].x - p[0].x) * (y - p[0].y) - (x - p[0].x) * (p[1].y - p[0].y)) / area;
                    if (b1 < 0.0 || b2 < 0.0 || b1 + b2 > 1.0) continue;
                    const double z = p[0].z + b1 * (p[1].z - p[0].z) + b2 * (p[2].z - p[0].z);
                    double& height = ground.height_m[static_cast<std::size_t>(r) * ground.columns + c];
                    if (std::isnan(height) || z > height) height = z;
                }
            }
        }
    }
    return ground;
}

void add_ground_cells(ReceiverSet& set, const Scene& scene, const ReceiverOptions& options) {
    begin_receiver(set, ReceiverKind::ground, "ground");
    Box3d box;
    for (const Face& face : scene.faces) {
        if (!is_ground(scene.objects[face.object].type)) continue;
        for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
            for (const Vec3f& p : scene.triangles[face.first_triangle + t]) box.extend(Vec3d(p) + scene.origin);
        }
    }
    if (box.is_empty()) return;
    add_lattice(set, ground_heights(scene, options.cell_m, Vec2d(box.lo), Vec2d(box.hi)), options,
                [](const Vec2d&) { return true; });
}

void add_polygon_cells(ReceiverSet& set, const Scene& scene, const ReceiverOptions& options) {
    Box3f bounds = scene.bounds;
    for (const AreaPolygon& polygon : options.polygons) {
        begin_receiver(set, ReceiverKind::polygon, polygon.id);
        Box2d box;
        for (const std::vector<Vec2d>& ring : polygon.rings) {
            for (const Vec2d& p : ring) box.extend(p);
        }
        box.lo = glm::max(box.lo, Vec2d(scene.origin) + Vec2d(Vec3d(bounds.lo)));
        box.hi = glm::min(box.hi, Vec2d(scene.origin) + Vec2d(Vec3d(bounds.hi)));
        if (box.lo.x >= box.hi.x || box.lo.y >= box.hi.y) continue;
        add_lattice(set, ground_heights(scene, options.cell_m, box.lo, box.hi), options,
                    [&](const Vec2d& p) { return contains(polygon, p); });
    }
}

}  // namespace skybake
