#include "study/shadow_outline.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "base/box.h"

namespace skybake {
namespace {

constexpr double kCrossingM = 0.01;
constexpr double kSimplifyM = 0.03;
/// Between two nodes the ground is taken as straight; it may bulge by so much without hiding the sun from itself.
constexpr double kReliefM = 0.1;

double distance_to_line(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
    const Vec2d along = b - a;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * along);
}

/// Marks the vertices between first and last that stay.
void keep_far_ones(std::span<const Vec2d> line, std::size_t first, std::size_t last, double tolerance_m,
                   std::vector<char>& is_kept) {
    std::size_t farthest = first;
    double most = tolerance_m;
    for (std::size_t i = first + 1; i < last; ++i) {
        const double distance = distance_to_line(line[i], line[first], line[last]);
        if (distance > most) {
            most = distance;
            farthest = i;
        }
    }
    if (farthest == first) return;
    is_kept[farthest] = 1;
    keep_far_ones(line, first, farthest, tolerance_m, is_kept);
    keep_far_ones(line, farthest, last, tolerance_m, is_kept);
}

double signed_area(std::span<const Vec2d> ring) {
    double twice = 0.0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const Vec2d a = ring[j] - ring[0], b = ring[i] - ring[0];
        twice += a.x * b.y - b.x * a.y;
    }
    return 0.5 * twice;
}

}  // namespace

std::vector<Vec2d> simplified(std::span<const Vec2d> ring, double tolerance_m) {
    if (ring.size() < 4) return {ring.begin(), ring.end()};
    // Cut open at the first vertex and at the one that is farthest from it.
    std::vector<Vec2d> line(ring.begin(), ring.end());
    line.push_back(ring[0]);
    const auto far = std::max_element(ring.begin(), ring.end(), [&](const Vec2d& a, const Vec2d& b) {
        return glm::length(a - ring[0]) < glm::length(b - ring[0]);
    });
    const auto middle = static_cast<std::size_t>(far - ring.begin());
    std::vector<char> is_kept(line.size());
    is_kept[0] = is_kept[middle] = 1;
    keep_far_ones(line, 0, middle, tolerance_m, is_kept);
    keep_far_ones(line, middle, line.size() - 1, tolerance_m, is_kept);
    std::vector<Vec2d> kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        if (is_kept[i]) kept.push_back(ring[i]);
    }
    return kept;
}

ShadowGround::ShadowGround(const Scene& scene, double spacing_m, double height_m)
    : spacing_m_(spacing_m), height_m_(height_m) {
    Box3d box;
    for (const Face& face : scene.faces) {
        if (!is_ground(scene.objects[face.object].type)) continue;
        for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
            for (const Vec3f& p : scene.triangles[face.first_triangle + t]) box.extend(Vec3d(p) + scene.origin);
        }
    }
    if (!box.is_empty()) ground_ = ground_heights(scene, spacing_m, Vec2d(box.lo), Vec2d(box.hi));
}

/// Marching squares over the lattice. Based on: Lorensen & Cline, "Marching cubes", 1987, in the plane; two shaded
/// corners across a square stay apart.
class OutlineTracer {
  public:
    OutlineTracer(const ShadowGround& ground, const StudyCity& city, const std::optional<StudyCity>& before,
                  const Vec3f& direction)
        : ground_(ground),
          heights_(ground.ground_),
          city_(city),
          before_(before),
          direction_(direction),
          columns_(heights_.columns + 2),
          rows_(heights_.rows + 2) {}

    ShadowOutline trace() {
        if (heights_.columns == 0 || heights_.rows == 0) return {};
        mark_nodes();
        link_squares();
        return follow();
    }

  private:
    // Nodes have a rim of unshaded ones about the lattice, so that every ring closes.
    std::int64_t node(int column, int row) const { return static_cast<std::int64_t>(row) * columns_ + column; }
    Vec2d place(int column, int row) const {
        return ground_.spacing_m_ * Vec2d(static_cast<double>(heights_.first_column + column - 1) + 0.5,
                                          static_cast<double>(heights_.first_row + row - 1) + 0.5);
    }
    double height(int column, int row) const {
        if (column < 1 || row < 1 || column > heights_.columns || row > heights_.rows)
            return std::numeric_limits<double>::quiet_NaN();
        return heights_.height_m[static_cast<std::size_t>(row - 1) * heights_.columns + column - 1];
    }
    Vec3f local(const Vec3d& p, const StudyCity& city) const {
        return Vec3f(p + Vec3d(0.0, 0.0, ground_.height_m_ + kReliefM) - city.scene->origin);
    }

    void mark_nodes() {
        is_shaded_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
        tbb::parallel_for(1, rows_ - 1, [&](int row) {
            mark_row(row, city_, [](char& shaded, bool is_occluded) { shaded = is_occluded; });
            if (before_)
                mark_row(row, *before_, [](char& shaded, bool was_occluded) { shaded = shaded && !was_occluded; });
        });
    }

    template <typename Set>
    void mark_row(int row, const StudyCity& city, const Set& set) {
        DirectionPacket packet(*city.rays);
        packet.set_direction(direction_);
        float x[RayScene::kPacketSize], y[RayScene::kPacketSize], z[RayScene::kPacketSize];
        int held[RayScene::kPacketSize], count = 0;
        const auto flush = [&] {
            if (count == 0) return;
            const std::uint32_t blocked = packet.occluded(x, y, z, count);
            for (int i = 0; i < count; ++i) set(is_shaded_[node(held[i], row)], blocked >> i & 1u);
            count = 0;
        };
        for (int column = 1; column < columns_ - 1; ++column) {
            const double h = height(column, row);
            if (std::isnan(h)) continue;
            const Vec3f p = local(Vec3d(place(column, row), h), city);
            x[count] = p.x, y[count] = p.y, z[count] = p.z;
            held[count++] = column;
            if (count == RayScene::kPacketSize) flush();
        }
        flush();
    }

    bool shaded_at(const Vec3d& p) const {
        return city_.rays->is_occluded(local(p, city_), direction_) &&
               !(before_ && before_->rays->is_occluded(local(p, *before_), direction_));
    }

    /// Where between two nodes the shadow ends; in the middle when one of them has no ground.
    Vec2d crossing(std::array<int, 2> a, std::array<int, 2> b) const {
        if (!is_shaded_[node(a[0], a[1])]) std::swap(a, b);
        Vec3d shaded(place(a[0], a[1]), height(a[0], a[1])), sunny(place(b[0], b[1]), height(b[0], b[1]));
        if (std::isnan(sunny.z)) return Vec2d(0.5 * (shaded + sunny));
        while (glm::length(sunny - shaded) > kCrossingM) {
            const Vec3d middle = 0.5 * (shaded + sunny);
            (shaded_at(middle) ? shaded : sunny) = middle;
        }
        return Vec2d(0.5 * (shaded + sunny));
    }

    void link_squares() {
        for (int row = 0; row + 1 < rows_; ++row) {
            for (int column = 0; column + 1 < columns_; ++column) {
                const std::array<std::array<int, 2>, 4> corner{
                    {{column, row}, {column + 1, row}, {column + 1, row + 1}, {column, row + 1}}};
                // Edges by their lower node: twice its number, and one more for those that run north.
                const std::array<std::int64_t, 4> edge{2 * node(column, row), 2 * node(column + 1, row) + 1,
                                                       2 * node(column, row + 1), 2 * node(column, row) + 1};
                const auto is_shaded = [&](int k) { return is_shaded_[node(corner[k % 4][0], corner[k % 4][1])] != 0; };
                for (int leaves = 0; leaves < 4; ++leaves) {
                    if (!is_shaded(leaves) || is_shaded(leaves + 1)) continue;
                    int enters = (leaves + 3) % 4;
                    while (is_shaded(enters) || !is_shaded(enters + 1)) enters = (enters + 3) % 4;
                    next_[edge[leaves]] = edge[enters];
                    starts_.push_back(edge[leaves]);
                }
            }
        }
    }

    Vec2d crossing_of(std::int64_t edge) const {
        const std::int64_t lower = edge / 2;
        const int column = static_cast<int>(lower % columns_), row = static_cast<int>(lower / columns_);
        return edge % 2 ? crossing({column, row}, {column, row + 1}) : crossing({column, row}, {column + 1, row});
    }

    ShadowOutline follow() {
        ShadowOutline outline;
        std::vector<std::vector<std::int64_t>> loops;
        for (const std::int64_t start : starts_) {
            std::vector<std::int64_t> loop;
            for (auto at = next_.find(start); at != next_.end();) {
                loop.push_back(at->first);
                const std::int64_t to = at->second;
                next_.erase(at);
                at = next_.find(to);
            }
            if (loop.size() >= 3) loops.push_back(std::move(loop));
        }
        outline.rings.resize(loops.size());
        tbb::parallel_for(std::size_t{0}, loops.size(), [&](std::size_t i) {
            std::vector<Vec2d> ring;
            for (const std::int64_t edge : loops[i]) ring.push_back(crossing_of(edge));
            outline.rings[i] = simplified(ring, kSimplifyM);
        });
        std::erase_if(outline.rings, [](const std::vector<Vec2d>& ring) { return ring.size() < 3; });
        for (const std::vector<Vec2d>& ring : outline.rings) outline.area_m2 += signed_area(ring);
        return outline;
    }

    const ShadowGround& ground_;
    const GroundHeights& heights_;
    StudyCity city_;
    std::optional<StudyCity> before_;
    Vec3f direction_;
    int columns_, rows_;
    std::vector<char> is_shaded_;
    std::unordered_map<std::int64_t, std::int64_t> next_;
    std::vector<std::int64_t> starts_;  // in the order of the lattice, which is that of the rings
};

ShadowOutline ShadowGround::outline(const StudyCity& city, const std::optional<StudyCity>& before,
                                    const Vec3f& sun_direction) const {
    return OutlineTracer(*this, city, before, sun_direction).trace();
}

}  // namespace skybake
