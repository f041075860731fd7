#include "bake/shadow_projection.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "bake/shadow_kernels.h"

namespace skybake {

namespace {

constexpr float kLowestCosine = 0.01f;
// A quad costs some 5 cycles a direction even where its shadow falls beside the tile, and a ray of a packet some 100:
// beyond so many quads rays are cheaper for tiles of a few hundred texels.
constexpr std::size_t kCrowded = 8192;

}  // namespace

bool can_project(const Vec3f& normal, const Vec3f& direction) {
    return glm::dot(normal, direction) >= kLowestCosine;
}

Vec2f ShadowProjector::slopes(const Vec3f& direction) const {
    return Vec2f(glm::dot(tile_.axis_u, direction), glm::dot(tile_.axis_v, direction)) /
           glm::dot(tile_.axis_h, direction);
}

void ShadowProjector::set_bundle(std::span<const Vec3f> directions, std::span<const std::uint32_t> bundle) {
    slopes_ = {};
    for (const std::uint32_t j : bundle) slopes_.extend(slopes(directions[j]));
    has_candidates_ = false;
}

/// Open: what is left is in the tile's facets and loose points.
ShadowProjector::Answer ShadowProjector::cast_shadows(const Vec2f& slope) {
    for (ProjectionTile::Facet& facet : tile_.facets) {
        std::copy(facet.points.begin() + facet.row_begin, facet.points.begin() + facet.row_end,
                  facet.open.begin() + facet.row_begin);
        facet.is_dark = false;
    }
    for (ProjectionTile::LoosePoints& block : tile_.loose) block.open = block.points;
    if (tree_.is_empty()) return Answer::open;
    tile_.hits.clear();
    if (tile_.blockers.count > 0 && cast_shadows_of(tile_.blockers, slope, tile_)) return Answer::dark;
    if (!has_candidates_) {
        find_candidates(tree_, slopes_, tile_);
        has_candidates_ = true;
    }
    if (tile_.candidates.count > kCrowded) return Answer::crowded;
    tile_.hits.clear();
    if (!cast_shadows_of(tile_.candidates, slope, tile_)) return Answer::open;
    remember_blockers();
    return Answer::dark;
}

/// The largest shadows are the likeliest to fall here again.
void ShadowProjector::remember_blockers() {
    const std::size_t count = std::min<std::size_t>(tile_.hits.size(), ProjectionTile::kBlock);
    std::partial_sort(tile_.hits.begin(), tile_.hits.begin() + static_cast<std::ptrdiff_t>(count), tile_.hits.end());
    tile_.blockers.count = count;
    for (std::size_t k = 0; k < tile_.blockers.corner.size(); ++k) {
        std::vector<float>& array = tile_.blockers.corner[k];
        array.assign(ProjectionTile::kBlock, std::numeric_limits<float>::quiet_NaN());
        for (std::size_t i = 0; i < count; ++i) array[i] = tile_.candidates.corner[k][tile_.hits[i].second];
    }
}

bool ShadowProjector::find_visible(const Vec3f& direction, std::span<std::uint64_t> visible) {
    const Answer answer = cast_shadows(slopes(direction));
    if (answer == Answer::crowded) return false;
    std::fill(visible.begin(), visible.end(), 0);
    if (answer == Answer::dark) return true;
    for (const ProjectionTile::Facet& facet : tile_.facets) {
        if (facet.is_dark) continue;
        for (int row = facet.row_begin; row < facet.row_end; ++row)
            visible[row] |= facet.open[static_cast<std::size_t>(row)];
    }
    for (const ProjectionTile::LoosePoints& block : tile_.loose) {
        for (std::uint32_t left = block.open; left; left &= left - 1) {
            const int texel = block.texel[static_cast<std::size_t>(std::countr_zero(left))];
            visible[texel / 64] |= 1ull << (texel % 64);
        }
    }
    return true;
}

}  // namespace skybake
