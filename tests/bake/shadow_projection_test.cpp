// Projected shadows against rays: the same texels see the same directions.
#include "bake/shadow_projection.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bake/neighbour_runs.h"
#include "bake/sky_tile.h"
#include "base/low_discrepancy.h"
#include "scenes.h"
#include "trace/ray_scene.h"

namespace skybake {
namespace {

/// Fibonacci's lattice over the hemisphere above z = 0.
std::vector<Vec3f> dome(int count) {
    std::vector<Vec3f> directions;
    for (int i = 0; i < count; ++i) {
        const double z = (i + 0.5) / count, r = std::sqrt(1.0 - z * z), a = 2.399963229728653 * i;
        directions.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
    return directions;
}

enum class Shape {
    plane,
    moved,  // a plane whose border texels have their points off centre, and holes
    bumps,  // every point of a relief chart at its own height
    ridge   // two slopes of a relief chart
};

/// A tile of size × size texels of `texel` metres about `center`, turned to `normal`.
TilePoints tile(const Vec3f& center, const Vec3f& normal, float texel, int size, Shape shape) {
    TilePoints points;
    points.width = points.height = size;
    const Vec3f up = std::abs(normal.z) > 0.9f ? Vec3f(0.6f, 0.8f, 0) : Vec3f(0, 0, 1);
    const Vec3f v = -texel * glm::normalize(up - glm::dot(up, normal) * normal);
    const Vec3f u = texel * glm::normalize(glm::cross(v, normal));
    points.frame = {center - 0.5f * static_cast<float>(size) * (u + v), u, v, normal};
    points.covered.assign(static_cast<std::size_t>(size), 0);
    points.is_feature.assign(static_cast<std::size_t>(size), 0);
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const std::uint32_t i = static_cast<std::uint32_t>(row * size + column);
            const float random = static_cast<float>(radical_inverse(2, i));
            float x = static_cast<float>(column) + 0.5f, y = static_cast<float>(row) + 0.5f, h = 1e-3f;
            Vec3f own_normal = normal;
            if (shape == Shape::moved && (column < 3 || row == size - 1)) {
                x += 0.9f * (random - 0.5f);
                y += 0.9f * (static_cast<float>(radical_inverse(3, i)) - 0.5f);
            }
            if (shape == Shape::bumps) h += 0.3f * random;
            if (shape == Shape::ridge) {
                const float middle = 0.5f * static_cast<float>(size), slope = x < middle ? 0.1f : -0.2f;
                h += 0.5f + slope * texel * (x - middle);
                own_normal = glm::normalize(normal - slope * u / texel);
            }
            const Vec3f p = points.frame.origin + x * u + y * v + h * normal;
            points.x.push_back(p.x);
            points.y.push_back(p.y);
            points.z.push_back(p.z);
            if (shape == Shape::bumps || shape == Shape::ridge) points.normal.push_back(own_normal);
            points.triangle.push_back(shape == Shape::bumps ? i : static_cast<std::uint32_t>(2 * column >= size));
            if (shape != Shape::moved || random < 0.9f) points.covered[row] |= 1ull << column;
        }
    }
    return points;
}

/// (texel, direction) pairs, and those in which projection and rays differ.
struct Difference {
    std::size_t pairs = 0, off = 0, visible = 0;
};

/// [direction][row], of those directions that can be projected; else empty.
std::vector<std::vector<std::uint64_t>> visibilities(const Scene& scene, const TilePoints& points,
                                                     const std::vector<Vec3f>& directions) {
    const OccluderTree tree(scene);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t j = 0; j < directions.size(); ++j) {
        if (can_project(points.frame.normal, directions[j])) chosen.push_back(j);
    }
    const NeighbourRuns bundles(directions, chosen, ShadowProjector::kBundle);
    ShadowProjector projector(tree, points);
    std::vector<std::vector<std::uint64_t>> visible(directions.size());
    for (std::size_t b = 0; b < bundles.size(); ++b) {
        projector.set_bundle(directions, bundles[b]);
        for (const std::uint32_t j : bundles[b]) {
            visible[j].resize(points.covered.size());
            EXPECT_TRUE(projector.find_visible(directions[j], visible[j]));
        }
    }
    return visible;
}

Difference difference(const Scene& scene, const TilePoints& points) {
    const RayScene rays(scene);
    const std::vector<Vec3f> directions = dome(512);
    const std::vector<std::vector<std::uint64_t>> visible = visibilities(scene, points, directions);
    Difference result;
    for (std::size_t j = 0; j < directions.size(); ++j) {
        if (visible[j].empty()) continue;
        for (int row = 0; row < points.height; ++row) {
            EXPECT_EQ(visible[j][row] & ~points.covered[row], 0u);
            for (int column = 0; column < points.width; ++column) {
                if (!(points.covered[row] >> column & 1)) continue;
                const std::size_t i = static_cast<std::size_t>(points.texel(column, row));
                const bool sees = !rays.is_occluded({points.x[i], points.y[i], points.z[i]}, directions[j]);
                result.off += sees != static_cast<bool>(visible[j][row] >> column & 1);
                result.visible += sees;
                ++result.pairs;
            }
        }
    }
    return result;
}

/// 40 slabs, posts and roofs turned anyhow, 2 to 30 m from the centre.
Scene clutter(const Vec3f& center = Vec3f(0.0f)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    QuadScene scene;
    for (int i = 0; i < 40; ++i) {
        const float angle = 6.2831853f * unit(random), distance = 2.0f + 28.0f * unit(random);
        const Vec3f foot =
            center + Vec3f(distance * std::cos(angle), distance * std::sin(angle), 6.0f * unit(random) - 1.0f);
        scene.box(foot,
                  foot + Vec3f(0.2f + 5.0f * unit(random), 0.2f + 5.0f * unit(random), 0.5f + 9.0f * unit(random)));
    }
    return scene.scene();
}

TEST(ShadowProjection, SeesWhatRaysSee) {
    const Scene scene = clutter();
    for (const Vec3f& normal : {Vec3f(0, 0, 1), glm::normalize(Vec3f(1, -2, 0)), glm::normalize(Vec3f(2, 1, 2))}) {
        for (const int size : {1, 7, 16, 33, 63}) {
            for (const Shape shape : {Shape::plane, Shape::moved, Shape::bumps, Shape::ridge}) {
                const Difference d = difference(scene, tile({0, 0, 1.0f}, normal, 0.11f, size, shape));
                EXPECT_GT(d.visible, d.pairs / 20);
                EXPECT_LT(d.visible, d.pairs - d.pairs / 20);
                // Points stand for texels' centres to within 1/200 texel, 0.6 mm, and rays and projection round their
                // corners by 1e-5 m: near an edge they may disagree. Some 20 edges of the clutter cross a tile of 7 m:
                // a share of 20 · 0.6 mm / 7 m of its texels at most.
                EXPECT_LE(static_cast<double>(d.off), 2e-3 * static_cast<double>(d.pairs))
                    << "size " << size << ", shape " << static_cast<int>(shape) << ", normal " << normal.x << " "
                    << normal.y << " " << normal.z << ": " << d.off << " of " << d.pairs << ", visible " << d.visible;
            }
        }
    }
}

TEST(ShadowProjection, SeesWhatRaysSeeFarFromTheOrigin) {
    // 2 km off, coordinates have units of 1.2e-4 m: rays, lifted no further than at the origin, and projection may
    // disagree so near an edge, a share of 20 · 2 · 1.2e-4 m / 5 m of the texels on top of the above.
    const Vec3f center(2000.0f, -2000.0f, 0.0f);
    const Scene scene = clutter(center);
    for (const Vec3f& normal : {Vec3f(0, 0, 1), glm::normalize(Vec3f(1, -2, 0)), glm::normalize(Vec3f(2, 1, 2))}) {
        const Difference d = difference(scene, tile(center + Vec3f(0, 0, 1), normal, 0.11f, 45, Shape::plane));
        EXPECT_GT(d.visible, d.pairs / 20);
        EXPECT_LE(static_cast<double>(d.off), 3e-3 * static_cast<double>(d.pairs)) << d.off << " of " << d.pairs;
    }
}

TEST(ShadowProjection, SameBitsOnEveryInstructionSet) {
    const Scene scene = clutter();
    const std::vector<Vec3f> directions = dome(256);
    const std::int64_t all = hwy::SupportedTargets();
    for (const Shape shape : {Shape::plane, Shape::moved, Shape::bumps, Shape::ridge}) {
        const TilePoints points = tile({0, 0, 1.0f}, glm::normalize(Vec3f(2, 1, 2)), 0.11f, 45, shape);
        hwy::GetChosenTarget().Update(all);
        const std::vector<std::vector<std::uint64_t>> expected = visibilities(scene, points, directions);
        for (std::int64_t left = all; left; left &= left - 1) {
            hwy::GetChosenTarget().Update(left & -left);
            EXPECT_EQ(visibilities(scene, points, directions), expected) << "instruction set " << (left & -left);
        }
    }
    hwy::GetChosenTarget().Update(all);
}

TEST(ShadowProjection, AWallIsHiddenByItsNeighbour) {
    // Two houses abut with 3 mm between their walls; the points lie 1 mm before the first one.
    const Scene scene = QuadScene()
                            .quad({0, -9, 0}, {0, 9, 0}, {0, 9, 9}, {0, -9, 9})
                            .quad({0.003f, 9, 0}, {0.003f, -9, 0}, {0.003f, -9, 9}, {0.003f, 9, 9})
                            .scene();
    const std::vector<Vec3f> directions = dome(256);
    for (const auto& visible : visibilities(scene, tile({0, 0, 4}, {1, 0, 0}, 0.25f, 20, Shape::plane), directions)) {
        for (const std::uint64_t row : visible) EXPECT_EQ(row, 0u);
    }
}

TEST(ShadowProjection, AnEmptySceneShadesNothing) {
    const TilePoints points = tile({0, 0, 0}, {0, 0, 1}, 0.5f, 5, Shape::plane);
    const std::vector<Vec3f> directions = dome(16);
    for (const std::vector<std::uint64_t>& visible : visibilities(Scene(), points, directions)) {
        if (visible.empty()) continue;
        EXPECT_EQ(visible, points.covered);
    }
}

TEST(ShadowProjection, LeavesCrowdsToRays) {
    // 10,000 shingles above the tile, each alone: none makes a pair with another.
    QuadScene shingles;
    for (int i = 0; i < 10000; ++i) {
        const Vec3f at(0.04f * static_cast<float>(i % 100) - 2.0f, 0.04f * static_cast<float>(i / 100) - 2.0f, 3.0f);
        shingles.quad(at, at + Vec3f(0.02f, 0, 0.01f), at + Vec3f(0.02f, 0.02f, 0.01f), at + Vec3f(0, 0.02f, 0));
    }
    const Scene scene = shingles.scene();
    const OccluderTree tree(scene);
    ShadowProjector projector(tree, tile({0, 0, 0}, {0, 0, 1}, 0.1f, 50, Shape::plane));
    const std::vector<Vec3f> up{{0, 0, 1}};
    const std::vector<std::uint32_t> first{0};
    projector.set_bundle(up, first);
    std::vector<std::uint64_t> visible(50);
    EXPECT_FALSE(projector.find_visible(up[0], visible));
}

TEST(OccluderTree, JoinsFlatPairsOfOneFace) {
    // A quad is one occluder; its halves bent against each other are two.
    const auto quads_in = [](const Scene& scene) {
        const OccluderTree tree(scene);
        int count = 0;
        for (const OccluderTree::Leaf& leaf : tree.leaves()) {
            for (int lane = 0; lane < OccluderTree::kWidth; ++lane) count += !std::isnan(leaf.corner[0][0][lane]);
        }
        return count;
    };
    EXPECT_EQ(quads_in(QuadScene().quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).scene()), 1);
    EXPECT_EQ(quads_in(QuadScene().quad({0, 0, 0}, {1, 0, 0.1f}, {1, 1, 0}, {0, 1, 0.1f}).scene()), 2);
    EXPECT_EQ(quads_in(QuadScene().quad({0, 0, 0}, {2, 0, 0}, {0.5f, 0.5f, 0}, {0, 2, 0}).scene()), 2) << "not convex";
}

}  // namespace
}  // namespace skybake
