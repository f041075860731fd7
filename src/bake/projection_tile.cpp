#include "bake/projection_tile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <tuple>

#include "bake/neighbour_runs.h"
#include "bake/sky_tile.h"
#include "base/check.h"

namespace skybake {

namespace {

// A point this near its texel's centre stands for it, texels; and this near a plane, for a point of it, metres: a few
// roundings of coordinates of a kilometre, and less than points are lifted off their surface, so that it does not shade
// itself.
constexpr float kRegular = 5e-3f;
constexpr float kFlat = 2e-4f;
// A triangle with fewer texels is not worth a facet.
constexpr std::size_t kFacetTexels = 24;

/// The plane h = slope · (u, v) + offset with the least squared distance from the points added.
class PlaneFit {
  public:
    void add(const Vec2d& uv, double h) {
        if (count_ == 0.0) first_ = {uv, h};
        const Vec2d d = uv - Vec2d(first_);  // about the first point: fewer digits are lost
        const double dh = h - first_.z;
        count_ += 1.0;
        sum_ += d;
        sum_h_ += dh;
        uu_ += d.x * d.x;
        uv_ += d.x * d.y;
        vv_ += d.y * d.y;
        uh_ += d.x * dh;
        vh_ += d.y * dh;
    }

    std::pair<Vec2f, float> plane() const {
        const Vec2d mean = sum_ / count_;
        const double mean_h = sum_h_ / count_;
        // A row or a single point says nothing of the slope across: a trace of weight on 0 decides it.
        constexpr double kFlatly = 1e-9;
        const double a = uu_ - count_ * mean.x * mean.x + kFlatly, b = uv_ - count_ * mean.x * mean.y,
                     d = vv_ - count_ * mean.y * mean.y + kFlatly, p = uh_ - count_ * mean.x * mean_h,
                     q = vh_ - count_ * mean.y * mean_h;
        const double determinant = a * d - b * b;
        const Vec2d slope = Vec2d(d * p - b * q, a * q - b * p) / determinant;
        return {Vec2f(slope), static_cast<float>(first_.z + mean_h - glm::dot(slope, mean + Vec2d(first_)))};
    }

  private:
    Vec3d first_{0.0};
    Vec2d sum_{0.0};
    double count_ = 0.0, sum_h_ = 0.0, uu_ = 0.0, uv_ = 0.0, vv_ = 0.0, uh_ = 0.0, vh_ = 0.0;
};

struct Texel {
    int row, column;
    std::uint32_t triangle;
    Vec3f uvh;
    Vec2f center() const { return {static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f}; }
};

/// Appends a facet of the texels, which are sorted by rows. False, and nothing done, when they do not lie in a plane.
bool add_facet(std::span<const Texel> texels, std::vector<ProjectionTile::Facet>& facets) {
    PlaneFit fit;
    for (const Texel& texel : texels) fit.add(texel.center(), texel.uvh.z);
    ProjectionTile::Facet facet;
    std::tie(facet.slope, facet.offset) = fit.plane();
    facet.row_begin = texels.front().row;
    facet.row_end = texels.back().row + 1;
    for (const Texel& texel : texels) {
        const Vec2f center = texel.center();
        if (!(std::abs(glm::dot(facet.slope, center) + facet.offset - texel.uvh.z) < kFlat)) return false;
        facet.points[static_cast<std::size_t>(texel.row)] |= 1ull << texel.column;
        facet.box.extend(center);
    }
    facets.push_back(facet);
    return true;
}

std::vector<ProjectionTile::LoosePoints> blocks_of(std::span<const Texel> texels) {
    std::vector<Vec3f> places;
    std::vector<std::uint32_t> all;
    for (const Texel& texel : texels) {
        all.push_back(static_cast<std::uint32_t>(places.size()));
        places.emplace_back(texel.uvh.x, texel.uvh.y, 0.0f);
    }
    const NeighbourRuns runs(places, all, ProjectionTile::kBlock);
    std::vector<ProjectionTile::LoosePoints> blocks(runs.size());
    for (std::size_t b = 0; b < runs.size(); ++b) {
        ProjectionTile::LoosePoints& block = blocks[b];
        std::fill_n(block.u, ProjectionTile::kBlock, 0.0f);
        std::fill_n(block.v, ProjectionTile::kBlock, 0.0f);
        std::fill_n(block.h, ProjectionTile::kBlock, 0.0f);
        for (std::size_t i = 0; i < runs[b].size(); ++i) {
            const Texel& texel = texels[runs[b][i]];
            block.u[i] = texel.uvh.x;
            block.v[i] = texel.uvh.y;
            block.h[i] = texel.uvh.z;
            block.texel[i] = static_cast<std::uint16_t>(texel.row * 64 + texel.column);
            block.box.extend(texel.uvh);
            block.points |= 1u << i;
        }
    }
    return blocks;
}

}  // namespace

ProjectionTile::ProjectionTile(const TilePoints& points) {
    SKYBAKE_CHECK_LE(points.width, kMaxSize);
    SKYBAKE_CHECK_LE(points.height, kMaxSize);
    const TileFrame& frame = points.frame;
    axis_u = frame.u / glm::dot(frame.u, frame.u);
    axis_v = frame.v / glm::dot(frame.v, frame.v);
    axis_h = frame.normal;
    Box3f covered;
    std::vector<Vec3f> uvh(points.x.size());
    for (int row = 0; row < points.height; ++row) {
        for (std::uint64_t left = points.covered[row]; left; left &= left - 1) {
            const std::size_t i = static_cast<std::size_t>(points.texel(std::countr_zero(left), row));
            const Vec3f p = Vec3f(points.x[i], points.y[i], points.z[i]) - frame.origin;
            uvh[i] = {glm::dot(axis_u, p), glm::dot(axis_v, p), glm::dot(axis_h, p)};
            covered.extend(uvh[i]);
        }
    }
    SKYBAKE_CHECK(!covered.is_empty());
    box = {Vec2f(covered.lo), Vec2f(covered.hi)};
    origin = frame.origin + covered.lo.z * frame.normal;
    relief = covered.hi.z - covered.lo.z;
    for (Vec3f& point : uvh) point.z -= covered.lo.z;
    sort_points(points, uvh);
}

void ProjectionTile::sort_points(const TilePoints& points, const std::vector<Vec3f>& uvh) {
    std::vector<Texel> regular, others;
    for (int row = 0; row < points.height; ++row) {
        for (std::uint64_t left = points.covered[row]; left; left &= left - 1) {
            const int column = std::countr_zero(left);
            const std::size_t i = static_cast<std::size_t>(points.texel(column, row));
            const Texel texel{row, column, points.triangle[i], uvh[i]};
            (glm::length(Vec2f(uvh[i]) - texel.center()) < kRegular ? regular : others).push_back(texel);
        }
    }
    // All of one plane make one facet; else each triangle its own.
    if (!regular.empty() && !add_facet(regular, facets)) {
        std::stable_sort(regular.begin(), regular.end(),
                         [](const Texel& a, const Texel& b) { return a.triangle < b.triangle; });
        for (auto begin = regular.begin(); begin != regular.end();) {
            const auto end =
                std::find_if(begin, regular.end(), [&](const Texel& t) { return t.triangle != begin->triangle; });
            const bool is_facet =
                static_cast<std::size_t>(end - begin) >= kFacetTexels && add_facet({begin, end}, facets);
            if (!is_facet) others.insert(others.end(), begin, end);
            begin = end;
        }
    }
    loose = blocks_of(others);
}

}  // namespace skybake
