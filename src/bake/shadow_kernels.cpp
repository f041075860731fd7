#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/shadow_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "bake/shadow_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace skybake {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWidth = OccluderTree::kWidth;
using Lanes16 = hn::CappedTag<float, kWidth>;
using V = hn::Vec<Lanes16>;

/// Bit i: lane i of the mask.
template <class M>
HWY_INLINE std::uint32_t bits_of(Lanes16 tag, M mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(tag, mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}

HWY_INLINE V lowest(const V* corners) {
    return hn::Min(hn::Min(corners[0], corners[1]), hn::Min(corners[2], corners[3]));
}
HWY_INLINE V highest(const V* corners) {
    return hn::Max(hn::Max(corners[0], corners[1]), hn::Max(corners[2], corners[3]));
}

/// a · p + c for the lanes of p.
HWY_INLINE V linear(Lanes16 tag, const Vec3f& a, float c, V x, V y, V z) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(tag, a.x), x), hn::Mul(hn::Set(tag, a.y), y)),
                   hn::Add(hn::Mul(hn::Set(tag, a.z), z), hn::Set(tag, c)));
}

/// The bundle's slopes as mean ± spread, and what the tile's points cover when projected along any of them.
struct Bundle {
    Vec2f mean, spread;
    Box2f window;
};

// A projected coordinate, a sum of products of coordinates, is rounded by less than this share of their magnitudes.
constexpr float kRounding = 0x1p-20f;

/// Which of a node's children may shade the tile.
HWY_INLINE std::uint32_t overlapping(const ProjectionTile& tile, const OccluderTree::Node& node, const Bundle& bundle,
                                     std::size_t lane) {
    const Lanes16 tag;
    V center[3], extent[3];
    for (int axis = 0; axis < 3; ++axis) {
        center[axis] = hn::Sub(hn::Load(tag, node.center[axis] + lane), hn::Set(tag, tile.origin[axis]));
        const V size = hn::Load(tag, node.extent[axis] + lane);
        extent[axis] = hn::Add(size, hn::Mul(hn::Set(tag, kRounding), hn::Add(hn::Abs(center[axis]), size)));
    }
    const auto along = [&](const Vec3f& axis, const V* p) { return linear(tag, axis, 0.0f, p[0], p[1], p[2]); };
    const V zero = hn::Zero(tag);
    const V top = hn::Add(along(tile.axis_h, center), along(glm::abs(tile.axis_h), extent));
    auto mask = hn::Gt(top, zero);
    const V reach = hn::Max(top, zero);
    const auto test = [&](const Vec3f& axis, float mean, float spread, float lo, float hi) {
        const Vec3f a = axis - mean * tile.axis_h;
        const V middle = along(a, center),
                half = hn::Add(along(glm::abs(a), extent), hn::Mul(hn::Set(tag, spread), reach));
        mask = hn::And(mask, hn::And(hn::Le(hn::Sub(middle, half), hn::Set(tag, hi)),
                                     hn::Ge(hn::Add(middle, half), hn::Set(tag, lo))));
    };
    test(tile.axis_u, bundle.mean.x, bundle.spread.x, bundle.window.lo.x, bundle.window.hi.x);
    test(tile.axis_v, bundle.mean.y, bundle.spread.y, bundle.window.lo.y, bundle.window.hi.y);
    return bits_of(tag, mask);
}

/// Appends the leaf's quads that may shade the tile.
HWY_INLINE void append_overlapping(ProjectionTile& tile, const OccluderTree::Leaf& leaf, const Bundle& bundle,
                                   std::size_t lane) {
    const Lanes16 tag;
    V u[4], v[4], h[4];
    for (int k = 0; k < 4; ++k) {
        const V x = hn::Sub(hn::Load(tag, leaf.corner[k][0] + lane), hn::Set(tag, tile.origin.x)),
                y = hn::Sub(hn::Load(tag, leaf.corner[k][1] + lane), hn::Set(tag, tile.origin.y)),
                z = hn::Sub(hn::Load(tag, leaf.corner[k][2] + lane), hn::Set(tag, tile.origin.z));
        u[k] = linear(tag, tile.axis_u, 0.0f, x, y, z);
        v[k] = linear(tag, tile.axis_v, 0.0f, x, y, z);
        h[k] = linear(tag, tile.axis_h, 0.0f, x, y, z);
    }
    const V top = highest(h);
    const auto is_near = [&](const V* x, float mean, float spread, float lo, float hi) {
        V projected[4];
        for (int k = 0; k < 4; ++k) projected[k] = hn::Sub(x[k], hn::Mul(h[k], hn::Set(tag, mean)));
        const V least = lowest(projected), most = highest(projected);
        const V size =
            hn::Add(hn::Max(hn::Abs(lowest(x)), hn::Abs(highest(x))), hn::Max(hn::Abs(least), hn::Abs(most)));
        const V slack = hn::Add(hn::Mul(hn::Set(tag, spread), top), hn::Mul(hn::Set(tag, kRounding), size));
        return hn::And(hn::Le(hn::Sub(least, slack), hn::Set(tag, hi)), hn::Ge(hn::Add(most, slack), hn::Set(tag, lo)));
    };
    const auto mask =
        hn::And(hn::Gt(top, hn::Zero(tag)),
                hn::And(is_near(u, bundle.mean.x, bundle.spread.x, bundle.window.lo.x, bundle.window.hi.x),
                        is_near(v, bundle.mean.y, bundle.spread.y, bundle.window.lo.y, bundle.window.hi.y)));
    if (hn::AllFalse(tag, mask)) return;
    ProjectionTile::Quads& quads = tile.candidates;
    const std::size_t at = quads.count;
    if (quads.corner[0].size() < at + 2 * kWidth) {
        for (std::vector<float>& array : quads.corner) array.resize(2 * at + 4 * kWidth);
    }
    // Whole vectors, since a store of chosen lanes is slow; what is behind the chosen ones is overwritten.
    for (std::size_t k = 0; k < 4; ++k) {
        hn::StoreU(hn::Compress(u[k], mask), tag, quads.corner[3 * k].data() + at);
        hn::StoreU(hn::Compress(v[k], mask), tag, quads.corner[3 * k + 1].data() + at);
        hn::StoreU(hn::Compress(h[k], mask), tag, quads.corner[3 * k + 2].data() + at);
    }
    quads.count += hn::CountTrue(tag, mask);
}

void FindCandidates(const OccluderTree& tree, const Box2f& slopes, ProjectionTile& tile) {
    const Lanes16 tag;
    const std::size_t step = hn::Lanes(tag);
    const Vec2f mean = slopes.center(), spread = 0.5f * slopes.size();
    const Vec2f shift = tile.relief * (glm::abs(mean) + spread);
    const Bundle bundle{mean, spread, {tile.box.lo - shift, tile.box.hi + shift}};
    tile.candidates.count = 0;
    tile.stack.assign(1, tree.root());
    while (!tile.stack.empty()) {
        const std::uint32_t at = tile.stack.back();
        tile.stack.pop_back();
        if (at & OccluderTree::kLeaf) {
            const OccluderTree::Leaf& leaf = tree.leaves()[at & ~OccluderTree::kLeaf];
            for (std::size_t lane = 0; lane < kWidth; lane += step) append_overlapping(tile, leaf, bundle, lane);
        } else {
            const OccluderTree::Node& node = tree.nodes()[at];
            for (std::size_t lane = 0; lane < kWidth; lane += step) {
                for (std::uint32_t hit = overlapping(tile, node, bundle, lane); hit; hit &= hit - 1)
                    tile.stack.push_back(node.child[lane + static_cast<std::size_t>(std::countr_zero(hit))]);
            }
        }
    }
    // The last block is read whole.
    const std::size_t count = tile.candidates.count;
    for (std::vector<float>& array : tile.candidates.corner) {
        if (array.size() < count + kWidth) array.resize(count + kWidth);
        std::fill_n(array.begin() + static_cast<std::ptrdiff_t>(count), kWidth,
                    std::numeric_limits<float>::quiet_NaN());
    }
}

/// Up to 16 quads projected along one direction. A quad's shadow is where a u + b v + c ≥ 0 for its four edges, and,
/// when part of it lies below some point (bit of is_cut), where it is above the point: a₄ u + b₄ v + c₄ > scale × h.
struct alignas(64) Shadows {
    static constexpr int kPlanes = 5;
    float a[kPlanes][kWidth], b[kPlanes][kWidth], c[kPlanes][kWidth], scale[kWidth];
    float lo_v[kWidth], hi_v[kWidth];
    std::uint32_t is_cut = 0;
};

/// The same half planes as bounds of u in a row of a facet: u ≥ from_slope v + from, u ≤ to_slope v + to.
struct alignas(64) RowBounds {
    float from_slope[Shadows::kPlanes][kWidth], from[Shadows::kPlanes][kWidth], to_slope[Shadows::kPlanes][kWidth],
        to[Shadows::kPlanes][kWidth];
    std::uint32_t crosses[Shadows::kPlanes] = {};  // bit of a quad: the plane leaves out part of the facet
};

HWY_INLINE void set_row_bounds(RowBounds& bounds, std::size_t plane, V a, V b, V c) {
    const Lanes16 tag;
    constexpr float kFar = 1e6f;  // texels: beyond every tile
    // An edge along a row bounds v: as a line that is all but parallel to the row.
    const V flat = hn::Max(hn::Mul(hn::Abs(b), hn::Set(tag, 1e-6f)), hn::Set(tag, 1e-30f));
    a = hn::IfThenElse(hn::Lt(hn::Abs(a), flat), flat, a);
    const V scale = hn::Div(hn::Set(tag, -1.0f), a), slope = hn::Mul(b, scale), offset = hn::Mul(c, scale);
    const auto is_from = hn::Gt(a, hn::Zero(tag));
    hn::Store(hn::IfThenElseZero(is_from, slope), tag, bounds.from_slope[plane]);
    hn::Store(hn::IfThenElse(is_from, offset, hn::Set(tag, -kFar)), tag, bounds.from[plane]);
    hn::Store(hn::IfThenZeroElse(is_from, slope), tag, bounds.to_slope[plane]);
    hn::Store(hn::IfThenElse(is_from, hn::Set(tag, kFar), offset), tag, bounds.to[plane]);
}

/// Takes the shadow of quad `lane` from a facet's rows.
HWY_INLINE void cast_on_rows(std::uint64_t* open, const RowBounds& bounds, std::size_t lane, int row_begin,
                             int row_end) {
    const Lanes16 tag;
    const hn::Rebind<std::int32_t, Lanes16> tag32;
    const hn::RebindToUnsigned<decltype(tag32)> tag32u;
    const hn::Half<decltype(tag32u)> half32;
    const hn::Rebind<std::uint64_t, decltype(half32)> tag64;
    const int step = static_cast<int>(hn::Lanes(tag));
    const V first = hn::Iota(tag, 0.5f), half = hn::Set(tag, 0.5f);
    const V last = hn::Set(tag, static_cast<float>(ProjectionTile::kMaxSize));
    const auto one = hn::Set(tag64, 1);
    for (int row = row_begin; row < row_end; row += step) {
        const V v = hn::Add(first, hn::Set(tag, static_cast<float>(row)));
        V from = hn::Zero(tag), to = last;
        for (std::size_t k = 0; k < Shadows::kPlanes; ++k) {
            if (!(bounds.crosses[k] >> lane & 1)) continue;
            from = hn::Max(from, hn::Add(hn::Mul(hn::Set(tag, bounds.from_slope[k][lane]), v),
                                         hn::Set(tag, bounds.from[k][lane])));
            to = hn::Min(to,
                         hn::Add(hn::Mul(hn::Set(tag, bounds.to_slope[k][lane]), v), hn::Set(tag, bounds.to[k][lane])));
        }
        // Centres c + 0.5 in [from, to]: columns from ⌈from − 0.5⌉ to ⌊to − 0.5⌋.
        const V begin = hn::Min(hn::Ceil(hn::Sub(from, half)), last);
        const V end = hn::Max(hn::Floor(hn::Add(to, half)), begin);
        alignas(64) std::uint32_t begins[kWidth], ends[kWidth];
        hn::Store(hn::BitCast(tag32u, hn::ConvertTo(tag32, begin)), tag32u, begins);
        hn::Store(hn::BitCast(tag32u, hn::ConvertTo(tag32, end)), tag32u, ends);
        for (int i = 0; i < step; i += static_cast<int>(hn::Lanes(tag64))) {
            const auto shade = hn::Sub(hn::Shl(one, hn::PromoteTo(tag64, hn::Load(half32, ends + i))),
                                       hn::Shl(one, hn::PromoteTo(tag64, hn::Load(half32, begins + i))));
            hn::StoreU(hn::AndNot(shade, hn::LoadU(tag64, open + row + i)), tag64, open + row + i);
        }
    }
}

/// Takes the shadows of the quads in `hit` from a facet. `margin`: how far a point's v may lie from its projection.
HWY_INLINE void cast_on_facet(ProjectionTile::Facet& facet, const Shadows& shadows, std::uint32_t hit, Vec2f slope,
                              float margin) {
    const Lanes16 tag;
    const std::size_t planes = shadows.is_cut ? 5 : 4;
    const V zero = hn::Zero(tag);
    const V hu = hn::Set(tag, facet.slope.x), hv = hn::Set(tag, facet.slope.y), h0 = hn::Set(tag, facet.offset);
    V a[Shadows::kPlanes], b[Shadows::kPlanes], c[Shadows::kPlanes];
    RowBounds bounds;
    std::uint32_t crossed = 0;
    for (std::size_t k = 0; k < planes; ++k) {
        // In the facet's own u and v: its point (u, v, h) is projected to (u, v) − h × slope.
        a[k] = hn::Load(tag, shadows.a[k]);
        b[k] = hn::Load(tag, shadows.b[k]);
        c[k] = hn::Load(tag, shadows.c[k]);
        V g = hn::Add(hn::Mul(a[k], hn::Set(tag, slope.x)), hn::Mul(b[k], hn::Set(tag, slope.y)));
        if (k == 4) g = hn::Add(g, hn::Load(tag, shadows.scale));
        a[k] = hn::Sub(a[k], hn::Mul(g, hu));
        b[k] = hn::Sub(b[k], hn::Mul(g, hv));
        c[k] = hn::Sub(c[k], hn::Mul(g, h0));
        const V a_lo = hn::Mul(a[k], hn::Set(tag, facet.box.lo.x)), a_hi = hn::Mul(a[k], hn::Set(tag, facet.box.hi.x)),
                b_lo = hn::Mul(b[k], hn::Set(tag, facet.box.lo.y)), b_hi = hn::Mul(b[k], hn::Set(tag, facet.box.hi.y));
        const V most = hn::Add(hn::Add(hn::Max(a_lo, a_hi), hn::Max(b_lo, b_hi)), c[k]),
                least = hn::Add(hn::Add(hn::Min(a_lo, a_hi), hn::Min(b_lo, b_hi)), c[k]);
        const std::uint32_t applies = k == 4 ? shadows.is_cut : ~0u;
        hit &= bits_of(tag, hn::Ge(most, zero)) | ~applies;
        bounds.crosses[k] = bits_of(tag, hn::Lt(least, zero)) & applies;
        crossed |= bounds.crosses[k];
    }
    if (hit & ~crossed) {  // the facet lies whole in one shadow
        facet.is_dark = true;
        return;
    }
    if (!hit) return;
    for (std::size_t k = 0; k < planes; ++k) {
        if (bounds.crosses[k] & hit) set_row_bounds(bounds, k, a[k], b[k], c[k]);
    }
    for (; hit; hit &= hit - 1) {
        const std::size_t lane = static_cast<std::size_t>(std::countr_zero(hit));
        const float lo = std::max(shadows.lo_v[lane] - margin, static_cast<float>(facet.row_begin));
        const float hi = std::min(shadows.hi_v[lane] + margin, static_cast<float>(facet.row_end) - 0.5f);
        if (!(lo <= hi)) continue;
        cast_on_rows(facet.open.data(), bounds, lane, static_cast<int>(lo), static_cast<int>(hi) + 1);
    }
    std::uint64_t left = 0;
    for (int row = facet.row_begin; row < facet.row_end; ++row) left |= facet.open[static_cast<std::size_t>(row)];
    facet.is_dark = left == 0;
}

/// Takes the shadows of the quads in `hit` from a block of loose points.
HWY_INLINE void cast_on_loose(ProjectionTile::LoosePoints& block, const Shadows& shadows, std::uint32_t hit,
                              Vec2f slope) {
    const Lanes16 tag;
    const std::size_t step = hn::Lanes(tag);
    const V zero = hn::Zero(tag);
    // What the points cover, projected.
    const Vec2f shift_lo = block.box.lo.z * slope, shift_hi = block.box.hi.z * slope;
    const Vec2f lo = Vec2f(block.box.lo) - glm::max(shift_lo, shift_hi),
                hi = Vec2f(block.box.hi) - glm::min(shift_lo, shift_hi);
    std::uint32_t whole = ~shadows.is_cut;
    for (std::size_t k = 0; k < 4; ++k) {
        const V a = hn::Load(tag, shadows.a[k]), b = hn::Load(tag, shadows.b[k]), c = hn::Load(tag, shadows.c[k]);
        const V a_lo = hn::Mul(a, hn::Set(tag, lo.x)), a_hi = hn::Mul(a, hn::Set(tag, hi.x)),
                b_lo = hn::Mul(b, hn::Set(tag, lo.y)), b_hi = hn::Mul(b, hn::Set(tag, hi.y));
        hit &= bits_of(tag, hn::Ge(hn::Add(hn::Add(hn::Max(a_lo, a_hi), hn::Max(b_lo, b_hi)), c), zero));
        whole &= bits_of(tag, hn::Ge(hn::Add(hn::Add(hn::Min(a_lo, a_hi), hn::Min(b_lo, b_hi)), c), zero));
    }
    if (hit & whole) block.open = 0;
    for (; hit && block.open; hit &= hit - 1) {
        const std::size_t lane = static_cast<std::size_t>(std::countr_zero(hit));
        std::uint32_t shade = 0;
        for (std::size_t i = 0; i < kWidth; i += step) {
            const V h = hn::Load(tag, block.h + i);
            const V u = hn::Sub(hn::Load(tag, block.u + i), hn::Mul(h, hn::Set(tag, slope.x))),
                    v = hn::Sub(hn::Load(tag, block.v + i), hn::Mul(h, hn::Set(tag, slope.y)));
            const auto plane = [&](int k) {
                return hn::Add(
                    hn::Add(hn::Mul(hn::Set(tag, shadows.a[k][lane]), u), hn::Mul(hn::Set(tag, shadows.b[k][lane]), v)),
                    hn::Set(tag, shadows.c[k][lane]));
            };
            auto mask = hn::Ge(hn::Min(hn::Min(plane(0), plane(1)), hn::Min(plane(2), plane(3))), zero);
            if (shadows.is_cut >> lane & 1)
                mask = hn::And(mask, hn::Gt(plane(4), hn::Mul(hn::Set(tag, shadows.scale[lane]), h)));
            shade |= bits_of(tag, mask) << i;
        }
        block.open &= ~shade;
    }
}

/// What the tile's points cover, projected along a direction.
Box2f projected_box(const ProjectionTile& tile, Vec2f slope) {
    const Vec2f shift = tile.relief * slope;  // of the highest point against the lowest
    return {tile.box.lo - glm::max(shift, Vec2f(0.0f)), tile.box.hi - glm::min(shift, Vec2f(0.0f))};
}

bool CastShadows(const ProjectionTile::Quads& quads, const Vec2f& slope, ProjectionTile& tile) {
    const Lanes16 tag;
    const std::size_t step = hn::Lanes(tag);
    const Box2f window = projected_box(tile, slope);
    const V lo_u = hn::Set(tag, window.lo.x), hi_u = hn::Set(tag, window.hi.x), lo_v = hn::Set(tag, window.lo.y),
            hi_v = hn::Set(tag, window.hi.y);
    // A point's projection lies so far from its row at most: points lie within their texels but for rounding.
    const float margin = 0.01f + std::abs(tile.relief * slope.y);
    const V slope_u = hn::Set(tag, slope.x), slope_v = hn::Set(tag, slope.y), zero = hn::Zero(tag),
            one = hn::Set(tag, 1.0f);
    for (std::size_t begin = 0; begin < quads.count; begin += step) {
        V u[4], v[4], h[4];
        for (std::size_t k = 0; k < 4; ++k) {
            h[k] = hn::LoadU(tag, quads.corner[3 * k + 2].data() + begin);
            u[k] = hn::Sub(hn::LoadU(tag, quads.corner[3 * k].data() + begin), hn::Mul(h[k], slope_u));
            v[k] = hn::Sub(hn::LoadU(tag, quads.corner[3 * k + 1].data() + begin), hn::Mul(h[k], slope_v));
        }
        const V least_u = lowest(u), most_u = highest(u), least_v = lowest(v), most_v = highest(v);
        auto mask = hn::And(hn::And(hn::Le(least_u, hi_u), hn::Ge(most_u, lo_u)),
                            hn::And(hn::Le(least_v, hi_v), hn::Ge(most_v, lo_v)));
        if (hn::AllFalse(tag, mask)) continue;

        // Twice the area, from the diagonals.
        const V du1 = hn::Sub(u[2], u[0]), dv1 = hn::Sub(v[2], v[0]), du2 = hn::Sub(u[3], u[1]),
                dv2 = hn::Sub(v[3], v[1]);
        const V area = hn::Sub(hn::Mul(du1, dv2), hn::Mul(du2, dv1));
        const V sign = hn::CopySign(one, area);
        mask = hn::And(mask, hn::Ne(area, zero));  // else seen edge-on
        auto is_whole = mask;
        Shadows shadows;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t next = (k + 1) % 4;
            const V a = hn::Mul(sign, hn::Sub(v[k], v[next])), b = hn::Mul(sign, hn::Sub(u[next], u[k]));
            // The corners' rounding moves the edge by so much at most.
            const V rounding = hn::Add(hn::Mul(hn::Abs(a), hn::Add(hn::Add(hn::Abs(u[k]), hn::Abs(u[next])), one)),
                                       hn::Mul(hn::Abs(b), hn::Add(hn::Add(hn::Abs(v[k]), hn::Abs(v[next])), one)));
            const V c = hn::Sub(hn::Mul(hn::Set(tag, 0x1p-21f), rounding), hn::Add(hn::Mul(a, u[k]), hn::Mul(b, v[k])));
            const V a_lo = hn::Mul(a, lo_u), a_hi = hn::Mul(a, hi_u), b_lo = hn::Mul(b, lo_v), b_hi = hn::Mul(b, hi_v);
            mask = hn::And(mask, hn::Ge(hn::Add(hn::Add(hn::Max(a_lo, a_hi), hn::Max(b_lo, b_hi)), c), zero));
            is_whole = hn::And(is_whole, hn::Ge(hn::Add(hn::Add(hn::Min(a_lo, a_hi), hn::Min(b_lo, b_hi)), c), zero));
            hn::Store(a, tag, shadows.a[k]);
            hn::Store(b, tag, shadows.b[k]);
            hn::Store(c, tag, shadows.c[k]);
        }
        const auto is_cut = hn::Le(lowest(h), hn::Set(tag, tile.relief));
        if (const std::uint32_t whole = bits_of(tag, hn::AndNot(is_cut, is_whole))) {
            tile.hits.assign(1, {0.0f, static_cast<std::uint32_t>(begin) + std::countr_zero(whole)});
            return true;
        }
        const std::uint32_t hit = bits_of(tag, mask);
        if (!hit) continue;
        alignas(64) float shaded[kWidth];
        hn::Store(hn::Mul(hn::Sub(hn::Min(most_u, hi_u), hn::Max(least_u, lo_u)),
                          hn::Sub(hn::Min(most_v, hi_v), hn::Max(least_v, lo_v))),
                  tag, shaded);
        for (std::uint32_t left = hit; left; left &= left - 1) {
            const std::uint32_t lane = static_cast<std::uint32_t>(std::countr_zero(left));
            tile.hits.emplace_back(-shaded[lane], static_cast<std::uint32_t>(begin) + lane);
        }
        shadows.is_cut = bits_of(tag, is_cut) & hit;
        if (shadows.is_cut) {
            // The quad's height over (u, v) along the direction: h is linear there.
            const V dh1 = hn::Sub(h[2], h[0]), dh2 = hn::Sub(h[3], h[1]), scale = hn::Abs(area);
            const V a = hn::Mul(sign, hn::Sub(hn::Mul(dh1, dv2), hn::Mul(dh2, dv1)));
            const V b = hn::Mul(sign, hn::Sub(hn::Mul(dh2, du1), hn::Mul(dh1, du2)));
            hn::Store(a, tag, shadows.a[4]);
            hn::Store(b, tag, shadows.b[4]);
            hn::Store(hn::Sub(hn::Mul(h[0], scale), hn::Add(hn::Mul(a, u[0]), hn::Mul(b, v[0]))), tag, shadows.c[4]);
            hn::Store(scale, tag, shadows.scale);
        }
        hn::Store(least_v, tag, shadows.lo_v);
        hn::Store(most_v, tag, shadows.hi_v);
        bool is_dark = true;
        for (ProjectionTile::Facet& facet : tile.facets) {
            if (!facet.is_dark) cast_on_facet(facet, shadows, hit, slope, margin);
            is_dark = is_dark && facet.is_dark;
        }
        for (ProjectionTile::LoosePoints& block : tile.loose) {
            if (block.open) cast_on_loose(block, shadows, hit, slope);
            is_dark = is_dark && !block.open;
        }
        if (is_dark) return true;
    }
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace skybake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skybake {

HWY_EXPORT(FindCandidates);
HWY_EXPORT(CastShadows);

void find_candidates(const OccluderTree& tree, const Box2f& slopes, ProjectionTile& tile) {
    HWY_DYNAMIC_DISPATCH(FindCandidates)(tree, slopes, tile);
}

bool cast_shadows_of(const ProjectionTile::Quads& quads, const Vec2f& slope, ProjectionTile& tile) {
    return HWY_DYNAMIC_DISPATCH(CastShadows)(quads, slope, tile);
}

}  // namespace skybake
#endif
